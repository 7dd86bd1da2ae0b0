// The kernels of the modes other than Composite against the reference, on every SIMD target.
#include "../support/mode_scenes.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

using namespace transport_scenes;

namespace
{

constexpr int width = 45;
constexpr int height = 37;

template <class T>
double full_scale()
{
  return std::is_floating_point_v<T> ? 1.0 : double(std::numeric_limits<T>::max());
}

/// Smooth matter with noise on it, so that extremes lie inside cells as well as at voxels.
template <class T>
Voxels<T> noisy(int nx = 37, int ny = 29, int nz = 33)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-0.15, 0.15);
  return Voxels<T>(nx, ny, nz,
    [=](int i, int j, int k) mutable
    {
      const glm::dvec3 p(double(i) / nx - 0.45, double(j) / ny - 0.55, double(k) / nz - 0.5);
      const double v = 0.6 * std::exp(-9.0 * glm::dot(p, p)) + 0.2 + noise(random);
      return std::clamp(v, 0.0, 1.0) * full_scale<T>();
    });
}

/// One volume, drawn as a ramp of opacities and colours.
template <class T>
struct Scenery
{
  Voxels<T> voxels = noisy<T>();
  Scene scene;
  std::vector<std::uint8_t> labels;

  explicit Scenery(BlendMode mode)
  {
    const double full = full_scale<T>();
    Volume& volume = scene.volumes[0];
    volume.grid = voxels.grid();
    volume.data_from_index = placed(glm::dvec3(1.0, 1.2, 0.9), glm::dvec3(-3.0, 10.0, 2.0));
    volume.classification = classify(0.0, full, [=](double v) { return 0.1 + 0.8 * v / full; },
      [=](double v) { return glm::dvec3(v / full, 1.0 - 0.5 * v / full, 0.3); }, 257);
    volume.classification.unit_distance = 15.0;
    volume.classification.gradient_scale = glm::dvec3(1.0, 1.2, 0.9);
    volume.grey_range[1] = full;
    scene.average_range[0] = 0.25 * full;
    scene.average_range[1] = 0.6 * full;
    scene.isosurfaces = { 0.5 * full, 0.31 * full };
    scene.blend_mode = mode;
    scene.lights.resize(1);
    const View view = view_of(scene, glm::dvec3(0.6, -0.4, -1.0), false);
    scene.camera = view.camera(double(width) / height);
    scene.slice = glm::dvec4(0.3, 0.2, 1.0, -glm::dot(glm::dvec3(0.3, 0.2, 1.0), view.centre));
  }

  Volume& volume() { return scene.volumes[0]; }
  void add_mask()
  {
    labels.resize(voxels.values.size());
    for (std::size_t i = 0; i < labels.size(); ++i)
    {
      labels[i] = static_cast<std::uint8_t>(i / 5 % 4);
    }
    volume().mask.labels = labels.data();
    volume().mask.classification_of_label = {};
    volume().mask.classification_of_label[1] = Mask::hidden;
    volume().mask.classification_of_label[2] = 1;
    const double full = full_scale<T>();
    volume().label_classifications = { classify(0.0, full, [=](double v) { return 0.9 - 0.5 * v / full; },
      [=](double v) { return glm::dvec3(0.2, v / full, 0.9); }, 33) };
  }
};

constexpr BlendMode all_modes[] = { BlendMode::MaximumIntensity, BlendMode::MinimumIntensity,
  BlendMode::AverageIntensity, BlendMode::Additive, BlendMode::Isosurface, BlendMode::Slice };

double agreement(const Scene& scene)
{
  const bool linear = scene.volumes[0].grid.linear;
  switch (scene.blend_mode)
  {
    case BlendMode::AverageIntensity:
      return linear ? 2e-3 : 1e-2; // kinks and jumps within steps of a twentieth of a voxel
    case BlendMode::Additive:
      return linear ? 5e-4 : 5e-3;
    default:
      return 5e-5;
  }
}

/// How many pixels may differ by more: those whose rays graze a surface, or a corner of a voxel or
/// of the box, so that rounding settles whether it is met.
std::size_t allowed(const Scene& scene)
{
  return scene.blend_mode == BlendMode::Isosurface ? 4 : scene.volumes[0].grid.linear ? 0 : 2;
}

