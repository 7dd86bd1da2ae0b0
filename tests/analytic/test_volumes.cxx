// Several volumes, cuts, masks, components and two-dimensional transfer functions against closed
// forms.
#include "../support/mode_scenes.h"

#include <gtest/gtest.h>

#include <random>

using namespace transport_scenes;

namespace
{

constexpr int edge = 15;

double sigma(double opacity)
{
  return -std::log1p(-opacity);
}

template <class Check>
void for_each_pixel(const Check& check)
{
  for (int y = 0; y < edge; ++y)
  {
    for (int x = 0; x < edge; ++x)
    {
      check(static_cast<std::size_t>(y) * edge + x, x, y);
    }
  }
}

TEST(Volumes, OverlappingDensitiesMultiplyTheirTransmittances)
{
  const Voxels<std::uint8_t> small(5, 6, 7, [](int, int, int) { return 2; });
  const Voxels<float> large(12, 9, 10, [](int, int, int) { return 0.5f; });
  Scene both;
  both.volumes.resize(2);
  Volume& a = both.volumes[0];
  Volume& b = both.volumes[1];
  a.grid = small.grid();
  a.data_from_index = placed(glm::dvec3(1.0, 0.8, 1.2), glm::dvec3(2.0, 1.0, 0.0));
  a.meaning = ValueMeaning::Density;
  a.density.extinction = 0.05;
  b.grid = large.grid();
  // In millimetres, in a scene of centimetres, and turned.
  b.data_from_index = placed(glm::dvec3(6.0, 7.0, 5.0), glm::dvec3(-10.0, 0.0, 0.0));
  b.world_from_data =
    glm::rotate(glm::scale(glm::dmat4(1.0), glm::dvec3(0.1)), 0.4, glm::dvec3(1.0, 2.0, 3.0));
  b.meaning = ValueMeaning::Density;
  b.density.extinction = 0.02;
  b.weight = 0.75;
  const View view = view_of(both, glm::dvec3(-0.6, 0.4, -1.0), false);
  both.camera = view.camera(1.0);
  const Film film = reference(both, edge, edge);
  int overlapping = 0;
  int alone = 0;
  for_each_pixel(
    [&](std::size_t pixel, int x, int y)
    {
      const double first = chord(view, a, x, y, edge, edge).length * 0.05 * 2.0;
      const double second = chord(view, b, x, y, edge, edge).length * 0.02 * 0.5 * 0.75;
      overlapping += first > 0.0 && second > 0.0;
      alone += (first > 0.0) != (second > 0.0);
      ASSERT_NEAR(film.transmittance[1][pixel], std::exp(-first - second), 1e-6);
      ASSERT_EQ(film.radiance[1][pixel], 0.0f);
    });
  EXPECT_GT(overlapping, 10);
  EXPECT_GT(alone, 10);
}

TEST(Volumes, InOnePlaceSendTheirLightInSharesOfTheirExtinction)
{
  const Block block;
  Scene scene;
  scene.volumes = { block.volume(0.1, glm::dvec3(1.0, 0.0, 0.2)),
    block.volume(0.2, glm::dvec3(0.0, 1.0, 0.2), 2.0) };
  scene.volumes[1].weight = 3.0;
  const View view = view_of(scene, glm::dvec3(0.2, 0.3, -1.0), false);
  scene.camera = view.camera(1.0);
  const double s1 = sigma(0.1);
  const double s2 = 3.0 * sigma(0.2) / 2.0;
  for (Mixture mixture : { Mixture::Sum, Mixture::Components })
  {
    scene.mixture = mixture;
    const double s = mixture == Mixture::Sum ? s1 + s2 : (s1 * s1 + s2 * s2) / (s1 + s2);
    const Film film = reference(scene, edge, edge);
    for_each_pixel(
      [&](std::size_t pixel, int x, int y)
      {
        const double length = chord(view, scene.volumes[0], x, y, edge, edge).length;
        const double passes = std::exp(-s * length);
        ASSERT_NEAR(film.transmittance[0][pixel], passes, 1e-6);
        ASSERT_NEAR(film.radiance[0][pixel], s1 / s * (1.0 - passes), 1e-6);
        ASSERT_NEAR(film.radiance[1][pixel], s2 / s * (1.0 - passes), 1e-6);
        ASSERT_NEAR(film.radiance[2][pixel], 0.2 * (s1 + s2) / s * (1.0 - passes), 1e-6);
      });
  }
}

TEST(Cropping, RegionsAreWhereTheirBitsSay)
{
  const Block block(12);
  std::mt19937 random(5);
  for (int trial = 0; trial < 12; ++trial)
  {
    Scene scene;
    Volume& volume = scene.volumes[0];
    volume = block.volume(0.15, glm::dvec3(1.0));
    volume.data_from_index = placed(glm::dvec3(1.0, 0.7, 1.4), glm::dvec3(0.0));
    volume.cropping.enabled = true;
    volume.cropping.regions = trial == 0 ? 0x2000 : random() & 0x7ffffff;
    for (int axis = 0; axis < 3; ++axis)
    {
      volume.cropping.lower[axis] = trial == 3 ? -5.0 : 2.3 + 0.4 * axis; // one outside the grid
      volume.cropping.upper[axis] = 7.9 - 0.7 * axis;
    }
    const View view = view_of(scene,
      glm::dvec3(0.3 + 0.1 * trial, -0.6 + 0.15 * trial, trial % 2 ? -1.0 : 0.8),
      trial % 3 == 0);
    scene.camera = view.camera(1.0);
    const Film film = reference(scene, edge, edge);
    for_each_pixel(
      [&](std::size_t pixel, int x, int y)
      {
        const Chord c = chord(view, volume, x, y, edge, edge);
        constexpr int points = 20000;
        int drawn = 0;
        for (int i = 0; i < points && c.length > 0.0; ++i)
        {
          const glm::dvec3 p = c.begin + (c.end - c.begin) * ((i + 0.5) / points);
          int region = 0;
          for (int axis = 0, factor = 1; axis < 3; ++axis, factor *= 3)
          {
            region += factor * ((p[axis] >= volume.cropping.lower[axis]) +
                                 (p[axis] > volume.cropping.upper[axis]));
          }
          drawn += volume.cropping.regions >> region & 1;
        }
        const double length = c.length * drawn / points;
        // Up to 6 cuts, each off by half a point.
        const double bound = sigma(0.15) * 3.0 * c.length / points + 2e-6;
        ASSERT_NEAR(film.transmittance[0][pixel], std::exp(-sigma(0.15) * length), bound)
          << trial << ' ' << x << ' ' << y;
      });
  }
}

TEST(Cropping, PartsOfAVolumeAddUpToIt)
{
  const Product f;
  const Voxels<float> voxels = voxels_of(9, 8, 10, f);
  Scene whole;
  Volume& volume = whole.volumes[0];
  volume.grid = voxels.grid();
  volume.data_from_index = placed(glm::dvec3(1.0, 1.5, 0.7), glm::dvec3(-3.0, 10.0, 2.0));
  volume.classification = classify(
    -100.0,
    100.0,
    [](double v) { return 0.2 + 0.0015 * v; },
    [](double v) { return glm::dvec3(0.5 + 0.005 * v, 0.5, 0.5 - 0.005 * v); });
  whole.camera = view_of(whole, glm::dvec3(0.7, -0.5, -0.9), false).camera(1.0);
  volume.shading.enabled = true;
  volume.shading.two_sided = false; // normals that are turned round make jumps
  whole.lights.resize(1);
  Scene parts = whole;
  parts.volumes.resize(2, whole.volumes[0]);
  for (int i = 0; i < 2; ++i)
  {
    Cropping& cropping = parts.volumes[i].cropping;
    cropping.enabled = true;
    for (int axis = 0; axis < 3; ++axis)
    {
      cropping.lower[axis] = 2.2 + axis;
      cropping.upper[axis] = 5.6;
    }
    cropping.regions = i == 0 ? 0x55a55a5 : 0x7ffffff & ~0x55a55a5u;
  }
  // Each is refined until it changes by 1e-6, not to the last digit.
  EXPECT_LT(difference(reference(whole, edge, edge), reference(parts, edge, edge)), 1e-5);
}

TEST(ClippingPlanes, KeepTheSideTheyPointTo)
{
  const Block block;
  Scene scene;
  Volume& volume = scene.volumes[0];
  volume = block.volume(0.15, glm::dvec3(1.0));
  volume.world_from_data = glm::rotate(
    glm::translate(glm::dmat4(1.0), glm::dvec3(4.0, 5.0, 6.0)), 0.5, glm::dvec3(1.0, 0.5, -1.0));
  const View view = view_of(scene, glm::dvec3(0.2, 0.3, -1.0), false);
  scene.camera = view.camera(1.0);
  const glm::dvec3 normals[2] = { glm::normalize(glm::dvec3(1.0, 2.0, 1.0)),
    glm::normalize(glm::dvec3(-1.0, 0.5, 2.0)) };
  for (int i = 0; i < 2; ++i)
  {
    volume.clipping_planes.push_back(
      glm::dvec4(normals[i], 0.5 + i - glm::dot(normals[i], view.centre)));
  }
  const Film film = reference(scene, edge, edge);
  int cut = 0;
  for_each_pixel(
    [&](std::size_t pixel, int x, int y)
    {
      const Chord c = chord(view, volume, x, y, edge, edge);
      double s0 = 0.0;
      double s1 = c.length > 0.0 ? 1.0 : 0.0;
      for (const glm::dvec4& plane : volume.clipping_planes)
      {
        const auto height = [&](const glm::dvec3& p)
        { return glm::dot(plane, volume.world_from_data * glm::dvec4(p, 1.0)); };
        const double a = height(c.begin);
        const double b = height(c.end);
        cut += a * b < 0.0;
        s0 = a < 0.0 ? std::max(s0, b > 0.0 ? a / (a - b) : 1.0) : s0;
        s1 = b < 0.0 ? std::min(s1, a > 0.0 ? a / (a - b) : 0.0) : s1;
      }
      const double length = c.length * std::max(0.0, s1 - s0);
      ASSERT_NEAR(film.transmittance[0][pixel], std::exp(-sigma(0.15) * length), 1e-6);
    });
  EXPECT_GT(cut, 20);
}

/// A block looked at along −x: every ray passes voxels 8 to 0.
struct BlockAlongX
{
  Block block;
  Scene scene;
  std::vector<std::uint8_t> labels;

