// Pictures of sparse grids against pictures of the same voxels, dense: the marcher's and the
// reference's, densities and classified values, with and without gradients.
#include "../support/sparse_grids.h"
#include "../support/transport_scenes.h"

#include "Transport/reference.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <new>

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
  double most = 1.0; ///< the largest value

  explicit Twins(VoxelType type, bool with_nan = false)
    : most(type == VoxelType::Float32 || type == VoxelType::Float16 ? 1.0 : 100.0)
  {
    const auto value = [with_nan, this](int i, int j, int k)
    {
      return with_nan && i % 7 == 3 && j % 5 == 0 && k % 6 == 0 && balls(i, j, k) > 0.0
               ? std::numeric_limits<double>::quiet_NaN()
               : most * balls(i, j, k);
    };
    topology = sparse_grids::topology_of({ { -24, -24, -48 } }, { { 80, 56, 32 } }, 0.0, value);
    topology.tiles = { { { { 3, -2, 0 } }, { { 4, 1, 1 } }, 0.75 * most } };
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
    topology.bricks.erase(std::remove_if(topology.bricks.begin(), topology.bricks.end(), overlaps),
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
    scene.volumes[0].data_from_index =
      placed(glm::dvec3(0.8, 1.0, 1.3), glm::dvec3(4.0, -9.0, 100.0));
    scene.volumes[0].world_from_data =
      glm::rotate(glm::dmat4(1.0), 0.4, glm::dvec3(1.0, 2.0, -0.5));
    scene.volumes[0].classification = classify(
      0.0,
      most,
      [this](double v)
      {
        const double u = v / most;
        return u < 0.1 ? 0.0 : 0.6 * (u - 0.1) * (u - 0.1);
      },
      [this](double v)
      {
        const double u = v / most;
        return glm::dvec3(u, 1.0 - 0.5 * u, 0.3 + 0.4 * std::sin(5.0 * u));
      },
      4097);
    scene.volumes[0].classification.unit_distance = 2.0;
    scene.camera =
      view_of(scene, glm::dvec3(-0.5, 0.3, -0.9), !perspective).camera(double(width) / height);
    return scene;
  }
};

void as_density(Scene& scene)
{
  scene.volumes[0].meaning = ValueMeaning::Density;
  scene.volumes[0].density.extinction = 0.15 / scene.volumes[0].classification.upper;
}

void with_gradients(Scene& scene)
{
  scene.volumes[0].shading.enabled = true;
  scene.lights = { Light() };
  for (int i = 0; i <= 1000; ++i)
  {
    scene.volumes[0].classification.gradient_opacity.push_back(std::min(1.0, i / 500.0));
  }
  scene.volumes[0].classification.gradient_upper = 0.5 * scene.volumes[0].classification.upper;
}