std::size_t differing(const Film& a, const Film& b, double bound)
{
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    bool same = true;
    for (int c = 0; c < 3; ++c)
    {
      same = same && std::abs(a.radiance[c][i] - b.radiance[c][i]) <= bound &&
        std::abs(a.transmittance[c][i] - b.transmittance[c][i]) <= bound;
    }
    count += !same;
  }
  return count;
}

void expect_agreement(const Scene& scene, const char* what, const std::string& target = {})
{
  const Film truth = reference(scene, width, height, 1e-5);
  const Film film = march(scene, width, height, 0.05);
  ASSERT_TRUE(all_finite(film));
  std::size_t drawn = 0;
  for (float t : truth.transmittance[0])
  {
    drawn += t < 1.0f;
  }
  EXPECT_GT(drawn, truth.size() / 20) << what;
  EXPECT_LE(differing(film, truth, agreement(scene)), allowed(scene))
    << what << ", mode " << int(scene.blend_mode) << ' ' << target << ", difference "
    << difference(film, truth);
}

template <class T>
struct Modes : testing::Test
{
};
using VoxelTypes =
  testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, float>;
TYPED_TEST_SUITE(Modes, VoxelTypes);

TYPED_TEST(Modes, AgreeWithTheReference)
{
  for (BlendMode mode : all_modes)
  {
    Scenery<TypeParam> s(mode);
    expect_agreement(s.scene, "plain");
    s.volume().grid.linear = false;
    s.volume().grid.cell_centred = true;
    expect_agreement(s.scene, "nearest cells");
  }
}

TEST(Modes, AgreeOnEveryTarget)
{
  for (const std::string& target : targets())
  {
    ASSERT_TRUE(force_simd_target(target));
    for (BlendMode mode : all_modes)
    {
      expect_agreement(Scenery<std::uint16_t>(mode).scene, "plain", target);
    }
  }
  force_simd_target("");
}

TEST(Modes, AgreeInPartsOfAVolume)
{
  for (BlendMode mode : all_modes)
  {
    Scenery<std::uint16_t> s(mode);
    Cropping& cropping = s.volume().cropping;
    cropping.enabled = true;
    cropping.regions = 0x5ad4e93;
    for (int axis = 0; axis < 3; ++axis)
    {
      cropping.lower[axis] = 8.3 + axis;
      cropping.upper[axis] = 20.6 - axis;
    }
    const glm::dvec3 centre(15.0, 27.0, 17.0);
    const glm::dvec3 normal = glm::normalize(glm::dvec3(1.0, 0.5, 0.7));
    s.volume().clipping_planes = { glm::dvec4(normal, 4.0 - glm::dot(normal, centre)) };
    expect_agreement(s.scene, "cropped and clipped");
  }
}

TEST(Modes, AgreeUnderAMask)
{
  for (BlendMode mode : all_modes)
  {
    Scenery<std::uint16_t> s(mode);
    s.add_mask();
    // Steps end anywhere, labels half-way between voxels: greys are coarser here, most of all the
    // means of rays that pass a corner.
    if (mode == BlendMode::AverageIntensity || mode == BlendMode::Additive)
    {
      const Film film = march(s.scene, width, height, 0.01);
      EXPECT_LE(differing(film, reference(s.scene, width, height, 1e-5), 3e-3), 3u) << int(mode);
      continue;
    }
    expect_agreement(s.scene, "masked");
  }
}

TEST(Modes, AgreeOnColoursOfTheVoxels)
{
  std::mt19937 random(3);
  std::vector<std::uint8_t> values(31 * 27 * 29 * 4);
  for (std::uint8_t& v : values)
  {
    v = static_cast<std::uint8_t>(random() % 256);
  }
  for (BlendMode mode : all_modes)
  {
    for (VoxelColour colour : { VoxelColour::First, VoxelColour::RGB })
    {
      Scenery<std::uint8_t> s(mode);
      Grid& grid = s.volume().grid;
      grid.voxels = values.data();
      grid.components = 4;
      grid.component = 3;
      grid.colour = colour;
      grid.dims[0] = 31;
      grid.dims[1] = 27;
      grid.dims[2] = 29;
      s.scene.average_range[0] = 60.0;
      expect_agreement(s.scene, colour == VoxelColour::RGB ? "RGB" : "first component");
    }
  }
}

