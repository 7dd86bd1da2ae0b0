// Fields that carry their optical depth: against adaptive quadrature by Boost.Math between the
// jumps, which are found by search; and their means over voxels.
#include "data-generators/exact_field.h"
#include "data-generators/random.h"
#include "data-generators/shepp_logan.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

using brume::Box;
using brume::ExactField;
using glm::dvec3;

constexpr double endless = std::numeric_limits<double>::infinity();
const Box room{ { -1.0, -0.8, -1.2 }, { 1.5, 0.9, 1.1 } };

double random_number(int n)
{
  return brume::mix_bits(0x51ed270bu + n) / 4294967296.0;
}

dvec3 random_place(int n, double half)
{
  return half *
         (2.0 * dvec3(random_number(3 * n), random_number(3 * n + 1), random_number(3 * n + 2)) -
           1.0);
}

struct Case
{
  std::string name;
  std::shared_ptr<ExactField> field;
};

std::vector<Case> fields()
{
  using namespace brume;
  return {
    { "constant", std::make_shared<ConstantField>(room, 0.7) },
    { "ramp", std::make_shared<RampField>(room, 2.0, dvec3(0.5, -0.7, 0.3)) },
    { "ball", std::make_shared<BallField>(room, 3.0, 0.8, BallField::Profile::uniform) },
    { "soft ball", std::make_shared<BallField>(room, 3.0, 0.8, BallField::Profile::parabolic) },
    { "slab", std::make_shared<SlabField>(room, 1.5, dvec3(1.0, 2.0, 3.0), 0.1, 0.3) },
    { "checker", std::make_shared<CheckerField>(room, 1.0, 0.25, glm::ivec3(5, 4, 7)) },
    { "Shepp-Logan", std::make_shared<SheppLogan>(SheppLogan::Contrast::kak_slaney) },
    { "Shepp-Logan, raised", std::make_shared<SheppLogan>() },
  };
}

/// The integral of the density by quadrature: jumps and ends of matter are found by search.
double quadrature(const ExactField& field, const dvec3& o, const dvec3& d, double from, double to)
{
  const auto density = [&](double s) { return field.density(o + s * d); };
  const auto apart = [](double a, double b)
  { return (a == 0.0) != (b == 0.0) || std::fabs(a - b) > 0.008; };
  const int pieces = 6000;
  double sum = 0.0;
  double begin = from;
  double before = density(from);
  for (int n = 1; n <= pieces; ++n)
  {
    const double s = from + (to - from) * n / pieces;
    const double here = density(s);
    double end = s;
    if (apart(before, here))
    {
      double low = from + (to - from) * (n - 1) / pieces;
      double high = s;
      for (int bit = 0; bit < 60; ++bit)
      {
        const double middle = 0.5 * (low + high);
        (apart(before, density(middle)) ? high : low) = middle;
      }
      end = low;
    }
    before = here;
    if (end == s && n < pieces)
    {
      continue;
    }
    sum += boost::math::quadrature::gauss_kronrod<double, 15>::integrate(density, begin, end, 0);
    begin = end;
    if (n == pieces && end < to)
    {
      sum += boost::math::quadrature::gauss_kronrod<double, 15>::integrate(density, end, to, 0);
    }
  }
  return sum;
}

}

TEST(ExactFields, OpticalDepthsAgreeWithQuadrature)
{
  double worst = 0.0;
  for (const Case& c : fields())
  {
    int through = 0;
    for (int n = 0; n < 150; ++n)
    {
      const dvec3 origin = random_place(2 * n, 1.1);
      dvec3 direction = random_place(2 * n + 1, 1.0);
      if (n % 10 == 0)
      {
        direction[n / 10 % 3] = 0.0; // along two axes, or one
        direction[(n / 10 + 1) % 3] *= n % 20 == 0 ? 0.0 : 1.0;
      }
      const dvec3 along = glm::normalize(direction);
      const double from = -1.0 + 2.0 * random_number(7000 + n);
      const double to = from + 3.0 * random_number(9000 + n);
      const double depth = c.field->optical_depth(origin, direction, from, to);
      const double truth = quadrature(*c.field, origin, along, from, to);
      through += truth > 0.01;
      // Within 1e-12 of a depth, or of what matter of density 1 has in a thousandth of the box.
      EXPECT_NEAR(depth, truth, 1e-12 * std::max(truth, 1e-3)) << c.name << " ray " << n;
      worst = std::max(worst, std::fabs(depth - truth) / std::max(truth, 1e-3));
    }
    EXPECT_GT(through, 30) << c.name;
  }
  std::printf("largest relative difference: %.2e\n", worst);
}

