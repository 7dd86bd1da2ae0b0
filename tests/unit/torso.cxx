// The torso phantom as a function of place: the right tissue in the right place, left and right
// told apart, the same bytes everywhere.
#include "data-generators/hounsfield.h"
#include "data-generators/painted_volume.h"
#include "data-generators/random.h"
#include "data-generators/torso_ct.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

namespace hu = brume::hounsfield;

const brume::TorsoCT& torso()
{
  static const brume::TorsoCT phantom;
  return phantom;
}

double at(double x, double y, double z)
{
  return torso().value({ x, y, z }, 0.0);
}

/// Mean over a cube of 2 * reach mm.
double around(double x, double y, double z, double reach)
{
  double sum = 0.0;
  for (int n = 0; n < 512; ++n)
  {
    sum += at(x + reach * (n % 8 - 3.5) / 3.5,
      y + reach * (n / 8 % 8 - 3.5) / 3.5,
      z + reach * (n / 64 - 3.5) / 3.5);
  }
  return sum / 512;
}

std::vector<std::int16_t> scanned(int size, double noise)
{
  const brume::Lattice grid = brume::grid_over(torso().bounds(), size);
  std::vector<std::int16_t> values(brume::whole_extent(grid).voxels());
  brume::sample_scan(torso().painting(), noise, 1, grid, brume::whole_extent(grid), values.data());
  return values;
}

}

TEST(TorsoCT, HasItsOrgansWhereTheyBelong)
{
  const struct
  {
    const char* what;
    double x, y, z, reach, low, high;
  } places[] = {
    { "right lung", 85, 10, 100, 12, -920, -700 },
    { "left lung", -95, -20, 110, 12, -920, -700 },
    { "liver, on the right", 70, 0, 0, 14, 95, 150 },
    { "spleen, on the left", -100, -44, -14, 5, 100, 135 },
    { "stomach's fluid, behind", -56, 0, -8, 8, 20, 50 },
    { "stomach's air, in front", -40, 54, -58, 3, -1000, -900 },
    { "right kidney", 64, -36, -60, 4, 120, 205 },
    { "left kidney", -64, -36, -46, 4, 120, 205 },
    { "left chamber of the heart", -36, 32, 76, 6, 145, 170 },
    { "right atrium", 38, 24, 88, 6, 135, 160 },
    { "descending aorta, left of the spine", -22, -32, 90, 4, 150, 165 },
    { "lower hollow vein, on the right", 17, 2, -60, 4, 140, 155 },
    { "windpipe", 0, 2, 210, 3, -1000, -980 },
    { "spinal cord", 0, -72, 100, 2, 20, 60 },
    { "vertebral body", 0, -50, 110, 4, 80, 700 },
    { "sacrum", 0, -50, -206, 6, 80, 800 },
    { "thigh bone's head", 95, 4, -248, 6, 80, 600 },
    { "psoas", 40, -28, -140, 5, 40, 70 },
    { "gluteal muscle", 80, -80, -220, 5, 30, 70 },
    { "fat under the skin of the belly", 0, 98, -60, 1, -110, -80 },
    { "bladder", 0, 30, -246, 6, 0, 20 },
    { "gall bladder, on the right", 50, 44, -62, 4, 5, 15 },
    { "air before the chest", 0, 135, 100, 2, -1000, -1000 },
  };
  for (const auto& p : places)
  {
    const double value = around(p.x, p.y, p.z, p.reach);
    EXPECT_GE(value, p.low) << p.what;
    EXPECT_LE(value, p.high) << p.what;
  }
  // Not on the other side.
  EXPECT_LT(around(-70, 0, 40, 8), 90.0) << "no liver on the left";
  EXPECT_GT(around(-45, 34, 70, 6), 90.0) << "the heart's tip";
  EXPECT_LT(around(75, 34, 80, 6), -600.0) << "no heart on the right";
}

