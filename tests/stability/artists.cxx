#include "artists.h"

#include "../support/sparse_grids.h"

#include "Transport/path_tracer.h"
#include "Transport/reference.h"

#include <cmath>
#include <memory>
#include <utility>

namespace stability
{

namespace
{

/// A soft ball off the middle, in [0, 100].
double ball(int i, int j, int k)
{
  const glm::dvec3 p(i / 10.0 - 1.1, j / 9.0 - 1.0, k / 8.5 - 0.9);
  return 100.0 /
         (1.0 + std::exp(10.0 * (glm::length(p) - 0.75 - 0.07 * std::sin(9.0 * p.x + 7.0 * p.y))));
}

struct Matter
{
  Voxels<float> floats{ 21, 19, 18, ball };
  Voxels<float> small{ 6, 5, 5, [](int i, int j, int k) { return ball(4 * i, 4 * j, 4 * k); } };
  Voxels<std::uint16_t> shorts{ 21, 19, 18, ball };
  std::unique_ptr<SparseVoxels> sparse = sparse_grids::make_sparse(VoxelType::Float32,
    { { 0, 0, 0 } },
    { { 20, 18, 17 } },
    0.0,
    [](int i, int j, int k)
    {
      const double v = ball(i, j, k);
      return v > 5.0 ? v : 0.0;
    });
};

const Matter& matter()
{
  static const Matter all;
  return all;
}

void look(Scene& scene)
{
  scene.camera = view_of(scene, glm::dvec3(-0.5, 0.3, -0.9), false).camera(1.25);
}

Scene density_scene(const Grid& grid)
{
  Scene scene;
  scene.volumes[0].grid = grid;
  scene.volumes[0].data_from_index = placed(glm::dvec3(0.8, 1.0, 1.3), glm::dvec3(4.0, -9.0, 10.0));
  scene.volumes[0].meaning = ValueMeaning::Density;
  scene.volumes[0].density.extinction = 0.002;
  look(scene);
  return scene;
}

Scene classified_scene()
{
  Scene scene = density_scene(matter().shorts.grid());
  scene.volumes[0].meaning = ValueMeaning::Classified;
  scene.volumes[0].classification = classify(
    0.0,
    100.0,
    [](double v) { return v < 10.0 ? 0.0 : 5e-5 * (v - 10.0) * (v - 10.0); },
    [](double v) { return glm::dvec3(0.01 * v, 1.0 - 0.005 * v, 0.5); },
    1025);
  scene.volumes[0].classification.unit_distance = 2.0;
  scene.volumes[0].grey_range[1] = 100.0;
  return scene;
}

void add_lights(Scene& scene)
{
  scene.lights.resize(2);
  scene.lights[0].direction = glm::normalize(glm::dvec3(0.3, -0.7, -0.6));
  scene.lights[1].positional = true;
  scene.lights[1].position = { 30.0, 5.0, 40.0 };
  scene.lights[1].attenuation = { 1.0, 0.0, 0.002 };
}

Scene lit_scene(const Grid& grid)
{
  Scene scene = density_scene(grid);
  scene.volumes[0].medium.lit = true;
  scene.volumes[0].medium.albedo = { 0.9, 0.8, 0.6 };
  scene.volumes[0].medium.lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.5 } };
  add_lights(scene);
  return scene;
}

MarchSettings settings_of(double step)
{
  MarchSettings settings;
  settings.step = step;
  settings.leave_error = 0.0;
  return settings;
}

Artist marching(const std::string& name,
  const Scene& scene,
  const MarchSettings& settings,
  double error)
{
  Artist artist;
  artist.name = name;
  auto marcher = std::make_shared<Marcher>();
  auto own = std::make_shared<Scene>(scene);
  for (Volume& volume : own->volumes)
  {
    static std::uint64_t revision = 1000;
    volume.data_revision = ++revision; // so that caches are kept
    volume.medium_revision = revision;
  }
  artist.draw = [=](Film& film, int threads, const Progress& progress)
  {
    MarchSettings now = settings;
    now.threads = threads;
    return marcher->render(*own, now, film, progress).completed;
  };
  artist.error = error;
  const bool needs_light = scene.volumes[0].medium.lit; // shadow rays from each piece
  artist.truth = [=](Film& film)
  {
    ReferenceSettings reference;
    reference.tolerance = needs_light ? 0.1 * error : 1e-6;
    reference.most_pieces = needs_light ? 16 : 64;
    render_reference(*own, reference, film);
  };
  return artist;
}

