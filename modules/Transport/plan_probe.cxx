#include "Transport/plan_probe.h"

#include "Transport/optics.h"
#include "Transport/step_control.h"
#include "Transport/zoom.h"

#include <glm/common.hpp>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace brume
{

namespace
{

/// The optical depth that the scene's extinction is scaled to, corner to corner: small enough for
/// the exponential in single precision, large enough for it to keep the digits of thin matter.
constexpr double scaled_depth = 40.0;
/// Between two rays a depth may be larger than both by half of what they differ by, and some more
/// where it bends.
constexpr double between_rays = 0.55;
/// Above so many lights each is looked at by a quarter of the rays.
constexpr std::size_t few_lights = 4;

void include(MatterFigures& figures, const Classification& c, double lower, double upper)
{
  double gradient = 1.0;
  if (!c.gradient_opacity.empty())
  {
    gradient = *std::max_element(c.gradient_opacity.begin(), c.gradient_opacity.end());
  }
  double most = 0.0;
  for (std::size_t i = 0; i + 3 < c.value_gradient.size(); i += 4)
  {
    most = std::max(most, c.value_gradient[i + 3]);
    for (int k = 0; k < 3; ++k)
    {
      figures.colour[k] = std::max(figures.colour[k], c.value_gradient[i + k]);
    }
  }
  if (!c.opacity.empty())
  {
    const double last = static_cast<double>(c.opacity.size() - 1);
    const double scale = last / (c.upper - c.lower);
    const auto first =
      static_cast<std::size_t>(std::clamp(std::floor((lower - c.lower) * scale), 0.0, last));
    const auto end =
      static_cast<std::size_t>(std::clamp(std::ceil((upper - c.lower) * scale), 0.0, last));
    for (std::size_t i = first; i <= end; ++i)
    {
      most = std::max(most, c.opacity[i]);
      // Colours are interpolated, also toward a node that cannot be seen itself.
      const bool seen = c.opacity[i] > 0.0 || (i > 0 && c.opacity[i - 1] > 0.0) ||
                        (i + 1 < c.opacity.size() && c.opacity[i + 1] > 0.0);
      for (int k = 0; k < 3 && seen && !c.rgb.empty(); ++k)
      {
        figures.colour[k] = std::max(figures.colour[k], c.rgb[3 * i + k]);
      }
    }
  }
  figures.opacity = std::max(figures.opacity, std::min(most, 1.0));
  figures.extinction =
    std::max(figures.extinction, gradient * extinction_from_opacity(most, c.unit_distance));
}

/// The longest way through the grid, in the data's units.
double diagonal(const Volume& volume)
{
  const glm::dmat3 m(volume.data_from_index);
  double longest = 0.0;
  for (int corner = 0; corner < 4; ++corner)
  {
    const glm::dvec3 extent(volume.grid.upper(0) - volume.grid.lower(0),
      (corner & 1 ? -1.0 : 1.0) * (volume.grid.upper(1) - volume.grid.lower(1)),
      (corner & 2 ? -1.0 : 1.0) * (volume.grid.upper(2) - volume.grid.lower(2)));
    longest = std::max(longest, glm::length(m * extent));
  }
  return longest;
}

MatterFigures figures_of(const Volume& volume, double lower, double upper, bool gaps)
{
  MatterFigures figures;
  if (volume.meaning == ValueMeaning::Density)
  {
    figures.density = std::max(0.0, upper);
    figures.amount = figures.density * diagonal(volume);
    figures.extinction = figures.density * volume.density.extinction * volume.weight;
    return figures;
  }
  figures.colour = glm::dvec3(0.0);
  const auto include_all = [&](const Classification& c)
  {
    include(figures, c, gaps ? c.lower : lower, gaps ? c.upper : upper);
    for (std::size_t i = 0; i < c.rgb.size() && volume.grid.colour == VoxelColour::First; ++i)
    {
      double& colour = figures.colour[static_cast<int>(i % 3)];
      colour = std::max(colour, c.rgb[i]);
    }
  };
  include_all(volume.classification);
  for (const Classification& c : volume.label_classifications)
  {
    include_all(c);
  }
  if (volume.grid.colour == VoxelColour::RGB)
  {
    figures.colour = glm::dvec3(1.0);
  }
  figures.extinction *= volume.weight;
  return figures;
}

struct Sphere
{
  glm::dvec3 centre{ 0.0 };
  double radius = 1.0;
};

Sphere around_volumes(const Scene& scene)
{
  const std::vector<glm::dvec3> corners = corners_of_volumes(scene, scene.volumes.size());
  Sphere sphere;
  sphere.centre = glm::dvec3(0.0);
  for (const glm::dvec3& corner : corners)
  {
    sphere.centre += corner / static_cast<double>(corners.size());
  }
  sphere.radius = 0.0;
  for (const glm::dvec3& corner : corners)
  {
    sphere.radius = std::max(sphere.radius, glm::length(corner - sphere.centre));
  }
  sphere.radius = std::max(sphere.radius, 1e-300);
  return sphere;
}

glm::dvec3 across(const glm::dvec3& direction)
{
  return std::abs(direction.x) < 0.7 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
}

/// Each pixel's depth with what a ray between it and its neighbours may have more.
std::vector<double> between(const std::vector<double>& depths, int edge, double hidden)
{
  std::vector<double> upper(depths.size());
  for (int y = 0; y < edge; ++y)
  {
    for (int x = 0; x < edge; ++x)
    {
      const double here = depths[y * edge + x];
      const auto change = [&](int dx, int dy)
      {
        double most = 0.0;
        for (const int sign : { -1, 1 })
        {
          const int u = x + sign * dx;
          const int v = y + sign * dy;
          const bool inside = u >= 0 && v >= 0 && u < edge && v < edge;
          most = std::max(most, std::abs((inside ? depths[v * edge + u] : 0.0) - here));
        }
        return most;
      };
      upper[y * edge + x] = here + between_rays * (change(1, 0) + change(0, 1)) + hidden;
    }
  }
  return upper;
}

}

void PlanKey::add(double value)
{
  this->Words.push_back(std::bit_cast<std::uint64_t>(value));
}
void PlanKey::add(const glm::dvec3& v)
{
  for (int i = 0; i < 3; ++i)
  {
    this->add(v[i]);
  }
}
void PlanKey::add(const glm::dmat4& m)
{
  for (int column = 0; column < 4; ++column)
  {
    for (int row = 0; row < 4; ++row)
    {
      this->add(m[column][row]);
    }
  }
}

glm::dmat4 parallel_view(const Scene& scene, const glm::dvec3& direction)
{
  const Sphere sphere = around_volumes(scene);
  const double r = sphere.radius;
  const glm::dvec3 along = glm::normalize(direction);
  const glm::dvec3 eye = sphere.centre - along * (2.0 * r);
  return glm::ortho(-r, r, -r, r, 0.9 * r, 3.1 * r) *
         glm::lookAt(eye, sphere.centre, across(along));
}

std::vector<glm::dmat4> views_from(const Scene& scene, const glm::dvec3& place)
{
  const Sphere sphere = around_volumes(scene);
  const glm::dvec3 way = sphere.centre - place;
  const double distance = glm::length(way);
  const double far = distance + 1.01 * sphere.radius;
  std::vector<glm::dmat4> views;
  if (distance > 1.2 * sphere.radius)
  {
    const double near = 0.5 * (distance - sphere.radius);
    const double tangent =
      sphere.radius / std::sqrt(distance * distance - sphere.radius * sphere.radius);
    const double side = near * tangent;
    views.push_back(glm::frustum(-side, side, -side, side, near, far) *
                    glm::lookAt(place, sphere.centre, across(way / distance)));
    return views;
  }
  const double near = 1e-6 * sphere.radius;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const double sign : { -1.0, 1.0 })
    {
      glm::dvec3 direction(0.0);
      direction[axis] = sign;
      views.push_back(glm::frustum(-near, near, -near, near, near, far) *
                      glm::lookAt(place, place + direction * sphere.radius, across(direction)));
    }
  }
  return views;
}

