#include "Transport/path_scene.h"

#include "Transport/path_state.h"
#include "Transport/sparse_voxels.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

namespace brume
{

namespace
{

using path_state::largest;
using path_state::most_candidates;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// e^(−depth · channels); mostly the channels are alike.
glm::dvec3 passing(double depth, const glm::dvec3& channels)
{
  return channels.x == channels.y && channels.y == channels.z
           ? glm::dvec3(std::exp(-depth * channels.x))
           : glm::exp(-depth * channels);
}

/// Within the bounds of where the walk is.
double density_at(
  const PathMatter& matter, const BrickWalk& walk, const glm::dvec3& place, RandomStream& random)
{
  return walk.is_stretch() ? matter.interpolated_density(place) : matter.density(place, random);
}

/// Whether a shadow ray that lets through little goes on, for more if it does; the next such place is at a
/// part of that.
bool survives(double most, glm::dvec3& passes, double& roulette, RandomStream& random)
{
  constexpr double survival = 0.25;
  if (!(most > 0.0) || random.uniform() >= survival)
  {
    return false;
  }
  passes /= survival;
  roulette *= survival;
  return true;
}

/// Whether places and rates in single precision are as good as in double: grids so wide that a voxel's
/// fraction has eight bits left, lengths that are near the ends of its range, and collisions so
/// close that places cannot be told apart are not.
bool suits_single_precision(const PathMatter& matter)
{
  constexpr int widest = 1 << 15;
  constexpr double extreme = 1e15;
  const Grid& grid = matter.volume().grid;
  glm::dvec3 box;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (grid.dims[axis] > widest)
    {
      return false;
    }
    box[axis] = grid.upper(axis) - grid.lower(axis);
  }
  const glm::dmat3 index_from_world(matter.index_from_world());
  for (const glm::dmat3& m : { index_from_world, matter.data_from_index() * index_from_world })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const double norm = glm::length(m[axis]);
      if (!(norm > 1.0 / extreme && norm < extreme))
      {
        return false;
      }
    }
  }
  const std::vector<double>& rates = matter.bricks().rate;
  const double rate = rates.empty() ? 0.0 : *std::max_element(rates.begin(), rates.end());
  return rate * glm::length(matter.data_from_index() * box) * 0x1p-24 < 0.1;
}

}

/// Tentative collisions of one matter along a ray: a Poisson process whose rate is constant in each
/// brick (E. R. Woodcock et al. 1965; bricks: L. Szirmay-Kalos et al. 2011).
class PathScene::Tracker
{
public:
  Tracker(const PathMatter& matter, const MatterRay& ray, double to)
    : TheMatter(&matter)
    , TheRay(ray)
    , Walk(matter.bricks(), ray.begin, ray.along, ray.from, std::min(ray.to, to), ray.scale)
  {
  }

  /// Moves on to the next one; +infinity beyond the last.
  void next(RandomStream& random)
  {
    double depth = -std::log(random.uniform());
    for (;;)
    {
      const double rest = (this->To - this->At) * this->Rate;
      if (depth < rest)
      {
        this->At += depth / this->Rate;
        return;
      }
      depth -= rest;
      if (!this->Walk.next())
      {
        this->At = infinity;
        return;
      }
      this->At = this->Walk.from();
      this->To = this->Walk.to();
      this->Rate = this->rate() * this->TheRay.scale;
    }
  }

  double at() const { return this->At; }
  const PathMatter& matter() const { return *this->TheMatter; }
  glm::dvec3 place() const { return this->TheRay.begin + this->At * this->TheRay.along; }
  /// Per unit of the data's length, where the last collision is.
  double rate() const { return this->Walk.rate(); }
  double density(RandomStream& random) const
  {
    return density_at(*this->TheMatter, this->Walk, this->place(), random);
  }

private:
  const PathMatter* TheMatter;
  MatterRay TheRay;
  BrickWalk Walk;
  double At = 0.0;
  double To = 0.0;
  double Rate = 0.0;
};