/// Films of both, by any rule.
void expect_alike(const Twins& twins,
  void (*change)(Scene&),
  bool linear = true,
  StepRule rule = StepRule::Midpoint)
{
  for (bool perspective : { true, false })
  {
    Film films[2];
    for (bool dense : { false, true })
    {
      Scene scene = twins.scene(dense, perspective);
      change(scene);
      scene.volumes[0].grid.linear = linear;
      films[dense] = Film(width, height);
      MarchSettings settings;
      settings.step = 0.7;
      settings.rule = rule;
      settings.leave_error = 0.0;
      const MarchStatistics statistics = Marcher().render(scene, settings, films[dense]);
      EXPECT_EQ(statistics.rule, rule);
    }
    const std::vector<float>& passes = films[1].transmittance[0];
    ASSERT_LT(*std::min_element(passes.begin(), passes.end()), 0.7);
    EXPECT_LE(difference(films[0], films[1]), 1e-5);
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

TEST_P(SparsePicture, OfDensityCellByCell)
{
  expect_alike(Twins(GetParam()), as_density, true, StepRule::Cells);
}

TEST_P(SparsePicture, ClassifiedAndIntegrated)
{
  expect_alike(Twins(GetParam()), unchanged, true, StepRule::Integrated);
}

TEST_P(SparsePicture, OnEverySimdTarget)
{
  const Twins twins(GetParam());
  for (const std::string& target : targets())
  {
    SCOPED_TRACE(target);
    ASSERT_TRUE(force_simd_target(target));
    expect_alike(twins, as_density);
    expect_alike(twins, with_gradients);
  }
  force_simd_target("");
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
  if (GetParam() != VoxelType::Float32 && GetParam() != VoxelType::Float16)
  {
    return; // whole numbers are always finite
  }
  const Twins twins(GetParam(), true);
  MarchStatistics statistics;
  march(twins.scene(false), width, height, 0.7, 0.0, 0, &statistics);
  EXPECT_GT(statistics.non_finite_voxels, 0u);
  expect_alike(twins, unchanged);
  expect_alike(twins, as_density);
  expect_alike(twins, with_gradients);
}

namespace
{

std::string type_name(const ::testing::TestParamInfo<VoxelType>& info)
{
  const char* names[] = { "UInt8", "Int8", "UInt16", "Int16", "Float", "Half" };
  return names[static_cast<int>(info.param)];
}

}

INSTANTIATE_TEST_SUITE_P(Types,
  SparsePicture,
  ::testing::Values(VoxelType::Float32,
    VoxelType::Float16,
    VoxelType::UInt8,
    VoxelType::Int8,
    VoxelType::UInt16,
    VoxelType::Int16),
  type_name);

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

// A second cloud far away, along one axis and along all three (where the table has a directory),
// changes the box and nothing of the first cloud's picture.
TEST(SparsePictures, AreTheSameInAWideBox)
{
  const Twins twins(VoxelType::Float32);
  for (const BrickPlace& far : { BrickPlace{ { 3000, 1, 2 } },
         BrickPlace{ { 2500, 2500, 2500 } },
         BrickPlace{ { 12500, 12500, 12500 } },
         BrickPlace{ { -12500, -9000, 12500 } } })
  {
    SparseTopology wide = twins.topology;
    wide.bricks.push_back(far);
    const SparseVoxels voxels(
      VoxelType::Float32, 0.0, wide, sparse_grids::filler(wide, VoxelType::Float32, balls));
    EXPECT_FALSE(voxels.table().directory.empty());
    for (auto change : { as_density, with_gradients })
    {
      if (change == with_gradients && std::abs(far[0]) > 3000)
      {
        continue; // a ray takes at most 2¹⁶ steps, which are too long then
      }
      Scene near = twins.scene(true, false);
      Scene box = near;
      box.volumes[0].grid = voxels.grid();
      glm::dvec3 shift;
      for (int a = 0; a < 3; ++a)
      {
        shift[a] = voxels.origin()[a] - twins.sparse->origin()[a];
      }
      box.volumes[0].data_from_index = glm::translate(near.volumes[0].data_from_index, shift);
      change(near);
      change(box);
      Film films[2] = { Film(width, height), Film(width, height) };
      for (const Scene* scene : { &near, &box })
      {
        MarchSettings settings;
        settings.rule = StepRule::Cells; // exact for densities, wherever steps would begin
        settings.step = 0.6;
        const MarchStatistics statistics = Marcher().render(*scene, settings, films[scene == &box]);
        EXPECT_LE(statistics.bricks, 1u << 15);
      }
      // At 100 000 voxels single precision tells 1/128 of a voxel. Steps of classified values begin
      // elsewhere.
      EXPECT_LE(difference(films[0], films[1]), change == as_density ? 0.003 : 0.03)
        << far[0] << ' ' << (change == as_density);
    }
  }
}

// A pool of more than 2 GiB, most of which nothing has written: the system gives zeros.
TEST(SparsePictures, OfAPoolBeyondTheReachOfGathers)
{
  SparseTopology topology;
  for (int k = 0; k < 130; ++k)
    for (int j = 0; j < 130; ++j)
      for (int i = 0; i < 130; ++i)
        topology.bricks.push_back({ { i, j, k } });
  const auto value = [](int i, int j, int k)
  {
    return std::max(0.0, 1.0 - std::abs(i - 1020.0) / 16.0) *
           (1.0 + 0.01 * (j % 9) + 0.02 * (k % 7));
  };
  const auto fill = sparse_grids::filler(topology, VoxelType::Float16, value);
  std::unique_ptr<SparseVoxels> voxels;
  try
  {
    voxels = std::make_unique<SparseVoxels>(VoxelType::Float16,
      0.0,
      topology,
      [&](std::size_t index, void* memory)
      {
        const BrickPlace& b = topology.bricks[index];
        if (b[0] > 124 && std::max(b[1], b[2]) > 127)
        {
          fill(index, memory);
        }
      });
  }
  catch (const std::bad_alloc&)
  {
    GTEST_SKIP() << "there is not memory enough for 2.2 GB of address space";
  }
  ASSERT_GT(voxels->grid().bytes(), std::size_t(1) << 31);
  // The last corner, as a grid of its own.
  SparseTopology corner;
  for (const BrickPlace& b : topology.bricks)
  {
    if (b[0] > 124 && b[1] > 124 && b[2] > 124)
    {
      corner.bricks.push_back(b);
    }
  }
  const SparseVoxels small(VoxelType::Float16,
    0.0,
    corner,
    [&](std::size_t index, void* memory)
    {
      const BrickPlace& b = corner.bricks[index];
      std::memset(memory, 0, 1024);
      if (std::max(b[1], b[2]) > 127)
      {
        sparse_grids::filler(corner, VoxelType::Float16, value)(index, memory);
      }
    });
  Film films[2];
  for (const SparseVoxels* each : { static_cast<const SparseVoxels*>(voxels.get()), &small })
  {
    Scene scene;
    Volume& volume = scene.volumes[0];
    volume.grid = each->grid();
    volume.meaning = ValueMeaning::Density;
    volume.density.extinction = 0.05;
    glm::dvec3 origin(each->origin()[0], each->origin()[1], each->origin()[2]);
    volume.data_from_index = placed(glm::dvec3(1.0), origin);
    View view;
    view.centre = { 1020.0, 1025.0, 1025.0 };
    view.forward = glm::normalize(glm::dvec3(0.2, 1.0, 0.3));
    view.up = { 0.0, 0.0, 1.0 };
    view.distance = 40.0;
    view.half_height = 12.0;
    view.near_plane = 20.0;
    view.far_plane = 60.0;
    scene.camera = view.camera(double(width) / height);
    films[each == &small] = march(scene, width, height, 0.05);
  }
  const std::vector<float>& passes = films[1].transmittance[0];
  ASSERT_LT(*std::min_element(passes.begin(), passes.end()), 0.7);
  EXPECT_LE(difference(films[0], films[1]), 2e-3); // steps begin elsewhere
}