TEST(Modes, AgreeOnFunctionsOfValueAndGradient)
{
  for (BlendMode mode : all_modes)
  {
    Scenery<float> s(mode);
    Classification& c = s.volume().classification;
    c.opacity.clear();
    c.rgb.clear();
    c.value_gradient_width = 4;
    c.gradient_upper = 0.4;
    for (int row = 0; row < 3; ++row)
    {
      for (int column = 0; column < 4; ++column)
      {
        c.value_gradient.insert(c.value_gradient.end(),
          { 0.3 * column, 0.2 + 0.3 * row, 0.5, 0.1 + 0.2 * column + 0.1 * row });
      }
    }
    expect_agreement(s.scene, "value and gradient");
  }
}

TEST(Modes, SurfacesAreLitAndWeighted)
{
  for (BlendMode mode : { BlendMode::Isosurface, BlendMode::Slice })
  {
    Scenery<float> s(mode);
    // Smooth: the normals of noise turn by themselves between roots that rounding shifts.
    s.voxels = Voxels<float>(37, 29, 33, [](int i, int j, int k)
      { return std::exp(-0.006 * (std::pow(i - 18, 2) + std::pow(j - 14, 2) + std::pow(k - 15, 2))); });
    s.volume().grid.voxels = s.voxels.values.data();
    s.volume().shading.enabled = true;
    s.scene.lights[0].direction = glm::normalize(glm::dvec3(0.3, -0.2, -1.0));
    s.volume().classification.gradient_opacity = { 0.2, 1.0 };
    s.volume().classification.gradient_upper = 0.1;
    const Film truth = reference(s.scene, width, height);
    const Film film = march(s.scene, width, height, 1.0);
    EXPECT_LE(differing(film, truth, 2e-4), 1u) << difference(film, truth);
    double depth_error = 0.0;
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      if (std::isfinite(truth.depth[i]) && std::isfinite(film.depth[i]))
      {
        depth_error = std::max(depth_error, double(std::abs(film.depth[i] - truth.depth[i])));
      }
    }
    EXPECT_LT(depth_error, 1e-3);
  }
}

TEST(Modes, ComponentsAddUp)
{
  for (BlendMode mode : all_modes)
  {
    Scenery<std::uint16_t> s(mode);
    s.scene.volumes.push_back(s.scene.volumes[0]);
    s.scene.volumes[0].weight = 0.4;
    Volume& other = s.scene.volumes[1];
    other.weight = 0.3;
    other.classification = classify(0.0, 65535.0, [](double v) { return 1.0 - 0.5 * v / 65535.0; },
      [](double) { return glm::dvec3(0.2, 0.7, 0.9); }, 17);
    other.classification.unit_distance = 30.0;
    other.world_from_data = glm::translate(glm::dmat4(1.0), glm::dvec3(9.0, 3.0, -4.0));
    expect_agreement(s.scene, "two volumes");
  }
}