PathScene::PathScene(const Scene& scene,
  int most_scatterings,
  std::shared_ptr<const PlacedEnvironment> environment)
  : TheScene(scene)
  , Around(scene.sky, std::move(environment))
  , MostScatterings(most_scatterings)
{
  scene.validate();
  if (scene.blend_mode != BlendMode::Composite)
  {
    throw std::invalid_argument("paths are traced in composite mode alone");
  }
  this->Media.reserve(scene.volumes.size());
  for (const Volume& volume : scene.volumes)
  {
    this->Media.emplace_back(scene, volume);
  }
  if (!scene.volumes.empty())
  {
    this->Matter = find_path_matter(scene, this->Media);
  }
  for (const auto& matter : this->Matter)
  {
    const glm::dvec3& k = matter->channels();
    this->Coloured |= k.x != k.y || k.y != k.z;
  }
  if (has_fog(scene))
  {
    this->Fog = std::make_unique<PathFog>(scene, most_scatterings);
    this->Coloured |= this->Fog->is_coloured();
  }
  this->Glows = this->Around.shines() ||
                std::any_of(this->Matter.begin(), this->Matter.end(),
                  [](const auto& matter) { return matter->emits(); });
  double sum = 0.0;
  for (const Light& light : scene.lights)
  {
    const double strength = light.diffuse.x + light.diffuse.y + light.diffuse.z;
    if (strength > 0.0)
    {
      this->Lamps.emplace_back(light);
      this->LampUpTo.push_back(sum += strength);
    }
  }
  for (double& up_to : this->LampUpTo)
  {
    up_to /= sum;
  }
  for (const Lamp& lamp : this->Lamps)
  {
    this->NearRadius.push_back(this->near_radius(lamp));
    if (this->NearRadius.back() > 0.0)
    {
      this->NearLamps.push_back({ &lamp, this->NearRadius.back() });
    }
  }
  this->AroundIsSought = this->Around.has_map();
  this->find_packets();
}

void PathScene::find_packets()
{
  // More suns are drawn by their power first, which packets do not.
  const bool even = this->Matter.size() == 1 && !this->Coloured && !this->Fog &&
                    !this->Around.has_map() &&
                    this->Lamps.size() <= most_candidates &&
                    std::none_of(this->Lamps.begin(),
                      this->Lamps.end(),
                      [](const Lamp& lamp) { return lamp.is_positional(); });
  if (!even)
  {
    return;
  }
  const PathMatter& matter = *this->Matter.front();
  const Volume& volume = matter.volume();
  if (!matter.has_voxels() || matter.is_cut() || matter.emits() || !matter.scatters() ||
      !suits_single_precision(matter) || matter.bricks().has_cells())
  {
    return;
  }
  auto packets = std::make_unique<PathPacketScene>();
  packets->matter = &matter;
  const PathBricks& bricks = matter.bricks();
  const double channel = matter.channels().x;
  packets->bricks.reserve(2 * bricks.rate.size());
  for (std::size_t i = 0; i < bricks.rate.size(); ++i)
  {
    // Bounds stay bounds in single precision.
    const float rate = std::nextafter(static_cast<float>(bricks.rate[i]), HUGE_VALF);
    const float least = std::nextafter(static_cast<float>(channel * bricks.least[i]), 0.0f);
    packets->bricks.push_back(
      bricks.rate[i] > 0.0 ? rate : -static_cast<float>(std::max(bricks.distance[i], 1)));
    packets->bricks.push_back(least);
  }
  packets->shift = bricks.shift;
  const Grid& grid = volume.grid;
  for (int axis = 0; axis < 3; ++axis)
  {
    packets->brick_dims[axis] = bricks.dims[axis];
    packets->lower[axis] = static_cast<float>(grid.lower(axis));
    packets->upper[axis] = static_cast<float>(grid.upper(axis));
    packets->first[axis] = grid.first[axis];
    packets->last[axis] = grid.dims[axis] - 1;
    packets->albedo[axis] = static_cast<float>(volume.medium.albedo[axis]);
    packets->sky[axis] = static_cast<float>(this->TheScene.sky.radiance[axis]);
    packets->ground[axis] = static_cast<float>(this->TheScene.sky.ground[axis]);
    packets->up[axis] = static_cast<float>(this->TheScene.sky.up[axis]);
    for (int column = 0; column < 3; ++column)
    {
      packets->index_from_world[3 * axis + column] =
        static_cast<float>(matter.index_from_world()[column][axis]);
      packets->data_from_index[3 * axis + column] =
        static_cast<float>(matter.data_from_index()[column][axis]);
    }
  }
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
  if (2 * bricks.rate.size() > most)
  {
    return;
  }
  if (grid.voxels && grid.type == VoxelType::Float32 &&
      grid.voxel_count() * grid.components <= most)
  {
    packets->voxels = static_cast<const float*>(grid.voxels) + grid.component;
  }
  else if (grid.sparse && grid.type == VoxelType::Float32 &&
           grid.sparse->table().directory.empty() &&
           grid.sparse->slot_count() * SparseVoxels::brick_voxels <= most)
  {
    packets->voxels = static_cast<const float*>(grid.sparse->pool());
    packets->table = &grid.sparse->table();
  }
  packets->components = grid.components;
  packets->scale = static_cast<float>(volume.density.extinction * volume.weight * channel);
  for (const Lamp& lamp : this->Lamps)
  {
    const glm::dvec3 offset = lamp.offset(glm::dvec3(0.0));
    const glm::dvec3 toward = -lamp.travel(offset);
    const glm::dvec3 light = lamp.irradiance(offset);
    packets->suns.push_back({ { float(toward.x), float(toward.y), float(toward.z) },
      { float(light.x), float(light.y), float(light.z) } });
  }
  packets->glows = this->Glows;
  this->Packets = std::move(packets);
}

