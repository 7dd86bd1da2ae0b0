// The projections against closed forms: largest and smallest value, mean and sum.
#include "../support/mode_scenes.h"

#include <gtest/gtest.h>

#include <limits>

using namespace transport_scenes;

namespace
{

constexpr int edge = 21;

glm::dvec3 colour_of(double t)
{
  return glm::dvec3(0.9 * t, 0.2 + 0.5 * t, 1.0 - t);
}

/// (x − a)(y − b)(z − c) seen obliquely, classified by straight lines over its range.
struct ProductScene
{
  Product f;
  Voxels<float> voxels = voxels_of(9, 8, 10, f);
  Scene scene;
  View view;
  double lower = -120.0;
  double upper = 150.0;

  explicit ProductScene(bool parallel = false)
  {
    Volume& volume = scene.volumes[0];
    volume.grid = voxels.grid();
    volume.data_from_index = placed(glm::dvec3(1.0, 1.5, 0.7), glm::dvec3(-3.0, 10.0, 2.0));
    volume.classification = classify(
      lower,
      upper,
      [this](double v) { return 0.1 + 0.8 * grey(v); },
      [this](double v) { return colour_of(grey(v)); },
      3);
    volume.grey_range[0] = lower;
    volume.grey_range[1] = upper;
    view = view_of(scene, glm::dvec3(0.7, -0.5, -0.9), parallel);
    scene.camera = view.camera(1.0);
  }

  double grey(double v) const { return (v - lower) / (upper - lower); }
  double opacity(double v) const { return 0.1 + 0.8 * grey(v); }

  /// Calls check(pixel, chord) for each pixel that meets the box.
  template <class Check>
  void for_each_chord(const Check& check) const
  {
    int hits = 0;
    for (int y = 0; y < edge; ++y)
    {
      for (int x = 0; x < edge; ++x)
      {
        const Chord c = chord(view, scene.volumes[0], x, y, edge, edge);
        if (c.length > 0.0)
        {
          ++hits;
          check(static_cast<std::size_t>(y) * edge + x, c);
        }
      }
    }
    EXPECT_GT(hits, 100);
  }
};

/// The largest of sign · f on a chord: f is a cubic there, so its derivative a quadratic.
std::pair<double, double> largest(const Product& f, const Chord& c, double sign)
{
  const glm::dvec3 a = c.begin - f.roots;
  const glm::dvec3 d = c.end - c.begin;
  const double c1 = a.x * a.y * d.z + a.x * d.y * a.z + d.x * a.y * a.z;
  const double c2 = a.x * d.y * d.z + d.x * a.y * d.z + d.x * d.y * a.z;
  const double c3 = d.x * d.y * d.z;
  std::vector<double> places{ 0.0, 1.0 };
  const double root = std::sqrt(c2 * c2 - 3.0 * c3 * c1); // NaN where there are no turns
  places.push_back((-c2 + root) / (3.0 * c3));
  places.push_back((-c2 - root) / (3.0 * c3));
  std::pair<double, double> best(-1e300, 0.0);
  for (double t : places)
  {
    if (t >= 0.0 && t <= 1.0)
    {
      best = std::max(best, { sign * f(c.begin + d * t), t });
    }
  }
  return best;
}

TEST(Projections, ExtremesOfACubicAreFoundInsideCells)
{
  for (bool parallel : { false, true })
  {
    for (double sign : { 1.0, -1.0 })
    {
      ProductScene s(parallel);
      s.scene.blend_mode = sign > 0.0 ? BlendMode::MaximumIntensity : BlendMode::MinimumIntensity;
      const Film film = reference(s.scene, edge, edge);
      int inside = 0;
      s.for_each_chord(
        [&](std::size_t pixel, const Chord& c)
        {
          const auto [extreme, t] = largest(s.f, c, sign);
          const double value = sign * extreme;
          inside += t > 0.0 && t < 1.0;
          const double opacity = s.opacity(value);
          const glm::dvec3 colour = colour_of(s.grey(value));
          for (int channel = 0; channel < 3; ++channel)
          {
            ASSERT_NEAR(film.radiance[channel][pixel], opacity * colour[channel], 3e-7);
            ASSERT_NEAR(film.transmittance[channel][pixel], 1.0 - opacity, 3e-7);
          }
          if (opacity > 0.501)
          {
            ASSERT_NEAR(film.depth[pixel], c.from_near + t * c.world, 2e-3) << t;
          }
        });
      EXPECT_GT(inside, 10);
    }
  }
}

TEST(Projections, TheSumOfACubicIsItsIntegral)
{
  ProductScene s;
  s.scene.blend_mode = BlendMode::Additive;
  s.scene.volumes[0].classification.unit_distance = 12.0;
  const Film film = reference(s.scene, edge, edge);
  // opacity · grey is of degree 6 along a ray: Gauss and Legendre's rule of 4 points is exact.
  const double x[2] = { 0.3399810435848563, 0.8611363115940526 };
  const double w[2] = { 0.6521451548625461, 0.3478548451374538 };
  s.for_each_chord(
    [&](std::size_t pixel, const Chord& c)
    {
      double sum = 0.0;
      for (int i = 0; i < 4; ++i)
      {
        const double t = 0.5 + (i % 2 ? 0.5 : -0.5) * x[i / 2];
        const double v = s.f(c.begin + (c.end - c.begin) * t);
        sum += 0.5 * w[i / 2] * s.opacity(v) * s.grey(v);
      }
      const double grey = std::min(1.0, sum * c.length / 12.0);
      for (int channel = 0; channel < 3; ++channel)
      {
        ASSERT_NEAR(film.radiance[channel][pixel], grey, 1e-5);
        ASSERT_EQ(film.transmittance[channel][pixel], 0.0f);
      }
    });
}

/// A ramp from 90 at the near face to 0 at the far one, 15 long.
struct Ramp
{
  Voxels<std::uint8_t> voxels{ 8, 8, 31, [](int, int, int k) { return 3 * k; } };
  Scene scene;

