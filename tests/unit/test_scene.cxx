// What cannot be drawn is refused, by the marcher and by the reference, before anything is read.
#include "../support/transport_scenes.h"

#include "Transport/reference.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

using namespace transport_scenes;

namespace
{

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Refusal : testing::Test
{
  Voxels<std::uint8_t> voxels{ 4, 4, 4, [](int i, int, int) { return 40 * i; } };
  Voxels<std::uint8_t> colours{ 4, 4, 4, [](int i, int, int, int c) { return 40 * i + c; } };

  Scene good(ValueMeaning meaning) const
  {
    Scene scene;
    scene.volumes[0].grid = voxels.grid();
    scene.volumes[0].meaning = meaning;
    if (meaning == ValueMeaning::Classified)
    {
      scene.volumes[0].classification = classify(
        0.0, 160.0, [](double v) { return v / 200.0; }, [](double) { return glm::dvec3(1.0); }, 5);
    }
    scene.camera = view_of(scene, glm::dvec3(0, 0, -1), true).camera(1.0);
    return scene;
  }

  template <class Change>
  void refuses(ValueMeaning meaning, const Change& change) const
  {
    Scene scene = good(meaning);
    Film film(4, 4);
    EXPECT_NO_THROW(Marcher().render(scene, {}, film));
    EXPECT_NO_THROW(render_reference(scene, {}, film));
    change(scene);
    EXPECT_THROW(Marcher().render(scene, {}, film), std::invalid_argument);
    EXPECT_THROW(render_reference(scene, {}, film), std::invalid_argument);
    EXPECT_THROW(render_fixed_step(scene, 1.0, SamplePlacement::Middle, 0.0, 1, film),
      std::invalid_argument);
  }
};

TEST_F(Refusal, OfGrids)
{
  for (ValueMeaning meaning : { ValueMeaning::Density, ValueMeaning::Classified })
  {
    refuses(meaning, [](Scene& s) { s.volumes[0].grid.voxels = nullptr; });
    refuses(meaning, [](Scene& s) { s.volumes[0].grid.dims[0] = 1; });
    refuses(meaning, [](Scene& s) { s.volumes[0].grid.dims[1] = 0; });
    refuses(meaning, [](Scene& s) { s.volumes[0].grid.dims[2] = -1; });
    refuses(meaning, [](Scene& s) { s.volumes[0].grid.components = 5; });
    refuses(meaning, [](Scene& s) { s.volumes[0].grid.components = 0; });
    refuses(meaning, [](Scene& s) { s.volumes[0].grid.component = 1; });
    refuses(meaning, [](Scene& s) { s.volumes[0].grid.component = -1; });
    refuses(meaning,
      [](Scene& s)
      {
        s.volumes[0].grid.colour = VoxelColour::RGB;
        s.volumes[0].grid.components = 4;
        s.volumes[0].grid.type = VoxelType::UInt16;
      });
    refuses(meaning, [](Scene& s) { s.volumes[0].weight = -1.0; });
    refuses(meaning, [](Scene& s) { s.volumes.clear(); });
    refuses(meaning,
      [](Scene& s)
      {
        s.volumes[0].grid.dims[0] = 3;
        s.volumes[0].grid.dims[1] = s.volumes[0].grid.dims[2] = 1;
      });
    refuses(meaning, [](Scene& s) { s.surface_depth.resize(3); });
  }
}

TEST_F(Refusal, OfMeanings)
{
  const ValueMeaning density = ValueMeaning::Density;
  const ValueMeaning classified = ValueMeaning::Classified;
  refuses(density, [&](Scene& s) { s.volumes[0].grid = colours.grid(); }); // which of the four?
  refuses(density, [](Scene& s) { s.volumes[0].density.extinction = nan; });
  refuses(density, [](Scene& s) { s.volumes[0].density.extinction = infinity; });
  refuses(density, [](Scene& s) { s.volumes[0].density.extinction = -1.0; });
  refuses(classified, [](Scene& s) { s.volumes[0].classification.rgb.clear(); });
  refuses(classified, [](Scene& s) { s.volumes[0].classification.opacity.clear(); });
  refuses(classified, [](Scene& s) { s.volumes[0].classification.unit_distance = 0.0; });
  refuses(classified,
    [](Scene& s) { s.volumes[0].classification.lower = s.volumes[0].classification.upper; });
  refuses(classified, [](Scene& s) { s.volumes[0].classification.gradient_opacity = { 1.0 }; });
}

TEST_F(Refusal, OfSettings)
{
  const Scene scene = good(ValueMeaning::Classified);
  Film film(4, 4);
  for (double step : { 0.0, -1.0, nan, infinity })
  {
    MarchSettings settings;
    settings.step = step;
    EXPECT_THROW(Marcher().render(scene, settings, film), std::invalid_argument);
    EXPECT_THROW(render_fixed_step(scene, step, SamplePlacement::Middle, 0.0, 1, film),
      std::invalid_argument);
  }
  for (double error : { -1.0, nan })
  {
    MarchSettings settings;
    settings.leave_error = error;
    EXPECT_THROW(Marcher().render(scene, settings, film), std::invalid_argument);
  }
  for (double tolerance : { 0.0, -1.0, nan })
  {
    ReferenceSettings settings;
    settings.tolerance = tolerance;
    EXPECT_THROW(render_reference(scene, settings, film), std::invalid_argument);
  }
  Film none;
  EXPECT_THROW(Marcher().render(scene, {}, none), std::invalid_argument);
  EXPECT_THROW(render_reference(scene, {}, none), std::invalid_argument);
}

TEST(Grid, BoxIsOfPointsOrCells)
{
  Grid grid;
  grid.dims[0] = 2;
  grid.dims[1] = 5;
  grid.dims[2] = 1;
  EXPECT_EQ(grid.lower(1), 0.0);
  EXPECT_EQ(grid.upper(1), 4.0);
  grid.cell_centred = true;
  EXPECT_EQ(grid.lower(1), -0.5);
  EXPECT_EQ(grid.upper(1), 4.5);
  EXPECT_EQ(grid.upper(0), 1.5);
  grid.padding_x = 1;
  EXPECT_EQ(grid.upper(0), 0.5);
  grid.components = 4;
  EXPECT_EQ(grid.bytes(), 40u);
}

TEST(Film, BeginsClearAndGoesOverABackground)
{
  EXPECT_THROW(Film(0, 3), std::invalid_argument);
  EXPECT_THROW(Film(3, -1), std::invalid_argument);
  Film film(2, 1);
  const double background[3] = { 0.25, 0.5, 2.0 };
  EXPECT_EQ(over_background(film, background),
    (std::vector<float>{ 0.25f, 0.5f, 2.0f, 0.25f, 0.5f, 2.0f }));
  EXPECT_TRUE(std::isinf(film.depth[0]));
  film.radiance[0][1] = 3.0f;
  film.transmittance[0][1] = 0.5f;
  film.transmittance[1][1] = 0.0f;
  EXPECT_EQ(over_background(film, background),
    (std::vector<float>{ 0.25f, 0.5f, 2.0f, 3.125f, 0.0f, 2.0f }));
}

TEST_F(Refusal, OfModes)
{
  // In the other modes a density has no colour.
  refuses(ValueMeaning::Density, [](Scene& s) { s.blend_mode = BlendMode::MaximumIntensity; });
  refuses(ValueMeaning::Classified,
    [](Scene& s)
    {
      s.blend_mode = BlendMode::Isosurface;
      s.isosurfaces = { 20.0, nan };
    });
  refuses(ValueMeaning::Classified,
    [](Scene& s)
    {
      s.blend_mode = BlendMode::Slice;
      s.slice = glm::dvec4(0.0, 0.0, 0.0, 1.0);
    });
  refuses(ValueMeaning::Classified,
    [](Scene& s)
    {
      s.blend_mode = BlendMode::Slice;
      s.slice = glm::dvec4(0.0, 0.0, infinity, 1.0);
    });
  const auto two_dimensional = [](Scene& s)
  {
    Classification& c = s.volumes[0].classification;
    c.opacity.clear();
    c.rgb.clear();
    c.value_gradient.assign(16, 0.5);
    c.value_gradient_width = 2;
    return &c;
  };
  refuses(
    ValueMeaning::Classified, [&](Scene& s) { two_dimensional(s)->value_gradient.resize(8); });
  refuses(ValueMeaning::Classified, [&](Scene& s) { two_dimensional(s)->opacity = { 0.0, 1.0 }; });
  refuses(ValueMeaning::Classified, [&](Scene& s) { two_dimensional(s)->gradient_upper = 0.0; });
  refuses(ValueMeaning::Classified, [&](Scene& s) { two_dimensional(s)->unit_distance = 0.0; });
}
}