bool PathScene::find_start(const Sight& sight, PathStart& start) const
{
  const MatterRay ray = this->Matter.front()->ray(sight.begin, sight.along);
  const double to = std::min(ray.to, sight.length);
  if (!(ray.from < to))
  {
    return false;
  }
  const glm::dvec3 place = ray.begin + ray.from * ray.along;
  for (int axis = 0; axis < 3; ++axis)
  {
    start.begin[axis] = static_cast<float>(place[axis]);
    start.direction[axis] = static_cast<float>(sight.along[axis]);
  }
  start.length = static_cast<float>(to - ray.from);
  return true;
}

bool PathScene::can_send() const
{
  const bool lit = !this->Lamps.empty() || this->Glows;
  return (this->Fog && this->Fog->scatters() && lit) ||
         std::any_of(this->Matter.begin(), this->Matter.end(),
    [lit](const auto& matter) { return matter->emits() || (lit && matter->scatters()); });
}

std::size_t PathScene::non_finite_voxels() const
{
  std::size_t count = 0;
  for (std::size_t v = 0; v < this->Media.size(); ++v)
  {
    // Components share a grid.
    count += v > 0 && this->TheScene.mixture == Mixture::Components
               ? 0
               : this->Media[v].ranges().non_finite_voxels;
  }
  return count;
}

bool PathScene::has_kinks() const
{
  return std::any_of(this->Media.begin(),
    this->Media.end(),
    [](const ReferenceMedium& medium)
    { return medium.is_density() && medium.ranges().lower < 0.0f; });
}