TEST(ExactFields, DepthsAddUpAndDoNotDependOnTheDirectionsLength)
{
  for (const Case& c : fields())
  {
    for (int n = 0; n < 100; ++n)
    {
      const dvec3 origin = random_place(2 * n, 1.0);
      const dvec3 direction = random_place(2 * n + 1, 1.0);
      const double all = c.field->optical_depth(origin, direction, -endless, endless);
      const double parts = c.field->optical_depth(origin, direction, -endless, 0.2) +
                           c.field->optical_depth(origin, 7.0 * direction, 0.2, endless);
      EXPECT_NEAR(all, parts, 1e-13 * (1.0 + all)) << c.name;
      EXPECT_NEAR(
        all, c.field->optical_depth(origin, -direction, -endless, endless), 1e-13 * (1.0 + all))
        << c.name;
    }
    EXPECT_EQ(c.field->optical_depth({ 0, 0, 9 }, { 1, 0, 0 }, -endless, endless), 0.0);
    EXPECT_EQ(c.field->optical_depth({ 0, 0, 0 }, { 1, 0, 0 }, 1.0, 0.5), 0.0);
    EXPECT_EQ(c.field->density({ 0, 0, 9 }), 0.0);
    EXPECT_THROW(c.field->optical_depth({ 0, 0, 0 }, { 0, 0, 0 }, 0.0, 1.0), std::invalid_argument);
  }
}

TEST(ExactFields, KnownDepths)
{
  using namespace brume;
  const Box cube{ dvec3(-1.0), dvec3(1.0) };
  const BallField ball(cube, 2.0, 0.5, BallField::Profile::uniform);
  EXPECT_DOUBLE_EQ(ball.optical_depth({ 0.3, 0, -5 }, { 0, 0, 1 }, 0.0, endless), 2.0 * 0.8);
  const BallField soft(cube, 3.0, 1.0, BallField::Profile::parabolic);
  EXPECT_DOUBLE_EQ(soft.optical_depth({ 0, 0, -5 }, { 0, 0, 1 }, 0.0, endless), 4.0);
  const SheppLogan head(SheppLogan::Contrast::kak_slaney);
  // Down y, above all that is within the brain: through the skull and the brain alone.
  EXPECT_NEAR(head.optical_depth({ 0, 9, 0.44 }, { 0, -1, 0 }, 0.0, endless),
    2.0 * (2.0 * 0.92 * std::sqrt(1.0 - std::pow(0.44 / 0.9, 2))) -
      0.98 * (2.0 * 0.874 * std::sqrt(1.0 - std::pow(0.44 / 0.88, 2))),
    1e-12);
}

TEST(ExactFields, SheppAndLogansTable)
{
  const brume::SheppLogan real(brume::SheppLogan::Contrast::kak_slaney);
  const brume::SheppLogan raised;
  const struct
  {
    dvec3 place;
    double real, raised;
  } rows[] = {
    { { 0.0, 0.0, 0.0 }, 1.02, 0.2 },          // brain
    { { 0.675, 0.0, 0.0 }, 2.0, 1.0 },         // skull
    { { 0.0, 0.9, 0.0 }, 2.0, 1.0 },           // skull, front
    { { -0.22, 0.0, -0.25 }, 1.00, 0.0 },      // the large ventricle, on the side of x below 0
    { { 0.22, 0.0, -0.25 }, 1.00, 0.0 },       // the small one
    { { -0.30, 0.25, -0.25 }, 1.00, 0.0 },     // upper end of the large one: it leans outward
    { { -0.127, -0.285, -0.25 }, 1.00, 0.0 },  // and its lower end inward
    { { -0.313, -0.285, -0.25 }, 1.02, 0.2 },  // and not outward
    { { -0.3436, 0.3804, -0.25 }, 1.00, 0.0 }, // just within its tip, 0.41 from its middle
    { { -0.3498, 0.3994, -0.25 }, 1.02, 0.2 }, // … and just beyond
    { { 0.3127, 0.2853, -0.25 }, 1.00, 0.0 },  // the same of the small one, 0.31
    { { 0.3189, 0.3043, -0.25 }, 1.02, 0.2 },
    { { 0.0, 0.45, -0.25 }, 1.04, 0.4 },    // the great one in front
    { { 0.0, 0.08, -0.25 }, 1.04, 0.4 },    // the ball behind it
    { { -0.08, -0.65, -0.25 }, 1.03, 0.3 }, // small ones
    { { 0.06, -0.61, -0.25 }, 1.03, 0.3 },  // along y
    { { 0.06, -0.105, 0.625 }, 1.04, 0.4 },
    { { 0.0, 0.1, 0.625 }, 1.00, 0.0 },
    { { 0.0, 0.0, 0.95 }, 0.0, 0.0 }, // outside
  };
  for (const auto& row : rows)
  {
    EXPECT_NEAR(real.density(row.place), row.real, 1e-12) << row.place.x << ' ' << row.place.y;
    EXPECT_NEAR(raised.density(row.place), row.raised, 1e-12) << row.place.x << ' ' << row.place.y;
  }
}