void PlanProbe::look_at_values(const Scene& scene, int threads)
{
  this->KeptValues.resize(scene.volumes.size());
  this->KeptTemperatures.resize(scene.volumes.size());
  this->Figures.matter.clear();
  for (std::size_t k = 0; k < scene.volumes.size(); ++k)
  {
    const Volume& volume = scene.volumes[k];
    const auto measure =
      [&](const Grid& grid, const std::shared_ptr<const BrickRanges>& ranges, Values& kept)
    {
      const void* voxels = grid.sparse ? static_cast<const void*>(grid.sparse) : grid.voxels;
      PlanKey key;
      key.add(volume.data_revision);
      key.add(static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(voxels)));
      if (volume.data_revision == 0 || !(key == kept.key))
      {
        kept.ranges =
          ranges ? ranges : std::make_shared<BrickRanges>(measure_bricks(grid, threads));
        kept.key = key;
      }
      return kept.ranges;
    };
    const auto values = measure(volume.grid, volume.ranges, this->KeptValues[k]);
    MatterFigures figures =
      figures_of(volume, values->lower, values->upper, values->non_finite_voxels > 0);
    if (volume.medium.lit && volume.medium.black_body > 0.0 && volume.medium.temperature.voxels)
    {
      const auto kelvin = measure(volume.medium.temperature, nullptr, this->KeptTemperatures[k]);
      figures.kelvin = std::max(0.0, double(kelvin->upper)) * volume.medium.temperature_scale;
    }
    this->Figures.matter.push_back(figures);
  }
}

