// Pictures of sparse grids against pictures of the same voxels, dense: the marcher's and the
// reference's, densities and classified values, with and without gradients.
#include "../support/sparse_grids.h"
#include "../support/transport_scenes.h"

#include "Transport/reference.h"

#include <gtest/gtest.h>

#include <limits>

using namespace transport_scenes;

namespace
{

constexpr int width = 37;
constexpr int height = 29;

/// Two soft balls, one of them far from the origin, with bumps; 0 outside. In [0, 1].
double balls(int i, int j, int k)
{
  const auto ball = [](double x, double y, double z, double radius)
  {
    const double r = std::sqrt(x * x + y * y + z * z) / radius;
    const double bumps = 0.2 * std::sin(0.9 * x) * std::sin(0.8 * y) * std::sin(0.7 * z);
    return std::clamp(1.2 * (1.0 - r) + bumps, 0.0, 1.0);
  };
  return std::max(ball(i - 3.0, j + 6.0, k, 13.0), ball(i - 50.0, j - 21.0, k + 30.0, 11.0));
}

/// A sparse grid and its dense twin.
struct Twins
{
  SparseTopology topology;
  std::unique_ptr<SparseVoxels> sparse;
  std::vector<float> copy;

  explicit Twins(VoxelType type, bool with_nan = false)
  {
    const auto value = [with_nan](int i, int j, int k)
    {
      return with_nan && i % 7 == 3 && j % 5 == 0 && k % 6 == 0 && balls(i, j, k) > 0.0
        ? std::numeric_limits<double>::quiet_NaN()
        : balls(i, j, k);
    };
    topology = sparse_grids::topology_of({ { -24, -24, -48 } }, { { 80, 56, 32 } }, 0.0, value);
    topology.tiles = { { { { 3, -2, 0 } }, { { 4, 1, 1 } }, 0.75 } };
    const auto overlaps = [&](const BrickPlace& b)
    {
      const SparseTile& t = topology.tiles[0];
      bool in = true;
      for (int a = 0; a < 3; ++a)
      {
        in = in && b[a] >= t.first[a] && b[a] <= t.last[a];
      }
      return in;
    };
    topology.bricks.erase(
      std::remove_if(topology.bricks.begin(), topology.bricks.end(), overlaps),
      topology.bricks.end());
    sparse = std::make_unique<SparseVoxels>(
      type, 0.0, topology, sparse_grids::filler(topology, type, value));
    copy = sparse_grids::dense_copy(*sparse);
  }

  /// The scene of one of them, seen from outside.
  Scene scene(bool dense, bool perspective = true) const
  {
    Scene scene;
    scene.volumes[0].grid = dense ? sparse_grids::dense_grid(*sparse, copy) : sparse->grid();
    scene.volumes[0].data_from_index = placed(glm::dvec3(0.8, 1.0, 1.3), glm::dvec3(4.0, -9.0, 100.0));
    scene.volumes[0].world_from_data = glm::rotate(glm::dmat4(1.0), 0.4, glm::dvec3(1.0, 2.0, -0.5));
    scene.volumes[0].classification = classify(
      0.0, 1.0, [](double v) { return v < 0.1 ? 0.0 : 0.6 * (v - 0.1) * (v - 0.1); },
      [](double v) { return glm::dvec3(v, 1.0 - 0.5 * v, 0.3 + 0.4 * std::sin(5.0 * v)); }, 4097);
    scene.volumes[0].classification.unit_distance = 2.0;
    scene.camera = view_of(scene, glm::dvec3(-0.5, 0.3, -0.9), !perspective)
                     .camera(double(width) / height);
    return scene;
  }
};

void as_density(Scene& scene)
{
  scene.volumes[0].meaning = ValueMeaning::Density;
  scene.volumes[0].density.extinction = 0.15;
}

void with_gradients(Scene& scene)
{
  scene.volumes[0].shading.enabled = true;
  scene.lights = { Light() };
  for (int i = 0; i <= 1000; ++i)
  {
    scene.volumes[0].classification.gradient_opacity.push_back(std::min(1.0, i / 500.0));
  }
  scene.volumes[0].classification.gradient_upper = 0.5;
}

void expect_alike(const Twins& twins, void (*change)(Scene&), bool linear = true)
{
  for (bool perspective : { true, false })
  {
    Scene sparse = twins.scene(false, perspective);
    Scene dense = twins.scene(true, perspective);
    for (Scene* scene : { &sparse, &dense })
    {
      change(*scene);
      scene->volumes[0].grid.linear = linear;
    }
    const Film a = march(sparse, width, height, 0.7);
    const Film b = march(dense, width, height, 0.7);
    ASSERT_LT(*std::min_element(b.transmittance[0].begin(), b.transmittance[0].end()), 0.7);
    EXPECT_LE(difference(a, b), 1e-5);
  }
}

void unchanged(Scene&) {}

}

