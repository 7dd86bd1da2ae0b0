// Paths in packets: the same estimator as paths one by one, whatever holds the voxels.
#include "../support/sparse_grids.h"
#include "../support/transport_scenes.h"

#include "Transport/path_pixels.h"
#include "Transport/path_scene.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

using namespace brume;
using namespace transport_scenes;

namespace
{

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int paths = 2000;
constexpr double slack = 0.2;      // of what is counted
constexpr double most_noise = 8.0; // few paths of dark matter tell little of their noise
#else
constexpr int paths = 20000;
constexpr double slack = 0.07;
constexpr double most_noise = 2.0;
#endif

double wave(int i, int j, int k)
{
  return std::max(std::sin(0.9 * i) * std::cos(0.7 * j) * std::sin(0.5 * k + 0.3), 0.0);
}

Scene lit_density(const Grid& grid, double extinction)
{
  Scene scene;
  scene.volumes.resize(1);
  Volume& volume = scene.volumes[0];
  volume.grid = grid;
  volume.meaning = ValueMeaning::Density;
  volume.density.extinction = extinction;
  volume.medium.lit = true;
  volume.medium.albedo = glm::dvec3(0.7, 0.9, 1.0);
  volume.medium.lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.6 } };
  Light sun;
  sun.direction = glm::normalize(glm::dvec3(0.3, -0.8, -0.5));
  sun.diffuse = glm::dvec3(2.0, 1.8, 1.5);
  scene.lights = { sun };
  return scene;
}

struct Mean
{
  glm::dvec3 value{ 0.0 };
  glm::dvec3 variance{ 0.0 }; ///< of the value
};

Mean mean_of(const std::vector<glm::dvec3>& values)
{
  Mean mean;
  for (const glm::dvec3& v : values)
  {
    mean.value += v / double(values.size());
  }
  for (const glm::dvec3& v : values)
  {
    mean.variance += (v - mean.value) * (v - mean.value);
  }
  mean.variance /= double(values.size()) * double(values.size() - 1);
  return mean;
}

void expect_alike(const std::string& name,
  const Scene& scene,
  int most_scatterings = 0,
  int count = paths)
{
  SCOPED_TRACE(name);
  const PathScene path_scene(scene, most_scatterings);
  ASSERT_TRUE(path_scene.packets());
  const glm::dvec3 aims[] = { { 9.1, 8.2, 8.4 }, { 14.3, 3.1, 11.7 }, { 4.2, 12.9, 5.6 } };
  for (const glm::dvec3& aim : aims)
  {
    const glm::dvec3 along = glm::normalize(glm::dvec3(-0.5, -0.6, -0.62));
    const Sight sight{ aim - 60.0 * along, along, 1e9 };
    PathCounts counts;
    std::vector<glm::dvec3> singles;
    for (int n = 0; n < count; ++n)
    {
      RandomStream random(3, 1, static_cast<std::uint32_t>(n));
      singles.push_back(path_scene.radiance(sight, random, counts));
    }
    PathStart start;
    ASSERT_TRUE(path_scene.find_start(sight, start));
    std::vector<float> radiance(3 * count);
    PathCounts packet_counts;
    trace_paths(
      *path_scene.packets(), { start }, count, most_scatterings, 4, radiance.data(), packet_counts);
    std::vector<glm::dvec3> together;
    for (int n = 0; n < count; ++n)
    {
      together.emplace_back(radiance[3 * n], radiance[3 * n + 1], radiance[3 * n + 2]);
    }
    const Mean a = mean_of(singles);
    const Mean b = mean_of(together);
    for (int c = 0; c < 3; ++c)
    {
      const double sigma = std::sqrt(a.variance[c] + b.variance[c]);
      EXPECT_GT(b.value[c], 0.0);
      EXPECT_NEAR(a.value[c], b.value[c], 4.5 * sigma + 1e-6) << "channel " << c;
      // Not only the mean: noise and work are alike, too.
      const double noise = std::sqrt(b.variance[c] / a.variance[c]);
      EXPECT_LT(std::abs(std::log(noise)), std::log(most_noise)) << noise;
    }
    EXPECT_GT(counts.scatterings, count / 20u);
    EXPECT_NEAR(double(packet_counts.scatterings) / counts.scatterings, 1.0, slack);
    EXPECT_NEAR(double(packet_counts.shadow_rays + 1) / (counts.shadow_rays + 1), 1.0, slack);
  }
}

}

