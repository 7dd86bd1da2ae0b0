// Isosurfaces and slices against closed forms.
#include "../support/mode_scenes.h"

#include <gtest/gtest.h>

using namespace transport_scenes;

namespace
{

constexpr int edge = 21;

/// Where f passes through a value on a chord, in (0, 1), by bisection of ever finer pieces.
std::vector<double> roots(const Product& f, const Chord& c, double value)
{
  const auto at = [&](double t) { return f(c.begin + (c.end - c.begin) * t) - value; };
  std::vector<double> result;
  constexpr int pieces = 4000;
  for (int i = 0; i < pieces; ++i)
  {
    double from = double(i) / pieces;
    double to = double(i + 1) / pieces;
    if ((at(from) < 0.0) == (at(to) < 0.0))
    {
      continue;
    }
    const bool rising = at(from) < 0.0;
    for (int j = 0; j < 50; ++j)
    {
      const double middle = 0.5 * (from + to);
      ((at(middle) < 0.0) == rising ? from : to) = middle;
    }
    result.push_back(from);
  }
  return result;
}

TEST(Isosurfaces, OfACubicAreAtItsRoots)
{
  const Product f;
  const Voxels<float> voxels = voxels_of(9, 8, 10, f);
  Scene scene;
  Volume& volume = scene.volumes[0];
  volume.grid = voxels.grid();
  volume.data_from_index = placed(glm::dvec3(1.0, 1.5, 0.7), glm::dvec3(-3.0, 10.0, 2.0));
  const auto opacity = [](double v) { return 0.6 + 0.002 * v; };
  const auto colour = [](double v) { return glm::dvec3(0.5 + 0.01 * v, 0.5 - 0.01 * v, 0.25); };
  volume.classification = classify(-50.0, 50.0, opacity, colour, 2);
  volume.classification.unit_distance = 0.01; // of no account
  scene.blend_mode = BlendMode::Isosurface;
  scene.isosurfaces = { 22.0, -13.0, 4.0, 22.0 }; // no order, and one twice
  const View view = view_of(scene, glm::dvec3(0.7, -0.5, -0.9), false);
  scene.camera = view.camera(1.0);
  const Film film = reference(scene, edge, edge);
  int several = 0;
  for (int y = 0; y < edge; ++y)
  {
    for (int x = 0; x < edge; ++x)
    {
      const std::size_t pixel = static_cast<std::size_t>(y) * edge + x;
      const Chord c = chord(view, volume, x, y, edge, edge);
      std::vector<std::pair<double, double>> met;
      for (double value : { 22.0, -13.0, 4.0 })
      {
        for (double t : c.length > 0.0 ? roots(f, c, value) : std::vector<double>())
        {
          met.push_back({ t, value });
        }
      }
      std::sort(met.begin(), met.end());
      several += met.size() > 1;
      double passes = 1.0;
      glm::dvec3 radiance(0.0);
      for (const auto& [t, value] : met)
      {
        radiance += passes * opacity(value) * colour(value);
        passes *= 1.0 - opacity(value);
      }
      ASSERT_NEAR(film.transmittance[0][pixel], passes, 1e-6) << x << ' ' << y;
      for (int channel = 0; channel < 3; ++channel)
      {
        ASSERT_NEAR(film.radiance[channel][pixel], radiance[channel], 1e-6);
      }
      if (!met.empty())
      {
        ASSERT_NEAR(film.depth[pixel], c.from_near + met[0].first * c.world, 1e-5);
      }
      else
      {
        ASSERT_TRUE(std::isinf(film.depth[pixel]));
      }
    }
  }
  EXPECT_GT(several, 20);
}

/// The distance from the middle of a cube of voxels, seen along −z.
struct Ball
{
  static constexpr int n = 49;
  static constexpr double radius = 17.0;
  Voxels<float> voxels{ n, n, n, [](int i, int j, int k) {
                         return glm::length(glm::dvec3(i - 24, j - 24, k - 24));
                       } };
  Scene scene;
  View view;