double PlanProbe::clearance(const Scene& scene, const glm::dvec3& place) const
{
  double square = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < scene.volumes.size(); ++k)
  {
    const Volume& volume = scene.volumes[k];
    const glm::dmat4 world_from_index = volume.world_from_data * volume.data_from_index;
    glm::dvec3 edges;
    for (int axis = 0; axis < 3; ++axis)
    {
      const glm::dvec3 side(world_from_index[axis]);
      const glm::dvec3 next(world_from_index[(axis + 1) % 3]);
      edges[axis] = glm::length(side);
      if (volume.meaning != ValueMeaning::Density ||
          std::abs(glm::dot(side, next)) > 1e-9 * glm::length(side) * glm::length(next))
      {
        return 0.0; // not looked into: what is visible, or how far it is, is not as simple
      }
    }
    const glm::dvec3 here(glm::inverse(world_from_index) * glm::dvec4(place, 1.0));
    const BrickRanges& ranges = *this->KeptValues[k].ranges;
    const double edge = ranges.edge();
    std::size_t index = 0;
    for (int z = 0; z < ranges.dims[2]; ++z)
    {
      for (int y = 0; y < ranges.dims[1]; ++y)
      {
        for (int x = 0; x < ranges.dims[0]; ++x, ++index)
        {
          if (ranges.maximum[index] > 0.0f)
          {
            // The outermost bricks also hold what lies beyond the voxels' centres.
            const glm::dvec3 lower = glm::dvec3(x, y, z) * edge - 1.0;
            const glm::dvec3 way = glm::clamp(here, lower, lower + edge + 2.0) - here;
            square = std::min(square, glm::dot(way * edges, way * edges));
          }
        }
      }
    }
  }
  return std::sqrt(square);
}

std::vector<double> PlanProbe::depths(Marcher& marcher,
  const glm::dmat4& clip_from_world,
  int edge,
  double spacing,
  int threads)
{
  Film film(edge, edge);
  MarchSettings settings;
  settings.threads = threads;
  settings.leave_error = 0.0;
  settings.step = smallest_voxel_edge(this->Bare);
  if (follows_rule(this->Bare, StepRule::Cells))
  {
    // In voxels that are much longer than wide it takes fewer reads, two for each cell on the way.
    const Volume& volume = this->Bare.volumes[0];
    const int cells = volume.grid.dims[0] + volume.grid.dims[1] + volume.grid.dims[2];
    settings.rule =
      2.0 * cells * settings.step < diagonal(volume) ? StepRule::Cells : StepRule::Midpoint;
  }
  this->Bare.camera.clip_from_world = clip_from_world;
  const MarchStatistics statistics = marcher.render(this->Bare, settings, film);
  this->Figures.bricks = statistics.bricks;
  this->Figures.visible_bricks = statistics.visible_bricks;
  std::vector<double> depths(film.size());
  for (std::size_t i = 0; i < film.size(); ++i)
  {
    const double passes = std::max(double(film.transmittance[0][i]), 1e-38);
    depths[i] = -std::log(passes) / this->Scale;
  }
  // What might be overlooked is as wide as rays are apart, corner to corner.
  const bool any = statistics.visible_bricks > 0;
  return between(depths, edge, any ? this->Hidden * spacing : 0.0);
}