TEST(PathPackets, AreTheEstimatorOfSinglePaths)
{
  const auto voxels = std::make_shared<Voxels<float>>(
    20, 18, 17, [](int i, int j, int k) { return float(wave(i, j, k)); });
  const Scene plain = lit_density(voxels->grid(), 0.5);
  expect_alike("one sun", plain);
  expect_alike("one sun, two scatterings", plain, 2);

  Scene scene = plain;
  scene.volumes[0].density.extinction = 6.0;
  expect_alike("thick", scene);

  scene = plain;
  scene.volumes[0].medium.albedo = glm::dvec3(0.3, 0.1, 0.2);
  expect_alike("dark", scene);

  scene = plain;
  scene.volumes[0].medium.lobes = { { PhaseFunction::HenyeyGreenstein, 0.5, -0.5 },
    { PhaseFunction::Rayleigh, 0.2, 0.0 },
    { PhaseFunction::Schlick, 0.2, 0.4 },
    { PhaseFunction::Isotropic, 0.1, 0.0 } };
  expect_alike("four lobes", scene);

  scene = plain;
  for (int i = 0; i < 5; ++i)
  {
    Light sun;
    sun.direction = glm::normalize(glm::dvec3(std::sin(i), std::cos(2.0 * i), 0.3));
    sun.diffuse = glm::dvec3(0.3 * i, 0.5, 1.0 / (i + 1.0));
    scene.lights.push_back(sun);
  }
  expect_alike("six suns", scene);

  scene.sky.radiance = glm::dvec3(0.5, 0.6, 0.9);
  scene.sky.ground = glm::dvec3(0.1, 0.05, 0.02);
  scene.sky.up = glm::normalize(glm::dvec3(0.2, 0.1, 1.0));
  expect_alike("suns and sky", scene);
  expect_alike("suns and sky, one scattering", scene, 1);
  scene.lights.clear();
  expect_alike("sky alone", scene);

  scene = plain;
  scene.volumes[0].data_from_index = placed(glm::dvec3(1.2, 0.9, 1.1), glm::dvec3(-1.0, 1.0, 0.5));
  expect_alike("moved and stretched", scene);
  scene.volumes[0].grid.cell_centred = true;
  scene.volumes[0].density.channels = glm::dvec3(0.4);
  expect_alike("cells, by a factor for all channels", scene);

  // Shadow rays through matter that is nowhere empty, and mostly weak.
  const auto veil = std::make_shared<Voxels<float>>(
    20, 18, 17, [](int i, int j, int k) { return float(0.5 + wave(i, j, k)); });
  scene = lit_density(veil->grid(), 0.4);
  scene.lights[0].direction = glm::normalize(glm::dvec3(0.2, 0.3, 0.9));
  scene.volumes[0].medium.lobes.clear();
  expect_alike("veil, one scattering", scene, 1, 5 * paths);

  const auto bytes = std::make_shared<Voxels<std::uint8_t>>(
    20, 18, 17, [](int i, int j, int k) { return std::uint8_t(200.0 * wave(i, j, k)); });
  expect_alike("bytes", lit_density(bytes->grid(), 0.003));
}

TEST(PathPackets, ReadSparseVoxels)
{
  const auto value = [](std::int32_t i, std::int32_t j, std::int32_t k)
  { return i > 0 && j > 0 && k > 0 && i < 20 && j < 18 && k < 17 ? wave(i, j, k) : 0.0; };
  for (VoxelType type : { VoxelType::Float32, VoxelType::Float16 })
  {
    const auto sparse =
      sparse_grids::make_sparse(type, { { 0, 0, 0 } }, { { 23, 23, 23 } }, 0.0, value);
    Scene scene = lit_density(sparse->grid(), 0.5);
    // The grid's voxel 0 is its own.
    glm::dmat4 from(1.0);
    for (int axis = 0; axis < 3; ++axis)
    {
      from[3][axis] = sparse->origin()[axis];
    }
    scene.volumes[0].data_from_index = from;
    expect_alike(type == VoxelType::Float32 ? "sparse floats" : "sparse halves", scene);
  }
}

// However paths are cut into calls, each is the same, bit for bit.
TEST(PathPackets, DoNotDependOnTheirCompany)
{
  const auto voxels = std::make_shared<Voxels<float>>(
    20, 18, 17, [](int i, int j, int k) { return float(wave(i, j, k)); });
  const Scene scene = lit_density(voxels->grid(), 1.5);
  const PathScene path_scene(scene, 0);
  ASSERT_TRUE(path_scene.packets());
  PathStart start;
  const glm::dvec3 along = glm::normalize(glm::dvec3(-0.5, -0.6, -0.62));
  ASSERT_TRUE(path_scene.find_start({ glm::dvec3(9.1, 8.2, 8.4) - 60.0 * along, along, 1e9 }, start));
  constexpr int count = 500;
  std::vector<float> whole(3 * count);
  PathCounts counts;
  trace_paths(*path_scene.packets(), { start }, count, 0, 1, whole.data(), counts);
  std::vector<float> parts(3 * count);
  for (int first = 0, size = 1; first < count; first += size, size = 1 + (7 * size) % 41)
  {
    size = std::min(size, count - first);
    start.first = static_cast<std::uint32_t>(first);
    trace_paths(*path_scene.packets(), { start }, size, 0, 1, parts.data() + 3 * first, counts);
  }
  EXPECT_EQ(whole, parts);
}

// The last digits of a target may send a path another way now and then, but no more.
TEST(PathPackets, AreAlikeOnEveryTarget)
{
  const auto voxels = std::make_shared<Voxels<float>>(
    20, 18, 17, [](int i, int j, int k) { return float(0.1 + wave(i, j, k)); });
  const Scene scene = lit_density(voxels->grid(), 1.0);
  const PathScene path_scene(scene, 0);
  ASSERT_TRUE(path_scene.packets());
  PathStart start;
  const glm::dvec3 along = glm::normalize(glm::dvec3(-0.5, -0.6, -0.62));
  ASSERT_TRUE(path_scene.find_start({ glm::dvec3(9.1, 8.2, 8.4) - 60.0 * along, along, 1e9 }, start));
  constexpr int count = 3000;
  std::vector<float> first;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
  {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    std::vector<float> radiance(3 * count);
    PathCounts counts;
    trace_paths(*path_scene.packets(), { start }, count, 0, 1, radiance.data(), counts);
    first = first.empty() ? radiance : first;
    int other = 0;
    for (std::size_t i = 0; i < radiance.size(); ++i)
    {
      other += !(std::abs(radiance[i] - first[i]) <= 1e-3f * (first[i] + 1e-3f));
    }
    EXPECT_LE(other, 3 * count / 50) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}