  BlockAlongX()
  {
    scene.volumes[0] = block.volume(0.1, glm::dvec3(0.2, 0.4, 0.6));
    scene.camera = view_of(scene, glm::dvec3(-1, 0, 0), true).camera(1.0);
    labels.resize(scene.volumes[0].grid.voxel_count());
    for (std::size_t i = 0; i < labels.size(); ++i)
    {
      labels[i] = static_cast<std::uint8_t>(i % 9); // the voxel along x
    }
    scene.volumes[0].mask.labels = labels.data();
  }
};

TEST(Masks, HideHalfWayBetweenVoxels)
{
  for (bool linear : { true, false })
  {
    BlockAlongX b;
    b.scene.volumes[0].grid.linear = linear;
    for (int label : { 3, 4, 8 }) // the lengths of 1, 1 and ½ voxel
    {
      b.scene.volumes[0].mask.classification_of_label[label] = Mask::hidden;
    }
    EXPECT_NEAR(reference(b.scene, 3, 3).transmittance[0][4], std::exp(-sigma(0.1) * 5.5), 1e-6);
    b.scene.blend_mode = BlendMode::Additive;
    b.scene.volumes[0].grey_range[1] = 200.0;
    b.scene.volumes[0].classification.unit_distance = 2.0;
    EXPECT_NEAR(reference(b.scene, 3, 3).radiance[0][4], 0.1 * 0.5 * 5.5 / 2.0, 1e-6);
  }
  BlockAlongX b;
  b.scene.volumes[0].mask.classification_of_label.fill(Mask::hidden);
  for (BlendMode mode : { BlendMode::Composite,
         BlendMode::MaximumIntensity,
         BlendMode::AverageIntensity,
         BlendMode::Additive })
  {
    b.scene.blend_mode = mode;
    const Film film = reference(b.scene, 3, 3);
    EXPECT_EQ(film.transmittance[0][4], 1.0f);
    EXPECT_EQ(film.radiance[0][4], 0.0f);
  }
}

TEST(Masks, LabelsHaveFunctionsOfTheirOwn)
{
  BlockAlongX b;
  Volume& volume = b.scene.volumes[0];
  volume.label_classifications = { b.block.volume(0.3, glm::dvec3(1, 0, 0)).classification,
    b.block.volume(0.5, glm::dvec3(0, 1, 0), 3.0).classification };
  volume.mask.classification_of_label = {};
  volume.mask.classification_of_label[6] = 1;
  volume.mask.classification_of_label[7] = 2;
  volume.mask.classification_of_label[2] = Mask::hidden;
  const Film film = reference(b.scene, 3, 3);
  // Front to back: ½ voxel of 8, 7, 6, 5 to 3, [2], 1, ½ of 0.
  struct Slab
  {
    double length;
    double extinction;
    glm::dvec3 colour;
  };
  const glm::dvec3 base(0.2, 0.4, 0.6);
  double passes = 1.0;
  glm::dvec3 radiance(0.0);
  for (const Slab& slab : { Slab{ 0.5, sigma(0.1), base },
         Slab{ 1.0, sigma(0.5) / 3.0, { 0, 1, 0 } },
         Slab{ 1.0, sigma(0.3), { 1, 0, 0 } },
         Slab{ 4.5, sigma(0.1), base } })
  {
    const double through = std::exp(-slab.extinction * slab.length);
    radiance += slab.colour * (passes * (1.0 - through));
    passes *= through;
  }
  EXPECT_NEAR(film.transmittance[0][4], passes, 1e-6);
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_NEAR(film.radiance[c][4], radiance[c], 1e-6);
  }
}