Artist tracing(const std::string& name, const Scene& scene)
{
  Artist artist;
  artist.name = name;
  artist.apart = 0.0;
  auto tracer = std::make_shared<PathTracer>();
  artist.draw = [=](Film& film, int threads, const Progress& progress)
  {
    PathSettings now;
    now.samples_per_pixel = 8;
    now.most_scatterings = scene.fog.enabled ? 3 : 0; // fog has no end
    now.threads = threads;
    return tracer->render(scene, now, film, progress).completed;
  };
  return artist;
}

}

std::vector<Artist> artists()
{
  std::vector<Artist> all;
  const Grid floats = matter().floats.grid();
  MarchSettings settings = settings_of(0.25);
  settings.rule = StepRule::Cells;
  all.push_back(marching("cells", density_scene(floats), settings, 1e-5));
  all.push_back(marching("midpoint", density_scene(floats), settings_of(0.25), 2e-3));
  all.push_back(marching("sparse", density_scene(matter().sparse->grid()), settings, 1e-5));
  settings.rule = StepRule::Integrated;
  all.push_back(marching("integrated", classified_scene(), settings, 2e-3));
  settings.rule = StepRule::Midpoint;
  settings.refinements = 3;
  settings.refine_error = 1e-4;
  settings.jitter = true;
  all.push_back(marching("refined", classified_scene(), settings, 2e-3));
  // A jittered pixel is refined or not by an estimate on the edge: targets then differ by what it
  // tells.
  all.back().apart = 2e-3;

  Scene shaded = classified_scene();
  shaded.volumes[0].shading.enabled = true;
  add_lights(shaded);
  all.push_back(marching("shaded", shaded, settings_of(0.125), 8e-3));
  // pow(cos, 10) magnifies rounding. Normals that turn to the viewer make jumps within cells, whose
  // error falls with the step, not with its square.
  all.back().apart = 1e-4;

  for (const ShadowMethod shadows :
    { ShadowMethod::Rays, ShadowMethod::Volume, ShadowMethod::Functions })
  {
    MarchSettings lit = settings_of(0.25);
    lit.shadows = shadows;
    all.push_back(marching(std::string("lit, shadow ") + shadow_method_name(shadows),
      lit_scene(floats),
      lit,
      shadows == ShadowMethod::Rays ? 2e-3 : 3e-2));
    all.back().apart = 1e-4; // 16 bits a node, and cosines of the functions
  }
  Scene fog = lit_scene(floats);
  fog.sky.radiance = glm::dvec3(0.2, 0.3, 0.4);
  fog.fog.enabled = true;
  fog.fog.extinction = glm::dvec3(0.004);
  fog.fog.falloff = 0.05;
  all.push_back(marching("fog", fog, settings_of(0.25), 2e-2));
  all.back().apart = 1e-4;

  Scene two = classified_scene();
  two.volumes.push_back(density_scene(floats).volumes[0]);
  two.volumes[1].data_from_index = placed(glm::dvec3(1.0), glm::dvec3(8.0, -5.0, 14.0));
  all.push_back(marching("two volumes", two, settings_of(0.25), 4e-3));

  Scene projected = classified_scene();
  for (const auto& [mode, name] : { std::pair(BlendMode::MaximumIntensity, "maximum"),
         std::pair(BlendMode::AverageIntensity, "average"),
         std::pair(BlendMode::Additive, "additive"),
         std::pair(BlendMode::Isosurface, "isosurface"),
         std::pair(BlendMode::Slice, "slice") })
  {
    projected.blend_mode = mode;
    projected.isosurfaces = { 40.0, 70.0 };
    const glm::dvec3 centre(12.0, 0.0, 21.0);
    projected.slice = glm::dvec4(0.6, 0.0, 0.8, -glm::dot(glm::dvec3(0.6, 0.0, 0.8), centre));
    all.push_back(marching(name, projected, settings_of(0.25), 5e-3));
  }

  Scene grey = lit_scene(floats);
  grey.lights.resize(1);
  all.push_back(tracing("packets of paths", grey));
  all.push_back(tracing("paths one by one", lit_scene(matter().sparse->grid())));
  Scene misty = fog;
  all.push_back(tracing("paths in fog", misty));

  Scene once = grey;
  once.volumes[0].grid = matter().small.grid();
  look(once);
  for (const auto& [name, scene] : { std::pair<std::string, Scene>("reference", classified_scene()),
         std::pair<std::string, Scene>("lit reference", once) })
  {
    Artist artist;
    artist.name = name;
    artist.apart = -1.0;
    artist.draw = [own = scene](Film& film, int threads, const Progress& progress)
    {
      ReferenceSettings reference;
      reference.tolerance = 1e-2;
      reference.most_pieces = 4;
      reference.threads = threads;
      return render_reference(own, reference, film, progress).completed;
    };
    all.push_back(artist);
  }
  return all;
}

}