class SparsePicture : public ::testing::TestWithParam<VoxelType>
{
};

TEST_P(SparsePicture, OfDensity)
{
  expect_alike(Twins(GetParam()), as_density);
}

TEST_P(SparsePicture, Classified)
{
  expect_alike(Twins(GetParam()), unchanged);
}

TEST_P(SparsePicture, ClassifiedNearest)
{
  expect_alike(Twins(GetParam()), unchanged, false);
}

TEST_P(SparsePicture, WithGradients)
{
  expect_alike(Twins(GetParam()), with_gradients);
}

TEST_P(SparsePicture, WithVoxelsThatAreNotFinite)
{
  const Twins twins(GetParam(), true);
  MarchStatistics statistics;
  march(twins.scene(false), width, height, 0.7, 0.0, 0, &statistics);
  EXPECT_GT(statistics.non_finite_voxels, 0u);
  expect_alike(twins, unchanged);
  expect_alike(twins, as_density);
  expect_alike(twins, with_gradients);
}

INSTANTIATE_TEST_SUITE_P(Types, SparsePicture,
  ::testing::Values(VoxelType::Float32, VoxelType::Float16),
  [](const auto& info) { return info.param == VoxelType::Float16 ? "Half" : "Float"; });

TEST(SparseReference, IsThatOfTheDenseGrid)
{
  const Twins twins(VoxelType::Float32);
  for (auto change : { unchanged, as_density, with_gradients })
  {
    Film pictures[2];
    for (bool dense : { false, true })
    {
      Scene scene = twins.scene(dense);
      change(scene);
      pictures[dense] = Film(width, height);
      ReferenceSettings settings;
      settings.tolerance = 1e-3;
      EXPECT_TRUE(render_reference(scene, settings, pictures[dense]).completed);
    }
    EXPECT_LE(difference(pictures[0], pictures[1]), 1e-7);
  }
}

// The distance between two clouds changes nothing but the box: the same picture of the first.
TEST(SparsePicture, IsTheSameInAWideBox)
{
  const Twins twins(VoxelType::Float32);
  SparseTopology wide = twins.topology;
  wide.bricks.push_back({ { 3000, 1000, 2000 } });
  const SparseVoxels voxels(
    VoxelType::Float32, 0.0, wide, sparse_grids::filler(wide, VoxelType::Float32, balls));
  Scene near = twins.scene(true);
  Scene far = near;
  far.volumes[0].grid = voxels.grid();
  as_density(near);
  as_density(far);
  MarchStatistics statistics;
  const Film a = march(near, width, height, 0.5);
  const Film b = march(far, width, height, 0.5, 0.0, 0, &statistics);
  EXPECT_LE(statistics.bricks, 1u << 15);
  // Rays begin elsewhere, and so do their steps: half a voxel's worth of error remains.
  EXPECT_LE(difference(a, b), 0.02);
}