/// A smooth solid with slopes of every size.
struct Bump
{
  Voxels<std::uint16_t> voxels{ 17,
    15,
    16,
    [](int i, int j, int k)
    {
      return 1000.0 *
             std::exp(-0.03 * (std::pow(i - 8, 2) + std::pow(j - 7, 2) + std::pow(k - 7, 2)));
    } };
  Scene scene;

  Bump()
  {
    Volume& volume = scene.volumes[0];
    volume.grid = voxels.grid();
    volume.data_from_index = placed(glm::dvec3(1.0, 1.1, 0.9), glm::dvec3(0.0));
    volume.classification.gradient_scale = glm::dvec3(1.0, 1.1, 0.9);
    scene.camera = view_of(scene, glm::dvec3(0.4, 0.3, -1.0), false).camera(1.0);
  }
};

double opacity_of(double v)
{
  return 0.3 * v / 1000.0;
}

TEST(ValueAndGradient, OfTheValueAloneIsTheFunctionOfTheValue)
{
  Bump one;
  const glm::dvec3 scale = one.scene.volumes[0].classification.gradient_scale;
  one.scene.volumes[0].classification = classify(0.0,
    1000.0,
    opacity_of,
    [](double v) { return glm::dvec3(v / 1000.0, 1.0 - v / 1000.0, 0.5); });
  Bump two;
  Classification& c = two.scene.volumes[0].classification;
  c.upper = 1000.0;
  c.gradient_upper = 50.0;
  c.value_gradient_width = 5;
  for (int row = 0; row < 3; ++row)
  {
    for (double v : { 0.0, 250.0, 500.0, 750.0, 1000.0 })
    {
      c.value_gradient.insert(
        c.value_gradient.end(), { v / 1000.0, 1.0 - v / 1000.0, 0.5, opacity_of(v) });
    }
  }
  for (BlendMode mode : { BlendMode::Composite, BlendMode::MaximumIntensity, BlendMode::Additive })
  {
    one.scene.blend_mode = two.scene.blend_mode = mode;
    EXPECT_LT(difference(reference(one.scene, edge, edge), reference(two.scene, edge, edge)), 1e-6);
  }
  // The same, lit.
  one.scene.blend_mode = two.scene.blend_mode = BlendMode::Composite;
  one.scene.volumes[0].classification.gradient_scale = scale;
  one.scene.volumes[0].shading.enabled = two.scene.volumes[0].shading.enabled = true;
  one.scene.lights.resize(1);
  two.scene.lights.resize(1);
  EXPECT_LT(difference(reference(one.scene, edge, edge), reference(two.scene, edge, edge)), 1e-6);
}