  Ball()
  {
    scene.volumes[0].grid = voxels.grid();
    scene.volumes[0].classification = classify(
      0.0, 40.0, [](double) { return 1.0; }, [](double) { return glm::dvec3(0.8, 0.6, 0.4); }, 2);
    view = view_of(scene, glm::dvec3(0, 0, -1), true);
    scene.camera = view.camera(1.0);
    scene.blend_mode = BlendMode::Isosurface;
    scene.isosurfaces = { radius };
  }
};

TEST(Isosurfaces, OfADistanceAreSpheresWithTheirNormals)
{
  Ball ball;
  Shading& shading = ball.scene.volumes[0].shading;
  shading.enabled = true;
  shading.ambient = 0.0;
  shading.diffuse = 1.0;
  shading.specular = 0.0;
  shading.two_sided = true;
  ball.scene.lights.resize(1);
  ball.scene.lights[0].direction = glm::normalize(glm::dvec3(-0.3, -0.4, -1.0));
  const Film film = reference(ball.scene, edge, edge);
  int hits = 0;
  for (int y = 0; y < edge; ++y)
  {
    for (int x = 0; x < edge; ++x)
    {
      const std::size_t pixel = static_cast<std::size_t>(y) * edge + x;
      const double px = ((2.0 * x + 1.0) / edge - 1.0) * ball.view.half_height;
      const double py = ((2.0 * y + 1.0) / edge - 1.0) * ball.view.half_height;
      const double across = px * px + py * py;
      if (across > 0.9 * Ball::radius * Ball::radius)
      {
        continue;
      }
      ++hits;
      const double z = std::sqrt(Ball::radius * Ball::radius - across);
      // Linear interpolation of the distance errs by h²/8 of its curvature, 1/r.
      ASSERT_NEAR(film.depth[pixel], ball.view.distance - ball.view.near_plane - z, 0.06);
      const glm::dvec3 normal = glm::dvec3(px, py, z) / Ball::radius;
      const double lit = std::max(0.0, -glm::dot(normal, ball.scene.lights[0].direction));
      ASSERT_NEAR(film.radiance[0][pixel], 0.8 * lit, 0.01);
      ASSERT_NEAR(film.radiance[2][pixel], 0.4 * lit, 0.01);
      ASSERT_EQ(film.transmittance[0][pixel], 0.0f);
    }
  }
  EXPECT_GT(hits, 50);
}

// A gradient of 1 per voxel, seen through a gradient opacity.
TEST(Isosurfaces, TakeTheGradientOpacity)
{
  Ball ball;
  Classification& c = ball.scene.volumes[0].classification;
  c.gradient_opacity = { 0.0, 1.0 };
  c.gradient_upper = 4.0;
  const Film film = reference(ball.scene, 3, 3);
  EXPECT_NEAR(film.transmittance[0][4], 0.75 * 0.75, 1e-3);
}

TEST(Isosurfaces, BeginAnewInEachPart)
{
  // Cropped to an inner box, the ray begins and ends inside the ball: nothing is met.
  Ball ball;
  Cropping& cropping = ball.scene.volumes[0].cropping;
  cropping.enabled = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    cropping.lower[axis] = 20.0;
    cropping.upper[axis] = 28.0;
  }
  EXPECT_EQ(reference(ball.scene, 3, 3).transmittance[0][4], 1.0f);
  // Without the box in the middle, both sides of the ball are met, and no face of the box.
  cropping.regions = 0x7ffffff & ~0x2000u;
  ball.scene.volumes[0].classification.opacity = { 0.5, 0.5 };
  EXPECT_EQ(reference(ball.scene, 3, 3).transmittance[0][4], 0.25f);
  // A mask that hides the ball's front half leaves the back alone.
  cropping.enabled = false;
  std::vector<std::uint8_t> labels(ball.scene.volumes[0].grid.voxel_count());
  for (std::size_t i = 0; i < labels.size(); ++i)
  {
    labels[i] = i / (Ball::n * Ball::n) < 24;
  }
  ball.scene.volumes[0].mask.labels = labels.data();
  ball.scene.volumes[0].mask.classification_of_label[0] = Mask::hidden;
  EXPECT_EQ(reference(ball.scene, 3, 3).transmittance[0][4], 0.5f);
}