void PlanProbe::look_at_lights(Marcher& marcher, int threads)
{
  const Scene& scene = this->Bare;
  this->KeptDepths.resize(scene.lights.size() + 1);
  const int edge = scene.lights.size() > few_lights ? ViewFigures::edge / 2 : ViewFigures::edge;
  const Sphere sphere = around_volumes(scene);
  const std::vector<Light> lights = scene.lights;
  this->Figures.lights.clear();
  this->Figures.clearance.clear();
  for (std::size_t l = 0; l <= lights.size(); ++l)
  {
    const bool vertical = l == lights.size();
    const bool positional = !vertical && lights[l].positional;
    const glm::dvec3 axis = vertical ? scene.sky.up : lights[l].direction;
    PlanKey key = this->MatterKey;
    key.add(std::uint64_t{ positional });
    key.add(positional ? lights[l].position : axis);
    key.add(static_cast<std::uint64_t>(edge));
    Depth& kept = this->KeptDepths[l];
    const bool wanted =
      !vertical || scene.sky.radiance != glm::dvec3(0.0) || scene.sky.ground != glm::dvec3(0.0);
    if (!(key == kept.key) && wanted)
    {
      kept.deepest = 0.0;
      kept.clearance = positional ? this->clearance(scene, lights[l].position) : 0.0;
      const std::vector<glm::dmat4> views =
        positional ? views_from(scene, lights[l].position)
                   : std::vector<glm::dmat4>{ parallel_view(scene, axis) };
      // Rays are apart by the view's width over their number: parallel ones by the sphere's.
      double width = 2.0 * sphere.radius;
      if (positional)
      {
        width = 2.0 * (glm::length(lights[l].position - sphere.centre) + sphere.radius);
        width = views.size() == 1 ? std::min(width, 12.0 * sphere.radius) : width;
      }
      for (const glm::dmat4& view : views)
      {
        const std::vector<double> found =
          this->depths(marcher, view, edge, width / (2.0 * sphere.radius * edge), threads);
        kept.deepest = std::max(kept.deepest, *std::max_element(found.begin(), found.end()));
      }
      kept.key = key;
    }
    if (vertical)
    {
      this->Figures.vertical = kept.deepest;
    }
    else
    {
      this->Figures.lights.push_back(kept.deepest);
      this->Figures.clearance.push_back(kept.clearance);
    }
  }
}

void PlanProbe::look_at_view(Marcher& marcher, int threads)
{
  ViewFigures& view = this->Figures.view;
  constexpr int edge = ViewFigures::edge;
  const glm::dmat4 clip_from_world = zoomed_to_volumes(this->Bare, this->Bare.volumes.size());
  view.depth = this->depths(marcher, clip_from_world, edge, 1.0 / edge, threads);
  view.deepest = *std::max_element(view.depth.begin(), view.depth.end());
  const glm::dmat4 world_from_clip = glm::inverse(clip_from_world);
  view.origin.resize(view.depth.size());
  view.direction.resize(view.depth.size());
  view.reach.resize(view.depth.size());
  for (int y = 0; y < edge; ++y)
  {
    for (int x = 0; x < edge; ++x)
    {
      const auto place = [&](double z)
      {
        const glm::dvec4 p =
          world_from_clip *
          glm::dvec4((2.0 * x + 1.0) / edge - 1.0, (2.0 * y + 1.0) / edge - 1.0, z, 1.0);
        return glm::dvec3(p) / p.w;
      };
      const std::size_t i = static_cast<std::size_t>(y) * edge + x;
      view.origin[i] = place(-1.0);
      const glm::dvec3 way = place(1.0) - view.origin[i];
      view.reach[i] = glm::length(way);
      view.direction[i] = way / view.reach[i];
    }
  }
  view.angle = 0.0;
  view.width = 0.0;
  view.edge_of_voxel = smallest_voxel_edge(this->Bare);
  for (int y = 0; y + 1 < edge; ++y)
  {
    for (int x = 0; x + 1 < edge; ++x)
    {
      const std::size_t i = static_cast<std::size_t>(y) * edge + x;
      const double apart = std::max(glm::length(view.direction[i] - view.direction[i + edge + 1]),
        glm::length(view.direction[i + 1] - view.direction[i + edge]));
      view.angle = std::max(view.angle, std::asin(std::min(1.0, 0.5 * apart)));
      view.width =
        std::max(view.width, 0.5 * glm::length(view.origin[i] - view.origin[i + edge + 1]));
    }
  }
}