/// The first real collision, if there is one. Of several matters the tentative collisions are taken
/// in the order in which the ray meets them.
bool PathScene::collide(const glm::dvec3& begin,
  const glm::dvec3& along,
  double length,
  Path& path,
  Collision& found) const
{
  // One tracker each; nearly always there is one.
  constexpr std::size_t few = 4;
  std::vector<Tracker> many;
  alignas(Tracker) unsigned char memory[few * sizeof(Tracker)];
  Tracker* trackers = reinterpret_cast<Tracker*>(memory);
  std::size_t count = 0;
  if (this->Matter.size() > few)
  {
    many.reserve(this->Matter.size());
  }
  for (const auto& matter : this->Matter)
  {
    const MatterRay ray = matter->ray(begin, along);
    if (!(ray.from < std::min(ray.to, length)))
    {
      continue;
    }
    Tracker* tracker = nullptr;
    if (this->Matter.size() > few)
    {
      many.emplace_back(*matter, ray, length);
      trackers = many.data();
      tracker = &many.back();
    }
    else
    {
      tracker = new (trackers + count) Tracker(*matter, ray, length);
    }
    ++count;
    tracker->next(path.random);
  }
  while (count > 0)
  {
    Tracker& first = *std::min_element(trackers,
      trackers + count,
      [](const Tracker& a, const Tracker& b) { return a.at() < b.at(); });
    if (first.at() == infinity)
    {
      return false;
    }
    path.counts.collide();
    const PathMatter& matter = first.matter();
    const glm::dvec3 place = first.place();
    const double rate = first.rate();
    if (matter.emits())
    {
      found.emitted += path.weight(first.at()) * matter.emission(place) / rate;
    }
    const double density = first.density(path.random);
    const glm::dvec3 real = glm::min(density / rate * matter.channels(), 1.0); // but for rounding
    if (path.random.uniform() < real[path.hero])
    {
      if (this->Coloured)
      {
        path.chances *= real / real[path.hero];
      }
      found.at = first.at();
      found.matter = &matter;
      found.place = place;
      return true;
    }
    if (this->Coloured)
    {
      path.chances *= (1.0 - real) / (1.0 - real[path.hero]);
    }
    first.next(path.random);
  }
  return false;
}

/// Residual ratio tracking: what is in a brick everywhere dims in closed form, and collisions with
/// the rest count by what they let through (J. Novák, A. Selle, W. Jarosz, Residual ratio tracking
/// for estimating attenuation in participating media, SIGGRAPH Asia 2014).
glm::dvec3 PathScene::transmittance(const glm::dvec3& begin,
  const glm::dvec3& along,
  double length,
  Path& path) const
{
  glm::dvec3 passes(1.0); // what collisions let through
  double roulette = 0.1;
  for (const auto& matter : this->Matter)
  {
    const MatterRay ray = matter->ray(begin, along);
    if (!(ray.from < std::min(ray.to, length)))
    {
      continue;
    }
    const glm::dvec3& channels = matter->channels();
    const double channel = largest(channels);
    BrickWalk walk(
      matter->bricks(), ray.begin, ray.along, ray.from, std::min(ray.to, length), ray.scale);
    double depth = 0.0; // of what is everywhere, by a channel of 1
    double left = -std::log(path.random.uniform());
    while (walk.next())
    {
      const double rate = walk.rate();
      const double least = walk.least();
      depth += least * ray.scale * (walk.to() - walk.from());
      const double extra = (rate - channel * least) * ray.scale;
      double at = walk.from();
      while (left < (walk.to() - at) * extra)
      {
        at += left / extra;
        left = -std::log(path.random.uniform());
        path.counts.collide();
        const double density =
          density_at(*matter, walk, ray.begin + at * ray.along, path.random);
        const double more = std::max(density - least, 0.0) / (rate - channel * least);
        passes *= glm::max(1.0 - more * channels, 0.0);
        if (largest(passes) < roulette && !survives(largest(passes), passes, roulette, path.random))
        {
          return glm::dvec3(0.0);
        }
      }
      left -= (walk.to() - at) * extra;
      // The most that may be left; of what is everywhere, by the clearest channel.
      const double clearest = std::min({ channels.x, channels.y, channels.z });
      const double most = largest(passes) * std::exp(-depth * clearest);
      if (most < roulette && !survives(most, passes, roulette, path.random))
      {
        return glm::dvec3(0.0);
      }
    }
    passes *= passing(depth, channels);
  }
  return passes;
}

}