  explicit Ramp(BlendMode mode)
  {
    Volume& volume = scene.volumes[0];
    volume.grid = voxels.grid();
    volume.data_from_index = placed(glm::dvec3(1.0, 1.0, 0.5), glm::dvec3(-5.0, 2.0, 40.0));
    volume.classification = classify(
      0.0,
      90.0,
      [](double v) { return 0.8 * v / 90.0; },
      [](double) { return glm::dvec3(0.3, 0.6, 0.9); });
    volume.grey_range[1] = 90.0;
    View view = view_of(scene, glm::dvec3(0, 0, -1), true);
    view.half_height = 2.0;
    scene.camera = view.camera(1.0);
    scene.blend_mode = mode;
  }
  float grey() const
  {
    const Film film = reference(scene, 3, 3);
    return film.radiance[1][4];
  }
};

TEST(Projections, TheMeanIsOfTheValuesInItsRange)
{
  Ramp ramp(BlendMode::AverageIntensity);
  // The mean of 0.8 n² for n from a to b.
  const auto mean = [](double a, double b)
  { return 0.8 * (b * b * b - a * a * a) / 3.0 / (b - a); };
  EXPECT_NEAR(ramp.grey(), mean(0.0, 1.0), 1e-5);
  ramp.scene.average_range[0] = 31.0;
  ramp.scene.average_range[1] = 64.5;
  EXPECT_NEAR(ramp.grey(), mean(31.0 / 90.0, 64.5 / 90.0), 1e-5);
  ramp.scene.volumes[0].weight = 0.5;
  EXPECT_NEAR(ramp.grey(), 0.5 * mean(31.0 / 90.0, 64.5 / 90.0), 1e-5);
  // Nothing within: nothing drawn.
  ramp.scene.average_range[0] = 91.0;
  ramp.scene.average_range[1] = 300.0;
  const Film film = reference(ramp.scene, 3, 3);
  EXPECT_EQ(film.radiance[0][4], 0.0f);
  EXPECT_EQ(film.transmittance[0][4], 1.0f);
  // A range of no values of its own: all black, but drawn.
  Ramp flat(BlendMode::AverageIntensity);
  flat.scene.volumes[0].grey_range[1] = 0.0;
  EXPECT_EQ(flat.grey(), 0.0f);
  EXPECT_EQ(reference(flat.scene, 3, 3).transmittance[0][4], 0.0f);
}

TEST(Projections, TheSumOfARampEndsAtWhite)
{
  Ramp ramp(BlendMode::Additive);
  ramp.scene.volumes[0].classification.unit_distance = 10.0;
  EXPECT_NEAR(ramp.grey(), 0.8 / 3.0 * 15.0 / 10.0, 1e-5);
  ramp.scene.volumes[0].weight = 2.0;
  EXPECT_NEAR(ramp.grey(), 0.8, 1e-5);
  ramp.scene.volumes[0].classification.unit_distance = 1.0;
  EXPECT_EQ(ramp.grey(), 1.0f);
}

// Samples at a fixed step approach the same picture, from VTK's places too.
TEST(Projections, AFixedStepApproachesTheReference)
{
  for (BlendMode mode : { BlendMode::MaximumIntensity,
         BlendMode::MinimumIntensity,
         BlendMode::AverageIntensity,
         BlendMode::Additive })
  {
    ProductScene s;
    s.scene.blend_mode = mode;
    s.scene.volumes[0].classification.unit_distance = 12.0;
    const Film truth = reference(s.scene, edge, edge);
    Film film(edge, edge);
    render_fixed_step(s.scene, 0.003, SamplePlacement::Middle, 0.0, 0, film);
    EXPECT_LT(difference(film, truth), 4e-3) << int(mode);
    // At most a step too much, of sums.
    render_fixed_step(s.scene, 0.003, SamplePlacement::FromEntry, 0.0, 0, film);
    EXPECT_LT(difference(film, truth), 4e-3) << int(mode);
  }
}

TEST(Projections, ComponentsAreWeightedAndAddUp)
{
  // Two components of one grid, seen along z: the first ramps along z, the second is constant.
  std::vector<std::uint8_t> values;
  for (int k = 0; k < 11; ++k)
    for (int i = 0; i < 16; ++i)
    {
      values.push_back(static_cast<std::uint8_t>(10 * k));
      values.push_back(60);
    }
  Scene scene;
  scene.volumes.resize(2);
  for (int c = 0; c < 2; ++c)
  {
    Volume& volume = scene.volumes[c];
    volume.grid.voxels = values.data();
    volume.grid.components = 2;
    volume.grid.component = c;
    volume.grid.dims[0] = volume.grid.dims[1] = 4;
    volume.grid.dims[2] = 11;
    volume.classification = classify(
      0.0,
      100.0,
      [](double v) { return v / 100.0; },
      [=](double) { return c == 0 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0); },
      2);
    volume.grey_range[1] = 100.0;
    volume.classification.unit_distance = 20.0;
  }
  scene.volumes[0].weight = 0.5;
  scene.volumes[1].weight = 0.75;
  scene.camera = view_of(scene, glm::dvec3(0, 0, -1), true).camera(1.0);
  scene.blend_mode = BlendMode::MaximumIntensity;
  Film film = reference(scene, 3, 3);
  EXPECT_NEAR(film.radiance[0][4], 0.5 * 1.0, 1e-6);
  EXPECT_NEAR(film.radiance[1][4], 0.75 * 0.6, 1e-6);
  EXPECT_NEAR(film.transmittance[0][4], 1.0 - 0.5 - 0.45, 1e-6);
  scene.volumes[1].weight = 1.0; // opacities of more than 1 in all are 1
  EXPECT_EQ(reference(scene, 3, 3).transmittance[0][4], 0.0f);
  scene.blend_mode = BlendMode::MinimumIntensity;
  film = reference(scene, 3, 3);
  EXPECT_NEAR(film.radiance[0][4], 0.0, 1e-6);
  EXPECT_NEAR(film.radiance[1][4], 0.6, 1e-6);
  scene.blend_mode = BlendMode::AverageIntensity; // mean of n² for n from 0 to 1, and 0.36
  EXPECT_NEAR(reference(scene, 3, 3).radiance[2][4], 0.5 / 3.0 + 0.36, 1e-5);
  scene.blend_mode = BlendMode::Additive; // over 10, half a unit distance
  EXPECT_NEAR(reference(scene, 3, 3).radiance[2][4], 0.5 * (0.5 / 3.0 + 0.36), 1e-5);
}

TEST(Projections, NonFiniteVoxelsAreNeverTheExtreme)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  Voxels<float> voxels(5,
    5,
    5,
    [=](int i, int j, int k) {
      return i == 2 && j == 2 ? (k == 1 ? nan : k == 3 ? infinity : 30.0f) : 20.0f + 2.0f * k;
    });
  Scene scene;
  scene.volumes[0].grid = voxels.grid();
  // The value that is transparent, and so stands for empty elsewhere, is the largest.
  scene.volumes[0].classification = classify(
    0.0,
    100.0,
    [](double v) { return 1.0 - v / 100.0; },
    [](double v) { return glm::dvec3(v / 100.0); },
    2);
  scene.camera = view_of(scene, glm::dvec3(0, 0, -1), true).camera(1.0);
  scene.blend_mode = BlendMode::MaximumIntensity;
  EXPECT_NEAR(reference(scene, 3, 3).radiance[0][4], 0.3 * 0.7, 1e-6);
  scene.blend_mode = BlendMode::MinimumIntensity;
  EXPECT_NEAR(reference(scene, 3, 3).radiance[0][4], 0.3 * 0.7, 1e-6);
}

}