TEST(TorsoCT, IsOfOnePhase)
{
  // The portal venous one: blood everywhere within 40 HU, and no organ but the kidneys' rind above
  // it.
  const double aorta = around(-22, -32, 90, 4), hollow_vein = around(17, 2, -60, 4);
  const brume::TorsoCT sharp({ 1, 1.0 });
  const double portal_vein = sharp.value({ 91, 9, -15 }, 0.0), liver = around(70, 0, 0, 10);
  const double heart = around(-36, 32, 76, 6), spleen = around(-100, -44, -14, 5);
  for (const double blood : { aorta, hollow_vein, heart })
  {
    EXPECT_NEAR(blood, 155.0, 15.0);
    EXPECT_GT(portal_vein, blood);
    EXPECT_LT(portal_vein, blood + 40.0);
    EXPECT_LT(liver, blood - 20.0);
    EXPECT_LT(spleen, blood);
  }
  EXPECT_GT(liver, 55.0 + 45.0) << "at its height";
}

TEST(TorsoCT, HasBronchiInBothLungs)
{
  // From the main bronchi's ends into each part of the lungs: air within a wall.
  const brume::TorsoCT sharp({ 1, 0.5 });
  const glm::dvec3 ways[] = { { 0.25, 0.25, 0.95 },
    { 0.8, 0.5, 0.2 },
    { 0.75, -0.5, 0.3 },
    { 0.6, 0.35, -0.75 },
    { 0.55, -0.5, -0.7 } };
  for (const double side : { 1.0, -1.0 })
  {
    const glm::dvec3 hilum = side > 0.0 ? glm::dvec3(44, -4, 112) : glm::dvec3(-46, -6, 108);
    for (int n = 0; n < 5; ++n)
    {
      const glm::dvec3 way = side < 0.0 && n == 3 ? glm::dvec3(0.75, 0.2, -0.62) : ways[n];
      const glm::dvec3 along = glm::normalize(glm::dvec3(side * way.x, way.y, way.z));
      for (const double far : { 24.0, 28.0, 31.0 })
      {
        EXPECT_LT(sharp.value(hilum + far * along, 0.0), -990.0) << side << ' ' << n << ' ' << far;
      }
    }
  }
}

TEST(TorsoCT, HasTwelvePairsOfRibs)
{
  // Down along the back of the rib cage: bone, gap, bone, …
  for (double side : { -1.0, 1.0 })
  {
    int found = 0;
    for (int rib = 0; rib < 12; ++rib)
    {
      const double height = 214.0 - 20.9 * rib;
      double most = -1000.0;
      for (double z = height - 9.0; z < height + 9.0; z += 1.0)
        for (double y = -110.0; y < -10.0; y += 1.0)
        {
          most = std::max(most, at(side * 34.0, y, z));
        }
      found += most > 400.0;
    }
    EXPECT_EQ(found, 12);
  }
}

TEST(TorsoCT, ShowsEachPlaceByTheShapesThatReachIt)
{
  // What sorting into cells leaves out must not matter.
  int differ = 0;
  for (std::uint32_t n = 0; n < 4000; ++n)
  {
    const auto number = [&](std::uint32_t i)
    { return brume::unit_float(brume::mix_bits(4 * n + i)); };
    const glm::dvec3 p(
      400.0 * number(0) - 200.0, 280.0 * number(1) - 140.0, 560.0 * number(2) - 280.0);
    differ += std::fabs(torso().painting().value(p) - torso().painting().value_by_all(p)) > 1.0;
  }
  EXPECT_LE(differ, 8) << "of 4000";
}

TEST(TorsoCT, HasTheSameBytesEverywhere)
{
  const std::vector<std::int16_t> values = scanned(40, 10.0);
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const std::int16_t v : values)
  {
    hash = (hash ^ static_cast<std::uint16_t>(v)) * 0x100000001b3ull;
  }
  EXPECT_EQ(hash, 13459537493515093361ull);
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(scanned(40, 10.0), values);
}

TEST(TorsoCT, RefusesAnEdgeThatIsNone)
{
  EXPECT_THROW(brume::TorsoCT({ 1, 0.0 }), std::invalid_argument);
  EXPECT_THROW(
    brume::TorsoCT({ 1, std::numeric_limits<double>::quiet_NaN() }), std::invalid_argument);
}