// Where the value runs evenly, opacity times grey is integrated exactly: one step is enough.
TEST(Modes, GreysOfARampNeedOneStep)
{
  const Voxels<std::uint8_t> voxels(8, 8, 31, [](int, int, int k) { return 3 * k; });
  Scene scene;
  Volume& volume = scene.volumes[0];
  volume.grid = voxels.grid();
  volume.data_from_index = placed(glm::dvec3(1.0, 1.0, 0.5), glm::dvec3(0.0));
  volume.classification = classify(0.0, 90.0, [](double v) { return 0.8 * v / 90.0; },
    [](double) { return glm::dvec3(1.0); }, 2);
  volume.classification.unit_distance = 20.0;
  volume.grey_range[1] = 90.0;
  scene.camera = view_of(scene, glm::dvec3(0, 0, -1), true).camera(1.0);
  scene.blend_mode = BlendMode::Additive; // 15 long: one step, or one and a half
  EXPECT_NEAR(march(scene, 3, 3, 15.0).radiance[0][4], 0.8 / 3.0 * 15.0 / 20.0, 1e-6);
  EXPECT_NEAR(march(scene, 3, 3, 10.0).radiance[0][4], 0.8 / 3.0 * 15.0 / 20.0, 1e-6);
  scene.blend_mode = BlendMode::AverageIntensity;
  EXPECT_NEAR(march(scene, 3, 3, 15.0).radiance[0][4], 0.8 / 3.0, 1e-6);
  scene.average_range[0] = 36.0;
  scene.average_range[1] = 63.0;
  const double mean = 0.8 * (0.7 * 0.7 * 0.7 - 0.4 * 0.4 * 0.4) / 3.0 / 0.3;
  EXPECT_NEAR(march(scene, 3, 3, 15.0).radiance[0][4], mean, 1e-5);
  EXPECT_NEAR(march(scene, 3, 3, 4.0).radiance[0][4], mean, 1e-5);
}

// Composite by the kernel of mixtures: midpoints of steps, so to the square of the step.
TEST(Mixtures, AgreeWithTheReference)
{
  const auto expect = [](const Scene& scene, const char* what, double bound)
  {
    const double off =
      difference(march(scene, width, height, 0.02), reference(scene, width, height, 1e-5));
    EXPECT_LT(off, bound) << what;
  };
  Scenery<std::uint16_t> cropped(BlendMode::Composite);
  cropped.volume().cropping.enabled = true;
  cropped.volume().cropping.regions = 0x5ad4e93;
  for (int axis = 0; axis < 3; ++axis)
  {
    cropped.volume().cropping.lower[axis] = 8.3 + axis;
    cropped.volume().cropping.upper[axis] = 20.6 - axis;
  }
  expect(cropped.scene, "cropped", 1e-4);

  Scenery<std::uint16_t> masked(BlendMode::Composite);
  masked.add_mask();
  // The label's extinction is up to 2.3, and a step across its edge is off by half of itself.
  expect(masked.scene, "masked", 2.3 * 0.01);
  // Each label has its own factor by gradient: here the label's alone, and strong.
  Classification& label = masked.volume().label_classifications[0];
  label.gradient_upper = masked.volume().classification.gradient_upper = 0.5 * full_scale<std::uint16_t>();
  label.gradient_opacity = { 0.0, 0.3, 1.0 };
  const Film lessened = reference(masked.scene, width, height, 1e-5);
  expect(masked.scene, "masked, by gradient", 0.04); // edges differ by more
  label.gradient_opacity.clear();
  EXPECT_GT(difference(lessened, reference(masked.scene, width, height, 1e-5)), 0.1);

  Scenery<float> both(BlendMode::Composite);
  both.add_mask();
  both.volume().label_classifications.clear();
  both.volume().mask.classification_of_label[2] = 0;
  Classification& c = both.volume().classification;
  c.opacity.clear();
  c.rgb.clear();
  c.value_gradient_width = 2;
  c.gradient_upper = 0.4;
  c.value_gradient = { 0.2, 0.3, 0.4, 0.1, 0.9, 0.3, 0.4, 0.6, //
    0.2, 0.8, 0.4, 0.3, 0.9, 0.3, 0.9, 0.8 };
  expect(both.scene, "value and gradient, masked", 5e-3);

  for (Mixture mixture : { Mixture::Sum, Mixture::Components })
  {
    Scenery<std::uint16_t> two(BlendMode::Composite);
    two.scene.mixture = mixture;
    two.scene.volumes.push_back(two.scene.volumes[0]);
    two.scene.volumes[0].weight = 0.4;
    two.scene.volumes[1].weight = 1.3;
    two.scene.volumes[1].classification = classify(0.0, 65535.0,
      [](double v) { return 1.0 - 0.5 * v / 65535.0; },
      [](double) { return glm::dvec3(0.2, 0.7, 0.9); }, 257);
    two.scene.volumes[1].classification.unit_distance = 30.0;
    two.scene.volumes[1].world_from_data =
      glm::translate(glm::dmat4(1.0), glm::dvec3(9.0, 3.0, -4.0));
    expect(two.scene, mixture == Mixture::Sum ? "sum" : "components", 3e-4);
  }
}