TEST(ValueAndGradient, OfTheGradientAloneIsAGradientOpacity)
{
  // Extinctions multiply, opacities do not: a function of two nodes of opacity 0 and ½ has the
  // extinction −ln(1 − m/2), which the gradient opacity of the other scene follows with 1000 nodes.
  Bump one;
  Classification& c = one.scene.volumes[0].classification;
  const glm::dvec3 scale = c.gradient_scale;
  c = classify(
    0.0, 1000.0, [](double) { return 0.5; }, [](double) { return glm::dvec3(0.7); }, 2);
  c.gradient_scale = scale;
  c.gradient_upper = 120.0;
  for (int i = 0; i <= 4000; ++i)
  {
    c.gradient_opacity.push_back(sigma(0.5 * i / 4000.0) / sigma(0.5));
  }
  Bump two;
  Classification& d = two.scene.volumes[0].classification;
  d.upper = 1000.0;
  d.gradient_upper = 120.0;
  d.value_gradient_width = 2;
  d.value_gradient = { 0.7,
    0.7,
    0.7,
    0.0,
    0.7,
    0.7,
    0.7,
    0.0, // magnitude 0
    0.7,
    0.7,
    0.7,
    0.5,
    0.7,
    0.7,
    0.7,
    0.5 };
  const Film a = reference(one.scene, edge, edge);
  EXPECT_LT(difference(a, reference(two.scene, edge, edge)), 1e-5);
  EXPECT_LT(*std::min_element(a.transmittance[0].begin(), a.transmittance[0].end()), 0.7f);
}