TEST(ExactFields, KnowTheirRangeInABox)
{
  for (const Case& c : fields())
  {
    int exact = 0;
    for (int n = 0; n < 600; ++n)
    {
      const dvec3 centre = random_place(2 * n, 1.3);
      const dvec3 half = glm::abs(random_place(2 * n + 1, 0.1));
      const brume::FieldRange range = c.field->range_in({ centre - half, centre + half }, 0.0);
      exact += range.lower == range.upper;
      for (int m = 0; m < 30; ++m)
      {
        const float value = c.field->value(centre + half * random_place(50 * n + m, 1.0), 0.0);
        ASSERT_GE(value, range.lower) << c.name;
        ASSERT_LE(value, range.upper) << c.name;
      }
    }
    EXPECT_GT(exact, 100) << c.name;
  }
}

TEST(ExactFields, MeansOverVoxelsKeepWhatIsThere)
{
  for (const Case& c : fields())
  {
    const brume::Lattice grid = brume::grid_over(c.field->bounds(), 40);
    const brume::Extent all = brume::whole_extent(grid);
    std::vector<float> means(all.voxels());
    EXPECT_TRUE(brume::sample_means(*c.field, 1.0, grid, all, means.data()));
    double sum = 0.0;
    for (const float v : means)
    {
      sum += v;
    }
    const dvec3 side = c.field->bounds().upper - c.field->bounds().lower;
    sum *= grid.spacing.x * grid.spacing.y * grid.spacing.z;
    // All that is in the box, from depths of rays along z through a fine lattice.
    double truth = 0.0;
    const int rays = 200;
    for (int j = 0; j < rays; ++j)
      for (int i = 0; i < rays; ++i)
      {
        const dvec3 o =
          c.field->bounds().lower + side * dvec3((i + 0.5) / rays, (j + 0.5) / rays, 0.0);
        truth += c.field->optical_depth(o, { 0, 0, 1 }, -endless, endless);
      }
    truth *= side.x * side.y / (rays * rays);
    // The grid is of cubes and does not fill the box to the last.
    const dvec3 filled = dvec3(grid.dimensions) * grid.spacing;
    EXPECT_NEAR(
      sum, truth * filled.x * filled.y * filled.z / (side.x * side.y * side.z), 0.015 * truth)
      << c.name;

    // At edges between the two sides, within what 64 places can tell.
    if (c.name == "ball" || c.name == "slab" || c.name == "checker")
    {
      int parted = 0;
      for (int n = 0; n < 400; ++n)
      {
        // Not the outermost, which may stick out of the box and are cut there.
        const glm::ivec3 v =
          1 + glm::ivec3(dvec3(random_number(n), random_number(n + 1000), random_number(n + 2000)) *
                         dvec3(grid.dimensions - 2));
        double mean = 0.0;
        for (int m = 0; m < 8000; ++m)
        {
          const dvec3 in(m % 20 + 0.5, m / 20 % 20 + 0.5, m / 400 + 0.5);
          mean += c.field->density(grid.place(v.x, v.y, v.z) + (in / 20.0 - 0.5) * grid.spacing);
        }
        mean /= 8000;
        const float ours =
          means[(static_cast<std::size_t>(v.z) * grid.dimensions.y + v.y) * grid.dimensions.x +
                v.x];
        parted +=
          ours > 0.01f && ours < 0.99f * 3.0f && ours != 1.0f && ours != 0.25f && ours != 1.5f;
        EXPECT_NEAR(ours, mean, c.name == "checker" ? 0.06 : 0.25) << c.name;
      }
      EXPECT_GT(parted, 10) << c.name;
    }
  }
}

TEST(ExactFields, RefuseWhatMakesNone)
{
  using namespace brume;
  const Box flat{ dvec3(0.0), dvec3(1.0, 1.0, 0.0) };
  EXPECT_THROW(ConstantField(flat, 1.0), std::invalid_argument);
  EXPECT_THROW(ConstantField(room, -1.0), std::invalid_argument);
  EXPECT_THROW(RampField(room, 1.0, dvec3(3.0, 0.0, 0.0)), std::invalid_argument);
  EXPECT_THROW(BallField(room, 1.0, 5.0, BallField::Profile::uniform), std::invalid_argument);
  EXPECT_THROW(SlabField(room, 1.0, dvec3(0.0), 0.0, 1.0), std::invalid_argument);
  EXPECT_THROW(SlabField(room, 1.0, dvec3(1.0), 0.0, 0.0), std::invalid_argument);
  EXPECT_THROW(CheckerField(room, 1.0, 0.0, glm::ivec3(0, 1, 1)), std::invalid_argument);
}