TEST(Modes, HaveTheSameBitsWithAnyNumberOfThreads)
{
  for (BlendMode mode : all_modes)
  {
    const Scenery<std::uint16_t> s(mode);
    const Film one = march(s.scene, width, height, 0.3, 0.0, 1);
    EXPECT_TRUE(same_bits(one, march(s.scene, width, height, 0.3, 0.0, 5))) << int(mode);
  }
}

TEST(Modes, DrawVoxelsThatAreNotFiniteAsNothing)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (BlendMode mode : all_modes)
  {
    Scenery<float> s(mode);
    s.volume().classification.opacity.front() = 0.0; // the value that stands for empty
    for (std::size_t i = 0; i < s.voxels.values.size(); i += 41)
    {
      s.voxels.values[i] = i % 2 ? nan : std::numeric_limits<float>::infinity();
    }
    expect_agreement(s.scene, "with NaN");
    // Nothing but NaN.
    std::fill(s.voxels.values.begin(), s.voxels.values.end(), nan);
    const Film film = march(s.scene, width, height, 0.3);
    EXPECT_TRUE(all_finite(film));
    EXPECT_LT(difference(film, reference(s.scene, width, height)), 1e-5) << int(mode);
  }
}

TEST(Modes, DrawAConstantVolumeAndEmptyRanges)
{
  const Block block(20);
  for (BlendMode mode : all_modes)
  {
    Scene scene;
    scene.volumes[0] = block.volume(0.25, glm::dvec3(0.2, 0.4, 0.6), 30.0);
    scene.volumes[0].grey_range[1] = 200.0;
    scene.camera = view_of(scene, glm::dvec3(0.6, -0.4, -1.0), false).camera(1.0);
    scene.blend_mode = mode;
    scene.slice = glm::dvec4(0.1, 0.2, 1.0, -10.0);
    for (const std::vector<double>& values : { std::vector<double>{}, { 100.0 }, { 20.0, 150.0 } })
    {
      scene.isosurfaces = values;
      EXPECT_LT(difference(march(scene, 15, 15, 0.5), reference(scene, 15, 15)), 1e-5) << int(mode);
    }
    scene.average_range[0] = 101.0;
    scene.volumes[0].grey_range[1] = 0.0;
    EXPECT_LT(difference(march(scene, 15, 15, 0.5), reference(scene, 15, 15)), 1e-5) << int(mode);
  }
}

/// What a marcher keeps between pictures must know the mode.
TEST(Modes, CanBeChangedFromPictureToPicture)
{
  Scenery<std::uint16_t> s(BlendMode::Composite);
  s.volume().data_revision = 1;
  s.volume().medium_revision = 1;
  Marcher marcher;
  MarchSettings settings;
  settings.step = 0.3;
  settings.leave_error = 0.0;
  const auto draw = [&]
  {
    Film film(width, height);
    marcher.render(s.scene, settings, film);
    return film;
  };
  for (int round = 0; round < 2; ++round)
  {
    for (BlendMode mode : { BlendMode::Composite, BlendMode::MaximumIntensity,
           BlendMode::MinimumIntensity, BlendMode::AverageIntensity, BlendMode::Isosurface })
    {
      s.scene.blend_mode = mode;
      s.scene.average_range[0] = round * 30000.0;
      s.scene.isosurfaces = { 30000.0 + 5000.0 * round };
      EXPECT_TRUE(same_bits(draw(), march(s.scene, width, height, 0.3))) << int(mode);
    }
  }
}

TEST(Modes, EndAtOpaqueGeometry)
{
  for (BlendMode mode : all_modes)
  {
    Scenery<std::uint16_t> s(mode);
    s.scene.surface_depth.assign(std::size_t(width) * height, 0.35f);
    const Film truth = reference(s.scene, width, height, 1e-5);
    EXPECT_LE(
      differing(march(s.scene, width, height, 0.05), truth, agreement(s.scene)), allowed(s.scene))
      << int(mode);
  }
}

}