TEST(Components, OneIsTheValueAndOneTheColour)
{
  // Along z: component 0 ramps from 0 to 100, 1 is constant, 2 is never looked at.
  std::vector<std::int16_t> values;
  for (int k = 0; k < 11; ++k)
    for (int i = 0; i < 16; ++i)
    {
      values.insert(values.end(), { static_cast<std::int16_t>(10 * k), -40, 3000 });
    }
  Scene scene;
  Volume& volume = scene.volumes[0];
  volume.grid.voxels = values.data();
  volume.grid.type = VoxelType::Int16;
  volume.grid.components = 3;
  volume.grid.component = 1;
  volume.grid.colour = VoxelColour::First;
  volume.grid.dims[0] = volume.grid.dims[1] = 4;
  volume.grid.dims[2] = 11;
  volume.classification = classify(
    -100.0,
    100.0,
    [](double v) { return v < 0.0 ? 0.2 : 0.0; },
    [](double v) { return glm::dvec3(v / 100.0); },
    2001);
  scene.camera = view_of(scene, glm::dvec3(0, 0, -1), true).camera(1.0);
  const Film film = reference(scene, 3, 3);
  const double s = sigma(0.2);
  const double through = std::exp(-10.0 * s);
  EXPECT_NEAR(film.transmittance[0][4], through, 1e-6);
  // ∫ (1 − t/10) s e^(−s t) dt from 0 to 10.
  EXPECT_NEAR(film.radiance[0][4], 1.0 - (1.0 - through) / (10.0 * s), 2e-5);

  // The largest of component 1 is first reached at the near end, where component 0 is 100.
  scene.blend_mode = BlendMode::MaximumIntensity;
  EXPECT_NEAR(reference(scene, 3, 3).radiance[0][4], 0.2, 1e-6);
  // The mean is of component 0, with the opacity of component 1.
  scene.blend_mode = BlendMode::AverageIntensity;
  volume.grey_range[1] = 100.0;
  EXPECT_NEAR(reference(scene, 3, 3).radiance[0][4], 0.2 * 0.5, 1e-6);
}

}
