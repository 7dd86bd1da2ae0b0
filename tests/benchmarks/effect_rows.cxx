// What each effect costs, and that one that is left out costs nothing.
#include "rows.h"

#include "vdb_peer.h"

#include "Transport/effect_plan.h"
#include "Transport/marcher.h"

#include "vtkImageData.h"

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include <cstdio>
#include <ctime>
#include <memory>

namespace benchmarks
{

namespace
{

constexpr double extinction = 12.0; ///< per unit; the cloud's cube is 2 wide

/// The time of all threads of this process. Pictures of the same scene differ by less in it than by
/// the clock, whoever else is at work.
double processor_seconds()
{
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

brume::Light sun()
{
  brume::Light light;
  light.direction = glm::normalize(glm::dvec3(-1.0, 0.4, -0.6));
  return light;
}

/// Two scenes of the same cloud that are drawn in turns.
class Cloud
{
public:
  explicit Cloud(const Options& options)
    : TheCloud(options.quick ? 48 : 256)
    , Film(options.resolution, options.resolution)
  {
    brume::Volume& volume = this->Base.volumes[0];
    const int n = this->TheCloud.size();
    volume.grid.voxels = this->TheCloud.image->GetScalarPointer();
    volume.grid.type = brume::VoxelType::Float32;
    for (int axis = 0; axis < 3; ++axis)
    {
      volume.grid.dims[axis] = n;
    }
    volume.data_from_index = glm::scale(glm::dmat4(1.0), glm::dvec3(this->TheCloud.voxel()));
    volume.density.extinction = extinction;
    volume.meaning = brume::ValueMeaning::Density;
    volume.data_revision = 1;
    volume.medium_revision = 2;
    const glm::dvec3 centre(1.0);
    const glm::dvec3 eye = centre + 4.0 * glm::normalize(glm::dvec3(0.6, -0.7, 0.4));
    this->Base.camera.clip_from_world = glm::ortho(-1.3, 1.3, -1.3, 1.3, 0.5, 10.0) *
                                        glm::lookAt(eye, centre, glm::dvec3(0.0, 0.0, 1.0));
    this->Base.camera.direction = glm::normalize(centre - eye);
    this->Settings.step = 0.5 * this->TheCloud.voxel();
    this->Settings.leave_error = 0.001;
    this->Settings.threads = options.threads;
  }

  /// The cloud as a density that absorbs.
  const brume::Scene& absorbing() const { return this->Base; }

  /// The same extinction by a transfer function: emission and absorption.
  brume::Scene classified() const
  {
    brume::Scene scene = this->Base;
    brume::Volume& volume = scene.volumes[0];
    volume.meaning = brume::ValueMeaning::Classified;
    brume::Classification& c = volume.classification;
    constexpr int nodes = 1025;
    for (int i = 0; i < nodes; ++i)
    {
      const double v = double(i) / (nodes - 1);
      c.opacity.push_back(-std::expm1(-extinction * v));
      c.rgb.insert(c.rgb.end(), { 0.5 + 0.5 * v, 0.5 + 0.5 * v, 0.6 + 0.4 * v });
    }
    volume.medium_revision = 3;
    return scene;
  }

  /// Lit by a sun, nothing else.
  brume::Scene lit() const
  {
    brume::Scene scene = this->Base;
    scene.volumes[0].medium.lit = true;
    scene.lights = { sun() };
    return scene;
  }

  const brume::MarchSettings& settings() const { return this->Settings; }
  brume::Film& film() { return this->Film; }

private:
  SceneOfCloud TheCloud;
  brume::Scene Base;
  brume::MarchSettings Settings;
  brume::Film Film;
};

/// A scene with the settings that it is drawn by; each with a marcher of its own, so that all is
/// kept.
struct Drawing
{
  brume::Scene scene;
  brume::MarchSettings settings;
  /// Effects that are left out, for each picture anew.
  brume::EffectSet effects;
  bool simplify = false;
  brume::Marcher marcher;

  double draw(brume::Film& film)
  {
    const double start = processor_seconds();
    if (this->simplify)
    {
      brume::MarchSettings own = this->settings;
      brume::apply_effects(this->effects, own);
      this->marcher.render(brume::simplified(this->scene, this->effects), own, film);
    }
    else
    {
      this->marcher.render(this->scene, this->settings, film);
    }
    return processor_seconds() - start;
  }
};

struct Pair
{
  std::unique_ptr<Cloud> cloud;
  Drawing subject;
  Drawing other;
};

using Prepare = std::function<void(Pair&)>;

/// Processor time of a picture by that of another.
Row pair_row(const Options& options,
  const std::string& name,
  const std::string& what,
  const std::string& other,
  const Prepare& prepare)
{
  Row row;
  row.name = "effect-" + name;
  row.what = what;
  row.unit = "×";
  row.at_least = false;
  row.other = other;
  row.repetitions = options.quick ? 1 : 7;
  auto pair = std::make_shared<Pair>();
  row.prepare = [=, &options](Row&)
  {
    pair->cloud = std::make_unique<Cloud>(options);
    pair->subject.settings = pair->other.settings = pair->cloud->settings();
    prepare(*pair);
    pair->other.draw(pair->cloud->film());
    pair->subject.draw(pair->cloud->film());
  };
  row.repeat = [=]
  {
    Repetition one;
    one.other = pair->other.draw(pair->cloud->film());
    one.seconds = pair->subject.draw(pair->cloud->film());
    one.figure = one.seconds / one.other;
    return one;
  };
  return row;
}

/// An effect's cost, by that of emission and absorption with the same steps.
struct Effected
{
  const char* name;
  const char* what;
  double target;
  std::function<void(const Cloud&, Drawing&)> make;
};

std::vector<Effected> all_effects()
{
  using brume::ShadowMethod;
  const auto lit = [](const Cloud& cloud, Drawing& d, ShadowMethod shadows)
  {
    d.scene = cloud.lit();
    d.settings.shadows = shadows;
  };
  const auto with = [=](auto change)
  {
    return [=](const Cloud& cloud, Drawing& d)
    {
      lit(cloud, d, ShadowMethod::None);
      change(d.scene.volumes[0].medium, d.scene);
    };
  };
  return {
    { "absorption",
      "a density that absorbs",
      1.0,
      [](const Cloud& cloud, Drawing& d) { d.scene = cloud.absorbing(); } },
    { "emission",
      "a density that sends light by itself",
      2.0,
      [](const Cloud& cloud, Drawing& d)
      {
        d.scene = cloud.absorbing();
        d.scene.volumes[0].medium.lit = true;
        d.scene.volumes[0].medium.emission = glm::dvec3(1.0);
      } },
    { "scattering", "one sun, no shadows", 2.0, with([](auto&, auto&) {}) },
    { "phase-anisotropy",
      "the same, two lobes",
      2.0,
      with(
        [](brume::Medium& m, auto&)
        {
          m.lobes = { { brume::PhaseFunction::HenyeyGreenstein, 0.8, 0.8 },
            { brume::PhaseFunction::HenyeyGreenstein, 0.2, -0.3 } };
        }) },
    { "silver-lining",
      "the same, silver lining",
      2.0,
      with([](brume::Medium& m, auto&) { m.silver_lining.enabled = true; }) },
    { "coloured-extinction",
      "one sun, no shadows, three extinctions",
      3.0,
      with(
        [](auto&, brume::Scene& s) {
          s.volumes[0].density.channels = { 1.0, 0.8, 0.6 };
        }) },
    { "powder",
      "one sun, no shadows, powder",
      3.0,
      with([](brume::Medium& m, auto&) { m.powder.enabled = true; }) },
    { "octaves",
      "one sun, no shadows, four octaves",
      4.0,
      with([](brume::Medium& m, auto&) { m.octaves.count = 4; }) },
    { "ambient",
      "sky and ground",
      3.0,
      with(
        [](auto&, brume::Scene& s)
        {
          s.lights.clear();
          s.sky.radiance = glm::dvec3(0.5);
          s.sky.ground = glm::dvec3(0.1);
        }) },
    { "shadows",
      "one sun, shadows by a light volume that is kept",
      3.0,
      [=](const Cloud& cloud, Drawing& d) { lit(cloud, d, ShadowMethod::Volume); } },
    { "shadow-functions",
      "one sun, shadows by functions of depth",
      6.0,
      [=](const Cloud& cloud, Drawing& d) { lit(cloud, d, ShadowMethod::Functions); } },
    { "gradient-shading",
      "emission and absorption, shaded",
      4.0,
      [](const Cloud& cloud, Drawing& d)
      {
        d.scene = cloud.classified();
        d.scene.volumes[0].shading.enabled = true;
        d.scene.lights = { sun() };
      } },
    { "fog",
      "emission and absorption under fog in layers",
      3.0,
      [](const Cloud& cloud, Drawing& d)
      {
        d.scene = cloud.classified();
        d.scene.fog.enabled = true;
        d.scene.fog.extinction = glm::dvec3(0.2);
        d.scene.fog.falloff = 1.0;
        d.scene.lights = { sun() };
      } },
    { "surfaces",
      "emission and absorption to the middle of the cloud",
      1.0,
      [](const Cloud& cloud, Drawing& d)
      {
        d.scene = cloud.classified();
        const glm::dvec4 middle = d.scene.camera.clip_from_world * glm::dvec4(1.0, 1.0, 1.0, 1.0);
        d.scene.surface_depth.assign(
          const_cast<Cloud&>(cloud).film().size(), static_cast<float>(middle.z / middle.w));
      } },
    { "no-space-leaping",
      "emission and absorption, no leaps",
      3.0,
      [](const Cloud& cloud, Drawing& d)
      {
        d.scene = cloud.classified();
        d.settings.leaping = false;
      } },
  };
}

/// All effects in the scene, none but those of `kept` in the picture; against a scene that has no
/// more than these.
void leave_out(Pair& pair, const brume::Scene& plain, const std::vector<brume::Effect>& kept)
{
  pair.other.scene = plain;
  brume::Scene& scene = pair.subject.scene;
  scene = plain;
  scene.lights = { sun() };
  scene.sky.radiance = glm::dvec3(0.5);
  scene.sky.ground = glm::dvec3(0.1);
  brume::Volume& volume = scene.volumes[0];
  volume.density.channels = { 1.0, 1.0, 1.0 };
  brume::Medium& medium = volume.medium;
  medium.lit = true;
  medium.lobes = { { brume::PhaseFunction::HenyeyGreenstein, 1.0, 0.8 } };
  medium.octaves.count = 4;
  medium.emission = glm::dvec3(0.1);
  medium.silver_lining.enabled = true;
  medium.powder.enabled = true;
  volume.density.channels = { 1.0, 0.9, 0.8 };
  volume.density.extinction = plain.volumes[0].density.extinction / 0.9; // the mean is the same
  pair.subject.simplify = true;
  brume::EffectSet none;
  for (int i = 0; i < brume::effect_count; ++i)
  {
    none.set(static_cast<brume::Effect>(i), false);
  }
  pair.subject.effects = none;
  for (const brume::Effect effect : kept)
  {
    pair.subject.effects.set(effect, true);
  }
}

}

void add_effect_rows(Scenes& scenes, std::vector<Row>& rows)
{
  const Options& options = scenes.options();
  for (const Effected& effected : all_effects())
  {
    Row row = pair_row(options,
      effected.name,
      "256³ cloud, 512², ½ voxel, " + std::string(effected.what) +
        ": against emission and absorption, processor time",
      "emission and absorption",
      [effected](Pair& pair)
      {
        pair.other.scene = pair.cloud->classified();
        effected.make(*pair.cloud, pair.subject);
      });
    row.target = effected.target;
    rows.push_back(row);
  }
  using brume::Effect;
  const struct
  {
    const char* name;
    const char* what;
    bool lit;
    std::vector<Effect> kept;
  } left_out[] = {
    { "left-out-of-light",
      "all effects in the scene, all but scattering and shadows left out",
      true,
      { Effect::Absorption, Effect::Scattering, Effect::Shadows, Effect::SpaceLeaping } },
    { "left-out-of-absorption",
      "all effects in the scene, all but absorption left out",
      false,
      { Effect::Absorption, Effect::SpaceLeaping } },
  };
  for (const auto& one : left_out)
  {
    Row row = pair_row(options,
      one.name,
      "256³ cloud, 512², ½ voxel, " + std::string(one.what) +
        ": against a scene that has none of them, processor time",
      "a scene without them",
      [lit = one.lit, kept = one.kept](Pair& pair)
      { leave_out(pair, lit ? pair.cloud->lit() : pair.cloud->absorbing(), kept); });
    row.target = 1.02;
    row.repetitions = options.quick ? 1 : 11;
    rows.push_back(row);
  }
}

}