PlanKey PlanProbe::matter_key(const Scene& scene)
{
  PlanKey key;
  key.add(static_cast<std::uint64_t>(scene.mixture));
  key.add(static_cast<std::uint64_t>(scene.blend_mode));
  bool kept = true;
  for (const Volume& volume : scene.volumes)
  {
    key.add(volume.data_revision);
    key.add(volume.medium_revision);
    kept = kept && volume.data_revision != 0 && volume.medium_revision != 0;
    key.add(volume.data_from_index);
    key.add(volume.world_from_data);
    key.add(volume.density.extinction);
    key.add(volume.weight);
    key.add(static_cast<std::uint64_t>(volume.cropping.enabled ? volume.cropping.regions : 0));
    for (int axis = 0; axis < 3; ++axis)
    {
      key.add(volume.cropping.lower[axis]);
      key.add(volume.cropping.upper[axis]);
    }
    key.add(std::uint64_t{ volume.clipping_planes.size() });
    for (const glm::dvec4& plane : volume.clipping_planes)
    {
      key.add(glm::dvec3(plane));
      key.add(plane.w);
    }
  }
  if (!kept)
  {
    key.add(++this->Unkept);
  }
  return key;
}

const PlanFigures& PlanProbe::look(Marcher& marcher, const Scene& scene, int threads)
{
  scene.validate();
  if (scene.volumes.empty()) // fog alone, whose figures are closed forms
  {
    this->MatterKey = PlanKey();
    this->Figures = PlanFigures();
    this->Figures.lights.assign(scene.lights.size(), 0.0);
    this->Figures.clearance.assign(scene.lights.size(), 0.0);
    return this->Figures;
  }
  const PlanKey key = this->matter_key(scene);
  this->look_at_values(scene, threads);
  if (!(key == this->MatterKey))
  {
    this->MatterKey = key;
    this->ViewKey = PlanKey();
    this->Bare = scene;
    this->Bare.surface_depth.clear();
    this->Bare.fog = Fog();
    double depth = 0.0;
    this->Hidden = 0.0;
    for (std::size_t k = 0; k < scene.volumes.size(); ++k)
    {
      depth += this->Figures.matter[k].extinction * diagonal(scene.volumes[k]);
    }
    this->Scale = depth > 0.0 ? scaled_depth / depth : 1.0;
    this->Hidden = std::sqrt(2.0) * depth;
    for (Volume& volume : this->Bare.volumes)
    {
      volume.medium = Medium();
      volume.shading.enabled = false;
      volume.density.channels = glm::dvec3(1.0);
      if (volume.meaning == ValueMeaning::Density)
      {
        volume.density.extinction *= this->Scale;
      }
      else
      {
        volume.weight *= this->Scale;
      }
    }
  }
  this->Bare.camera = scene.camera;
  this->Bare.sky = scene.sky;
  PlanKey view_key;
  view_key.add(scene.camera.clip_from_world);
  if (!(view_key == this->ViewKey))
  {
    this->look_at_view(marcher, threads);
    this->ViewKey = view_key;
  }
  const bool lit = std::any_of(scene.volumes.begin(),
    scene.volumes.end(),
    [](const Volume& volume) { return volume.medium.lit; });
  this->Bare.lights = scene.lights;
  if (lit)
  {
    this->look_at_lights(marcher, threads);
  }
  else
  {
    this->Figures.lights.assign(scene.lights.size(), 0.0);
    this->Figures.clearance.assign(scene.lights.size(), 0.0);
    this->Figures.vertical = 0.0;
  }
  return this->Figures;
}

}