TEST(Isosurfaces, OfNearestVoxelsLieBetweenThem)
{
  Voxels<std::uint8_t> voxels(4, 4, 11, [](int, int, int k) { return 10 * k; });
  Scene scene;
  scene.volumes[0].grid = voxels.grid();
  scene.volumes[0].grid.linear = false;
  scene.volumes[0].classification = classify(
    0.0, 100.0, [](double) { return 1.0; }, [](double v) { return glm::dvec3(v / 100.0); }, 2);
  const View view = view_of(scene, glm::dvec3(0, 0, -1), true);
  scene.camera = view.camera(1.0);
  scene.blend_mode = BlendMode::Isosurface;
  scene.isosurfaces = { 63.0 };
  const Film film = reference(scene, 3, 3);
  EXPECT_NEAR(film.radiance[0][4], 0.63, 1e-6);
  // Voxels 7 and 6 meet at 6.5; the middle of the view is at 5.
  EXPECT_NEAR(film.depth[4], view.distance - view.near_plane - 1.5, 1e-5);
}

TEST(Isosurfaces, AreNotDrawnWhereAValueIsOnlyTouched)
{
  Block block;
  Scene scene;
  scene.volumes[0] = block.volume(1.0, glm::dvec3(1.0));
  scene.camera = view_of(scene, glm::dvec3(0.3, 0.2, -1), false).camera(1.0);
  scene.blend_mode = BlendMode::Isosurface;
  for (std::vector<double> values : { std::vector<double>{}, { 100.0 }, { 99.0, 101.0 } })
  {
    scene.isosurfaces = values;
    const Film film = reference(scene, 5, 5);
    EXPECT_EQ(film.transmittance[0][middle(film)], 1.0f);
    EXPECT_EQ(film.radiance[0][middle(film)], 0.0f);
  }
}

TEST(Slice, IsTheClassifiedPlane)
{
  const Product f;
  const Voxels<float> voxels = voxels_of(9, 8, 10, f);
  Scene scene;
  Volume& volume = scene.volumes[0];
  volume.grid = voxels.grid();
  volume.data_from_index = placed(glm::dvec3(1.0, 1.5, 0.7), glm::dvec3(-3.0, 10.0, 2.0));
  volume.classification = classify(
    -100.0,
    100.0,
    [](double v) { return 0.5 + 0.004 * v; },
    [](double v) { return glm::dvec3(0.5 + 0.005 * v); },
    2);
  const View view = view_of(scene, glm::dvec3(0.7, -0.5, -0.9), false);
  scene.camera = view.camera(1.0);
  scene.blend_mode = BlendMode::Slice;
  const glm::dvec3 normal(1.0, 2.0, 0.5);
  scene.slice = glm::dvec4(normal, -glm::dot(normal, view.centre + glm::dvec3(0.2, 0.1, 0.3)));
  const Film film = reference(scene, edge, edge);
  int hits = 0;
  for (int y = 0; y < edge; ++y)
  {
    for (int x = 0; x < edge; ++x)
    {
      const std::size_t pixel = static_cast<std::size_t>(y) * edge + x;
      const Chord c = chord(view, volume, x, y, edge, edge);
      const auto height = [&](const glm::dvec3& p)
      { return glm::dot(scene.slice, volume.data_from_index * glm::dvec4(p, 1.0)); };
      const double a = c.length > 0.0 ? height(c.begin) : 1.0;
      const double b = c.length > 0.0 ? height(c.end) : 1.0;
      if (a * b >= 0.0)
      {
        ASSERT_EQ(film.transmittance[0][pixel], 1.0f);
        continue;
      }
      ++hits;
      const double v = f(c.begin + (c.end - c.begin) * (a / (a - b)));
      ASSERT_NEAR(film.transmittance[0][pixel], 0.5 - 0.004 * v, 1e-6);
      ASSERT_NEAR(film.radiance[0][pixel], (0.5 + 0.004 * v) * (0.5 + 0.005 * v), 1e-6);
    }
  }
  EXPECT_GT(hits, 50);
}

}
