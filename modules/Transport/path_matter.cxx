#include "Transport/path_matter.h"

#include "Transport/black_body.h"
#include "Transport/sparse_voxels.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace brume
{

namespace
{

/// Tentative collisions on the way through a box, at the least, where matter glows: glow is only
/// seen at collisions.
constexpr double collisions_of_glow = 16.0;

/// Voxels of a dense grid.
template <class T>
class DenseReader
{
public:
  explicit DenseReader(const Grid& grid)
    : Voxels(static_cast<const T*>(grid.voxels) + grid.component)
    , Components(grid.components)
    , X(grid.dims[0])
    , Y(grid.dims[1])
  {
  }
  double operator()(int x, int y, int z) const
  {
    return static_cast<double>(
      this->Voxels[((static_cast<std::size_t>(z) * this->Y + y) * this->X + x) * this->Components]);
  }

private:
  const T* Voxels;
  std::size_t Components;
  std::size_t X;
  std::size_t Y;
};

/// Voxels of a sparse grid.
class SparseReader
{
public:
  explicit SparseReader(const Grid& grid)
    : Voxels(grid.sparse)
  {
  }
  double operator()(int x, int y, int z) const { return this->Voxels->value(x, y, z); }

private:
  const SparseVoxels* Voxels;
};

/// A density of voxels: one of the eight around a place stands for them.
template <class Reader>
class VoxelMatter final : public PathMatter
{
public:
  VoxelMatter(const Scene& scene, const std::vector<ReferenceMedium>& media, int number)
    : PathMatter(scene, media, { number })
    , Read(scene.volumes[number].grid)
    , Scale(scene.volumes[number].density.extinction * scene.volumes[number].weight)
  {
    const Grid& grid = scene.volumes[number].grid;
    for (int axis = 0; axis < 3; ++axis)
    {
      this->First[axis] = grid.first[axis];
      this->Last[axis] = grid.dims[axis] - 1;
    }
  }

  double density(const glm::dvec3& place, RandomStream& random) const override
  {
    if (this->is_cut() && !this->is_drawn(place))
    {
      return 0.0;
    }
    double u = random.uniform();
    int voxel[3];
    for (int axis = 2; axis >= 0; --axis)
    {
      const double at = std::clamp<double>(place[axis], this->First[axis], this->Last[axis]);
      voxel[axis] = static_cast<int>(at);
      const double fraction = at - voxel[axis];
      if (u < fraction)
      {
        ++voxel[axis];
        u /= fraction;
      }
      else
      {
        u = (u - fraction) / (1.0 - fraction);
      }
    }
    const double value = this->Read(voxel[0], voxel[1], voxel[2]);
    return std::isfinite(value) ? this->Scale * value : 0.0;
  }

  bool has_voxels() const override { return true; }
  void read_voxels(const std::int32_t* x,
    const std::int32_t* y,
    const std::int32_t* z,
    const std::uint8_t* bits,
    int count,
    float* values) const override
  {
    for (int i = 0; i < count; ++i)
    {
      if (bits[i / 8] >> (i % 8) & 1)
      {
        values[i] = static_cast<float>(this->Read(x[i], y[i], z[i]));
      }
    }
  }

private:
  Reader Read;
  double Scale;
  int First[3];
  int Last[3];
};

/// Whether a volume can be a VoxelMatter: a trilinear density that is nowhere negative, where
/// interpolating and taking what is below 0 for 0 are one.
bool has_plain_voxels(const Volume& volume, const ReferenceMedium& medium)
{
  return volume.meaning == ValueMeaning::Density && volume.grid.linear && !volume.mask.labels &&
         medium.ranges().lower >= 0.0f;
}

std::unique_ptr<PathMatter> make_matter(const Scene& scene,
  const std::vector<ReferenceMedium>& media,
  int number)
{
  const Volume& volume = scene.volumes[number];
  if (has_plain_voxels(volume, media[number]))
  {
    if (volume.grid.sparse)
    {
      return std::make_unique<VoxelMatter<SparseReader>>(scene, media, number);
    }
    switch (volume.grid.type)
    {
      case VoxelType::UInt8:
        return std::make_unique<VoxelMatter<DenseReader<std::uint8_t>>>(scene, media, number);
      case VoxelType::Int8:
        return std::make_unique<VoxelMatter<DenseReader<std::int8_t>>>(scene, media, number);
      case VoxelType::UInt16:
        return std::make_unique<VoxelMatter<DenseReader<std::uint16_t>>>(scene, media, number);
      case VoxelType::Int16:
        return std::make_unique<VoxelMatter<DenseReader<std::int16_t>>>(scene, media, number);
      case VoxelType::Float32:
        return std::make_unique<VoxelMatter<DenseReader<float>>>(scene, media, number);
      case VoxelType::Float16: // dense grids have none
        break;
    }
  }
  return std::make_unique<PathMatter>(scene, media, std::vector<int>{ number });
}

}

namespace
{

/// Bounds of a cubic polynomial on a stretch from its values at both ends and at a third and two thirds
/// of it: those of its Bernstein coefficients.
void bound_cubic(double a, double b, double c, double d, double& lower, double& upper)
{
  const double second = (-5.0 * a + 18.0 * b - 9.0 * c + 2.0 * d) / 6.0;
  const double third = (2.0 * a - 9.0 * b + 18.0 * c - 5.0 * d) / 6.0;
  lower = std::min({ a, second, third, d });
  upper = std::max({ a, second, third, d });
  const double rounding = 1e-9 * std::max(std::abs(lower), std::abs(upper));
  lower -= rounding;
  upper += rounding;
}

/// The bounds of a cell between the voxels lower and upper.
using CellBounds =
  std::function<void(const int lower[3], const int upper[3], double& rate, double& least)>;

/// Gives bounds of their own to the cells of bricks that a ray has many collisions in, if most of them
/// would be with nothing.
void split_bricks(
  PathBricks& bricks, const Grid& grid, const glm::dmat3& data_from_index, const CellBounds& bounds)
{
  constexpr double many = 64.0; // tentative collisions on the way through a brick
  constexpr double rarely = 0.125;
  constexpr std::size_t most = 1 << 14;
  constexpr int widest = 4;
  if (bricks.shift > widest)
  {
    return;
  }
  const int edge = 1 << bricks.shift;
  const double across = edge * std::max({ glm::length(data_from_index[0]),
                                 glm::length(data_from_index[1]), glm::length(data_from_index[2]) });
  std::vector<std::size_t> dense;
  for (std::size_t i = 0; i < bricks.rate.size(); ++i)
  {
    if (bricks.rate[i] * across > many)
    {
      dense.push_back(i);
    }
  }
  std::stable_sort(dense.begin(), dense.end(),
    [&](std::size_t a, std::size_t b) { return bricks.rate[a] > bricks.rate[b]; });
  dense.resize(std::min(dense.size(), most));
  const std::size_t cells = static_cast<std::size_t>(edge) * edge * edge;
  std::vector<double> rate(cells);
  std::vector<double> least(cells);
  for (const std::size_t brick : dense)
  {
    const std::size_t row = brick / bricks.dims[0];
    const int corner[3] = { static_cast<int>(brick % bricks.dims[0]) * edge,
      static_cast<int>(row % bricks.dims[1]) * edge,
      static_cast<int>(row / bricks.dims[1]) * edge };
    double sum = 0.0;
    for (std::size_t cell = 0; cell < cells; ++cell)
    {
      int lower[3], upper[3];
      for (int axis = 0; axis < 3; ++axis)
      {
        const int at = corner[axis] + static_cast<int>(cell >> (axis * bricks.shift) & (edge - 1));
        const int last = grid.dims[axis] - 1;
        lower[axis] = std::clamp(at, grid.first[axis], last);
        upper[axis] = std::clamp(at + 1, grid.first[axis], last);
      }
      bounds(lower, upper, rate[cell], least[cell]);
      sum += rate[cell];
    }
    if (sum < rarely * bricks.rate[brick] * static_cast<double>(cells))
    {
      bricks.first_cell.resize(bricks.rate.size(), -1);
      bricks.first_cell[brick] = static_cast<std::int32_t>(bricks.cell_rate.size());
      bricks.cell_rate.insert(bricks.cell_rate.end(), rate.begin(), rate.end());
      bricks.cell_least.insert(bricks.cell_least.end(), least.begin(), least.end());
    }
  }
}

}

PathMatter::PathMatter(const Scene& scene,
  const std::vector<ReferenceMedium>& media,
  const std::vector<int>& numbers)
  : TheScene(scene)
{
  for (int number : numbers)
  {
    const Volume& volume = scene.volumes[number];
    const Medium& medium = volume.medium;
    this->Media.push_back(&media[number]);
    this->Temperatures.emplace_back();
    if (medium.lit && medium.black_body > 0.0 && medium.temperature.voxels)
    {
      black_body_radiance(0.0, medium.black_body_reference); // throws for one that is not usable
      this->Temperatures.back() = ReferenceGrid::make(medium.temperature, 0.0);
    }
    const bool glows =
      this->Temperatures.back() || glm::any(glm::greaterThan(medium.emission, glm::dvec3(0.0)));
    const bool scatters = glm::any(glm::greaterThan(medium.albedo, glm::dvec3(0.0)));
    this->Emits |= medium.lit ? glows : volume.meaning == ValueMeaning::Classified;
    this->Scatters |= medium.lit && scatters;
  }
  const Volume& first = this->volume();
  this->Phase = PhaseSampler(first.medium.lobes);
  if (first.meaning == ValueMeaning::Density)
  {
    this->Channels = first.density.channels;
  }
  const glm::dmat4 world_from_index = first.world_from_data * first.data_from_index;
  this->IndexFromWorld = glm::inverse(world_from_index);
  this->DataFromIndex = glm::dmat3(first.data_from_index);
  for (const glm::dvec4& plane : first.clipping_planes)
  {
    this->Planes.push_back(glm::transpose(world_from_index) * plane);
  }
  this->Cut = first.cropping.enabled || !this->Planes.empty();
  this->find_bricks();
}

void PathMatter::find_bricks()
{
  const BrickRanges& ranges = this->medium().ranges();
  const Grid& grid = this->volume().grid;
  PathBricks& bricks = this->Bricks;
  bricks.shift = ranges.shift;
  std::copy(ranges.dims, ranges.dims + 3, bricks.dims);
  bricks.rate.assign(ranges.size(), 0.0);
  bricks.least.assign(ranges.size(), 0.0);
  glm::dvec3 box;
  for (int axis = 0; axis < 3; ++axis)
  {
    box[axis] = grid.upper(axis) - grid.lower(axis);
  }
  const double across = glm::length(this->DataFromIndex * box);
  const double glow = this->Emits && this->volume().medium.lit ? collisions_of_glow / across : 0.0;
  const double channel = std::max({ this->Channels.x, this->Channels.y, this->Channels.z });
  const auto rate_of = [channel, glow](const ReferenceMedium& medium, double lower, double upper)
  {
    const double rate =
      medium.volume().weight * channel * medium.largest_extinction(lower, upper);
    return (medium.is_density() ? upper > 0.0 : rate > 0.0) ? std::max(rate, glow) : rate;
  };
  const auto least_of = [this](const ReferenceMedium& medium, double lower)
  {
    return medium.is_density() && !this->Cut && !medium.volume().mask.labels
             ? medium.volume().weight * medium.volume().density.extinction * std::max(lower, 0.0)
             : 0.0;
  };
  for (const ReferenceMedium* medium : this->Media)
  {
    const BrickRanges& own = medium->ranges();
    for (std::size_t i = 0; i < own.size(); ++i)
    {
      double lower = own.minimum[i];
      double upper = own.maximum[i];
      if (!own.reaches_non_finite.empty() && own.reaches_non_finite[i])
      {
        lower = std::min(lower, medium->empty_value());
        upper = std::max(upper, medium->empty_value());
      }
      if (!(lower <= upper))
      {
        continue;
      }
      bricks.rate[i] += rate_of(*medium, lower, upper);
      bricks.least[i] += least_of(*medium, lower);
    }
  }
  if (this->Media.size() == 1)
  {
    const ReferenceMedium& medium = this->medium();
    split_bricks(bricks, grid, this->DataFromIndex,
      [&](const int lower[3], const int upper[3], double& rate, double& least)
      {
        double least_value = std::numeric_limits<double>::infinity();
        double largest_value = -least_value;
        for (int corner = 0; corner < 8; ++corner)
        {
          glm::dvec3 place;
          for (int axis = 0; axis < 3; ++axis)
          {
            place[axis] = corner >> axis & 1 ? upper[axis] : lower[axis];
          }
          const double value = medium.value(place);
          least_value = std::min(least_value, value);
          largest_value = std::max(largest_value, value);
        }
        rate = rate_of(medium, least_value, largest_value);
        least = least_of(medium, least_value);
      });
    if (grid.linear && !medium.volume().mask.labels)
    {
      bricks.along = [=, &medium](
                       const glm::dvec3& from, const glm::dvec3& to, double& rate, double& least)
      {
        double lower, upper;
        bound_cubic(medium.value(from), medium.value(glm::mix(from, to, 1.0 / 3.0)),
          medium.value(glm::mix(from, to, 2.0 / 3.0)), medium.value(to), lower, upper);
        rate = rate_of(medium, lower, upper);
        least = least_of(medium, lower);
      };
    }
  }
  // Distances are a matter of what can be seen; the rates say what.
  BrickRanges seen = ranges;
  std::transform(bricks.rate.begin(),
    bricks.rate.end(),
    seen.maximum.begin(),
    [](double rate) { return rate > 0.0 ? 1.0f : 0.0f; });
  std::fill(seen.minimum.begin(), seen.minimum.end(), 0.0f);
  seen.reaches_non_finite.clear();
  bricks.distance = find_visible_bricks(
    seen, [](float, float upper) { return upper > 0.0f; }, 0.0f)
                      .distance;
}

MatterRay PathMatter::ray(const glm::dvec3& world_begin, const glm::dvec3& world_direction) const
{
  MatterRay ray;
  ray.begin = glm::dvec3(this->IndexFromWorld * glm::dvec4(world_begin, 1.0));
  ray.along = glm::dmat3(this->IndexFromWorld) * world_direction;
  ray.scale = glm::length(this->DataFromIndex * ray.along);
  ray.to = std::numeric_limits<double>::infinity();
  const Grid& grid = this->volume().grid;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double lower = grid.lower(axis) - ray.begin[axis];
    const double upper = grid.upper(axis) - ray.begin[axis];
    if (ray.along[axis] == 0.0)
    {
      ray.to = lower <= 0.0 && upper >= 0.0 ? ray.to : -1.0;
      continue;
    }
    const double a = lower / ray.along[axis];
    const double b = upper / ray.along[axis];
    ray.from = std::max(ray.from, std::min(a, b));
    ray.to = std::min(ray.to, std::max(a, b));
  }
  return ray;
}

bool PathMatter::is_drawn(const glm::dvec3& place) const
{
  for (const glm::dvec4& plane : this->Planes)
  {
    if (glm::dot(plane, glm::dvec4(place, 1.0)) < 0.0)
    {
      return false;
    }
  }
  const Cropping& cropping = this->volume().cropping;
  return !cropping.enabled || cropping.draws(place);
}

double PathMatter::density(const glm::dvec3& place, RandomStream&) const
{
  return this->interpolated_density(place);
}

double PathMatter::interpolated_density(const glm::dvec3& place) const
{
  if (this->Cut && !this->is_drawn(place))
  {
    return 0.0;
  }
  double sum = 0.0;
  double squares = 0.0;
  for (const ReferenceMedium* medium : this->Media)
  {
    const double extinction = medium->volume().weight * medium->extinction(place);
    sum += extinction;
    squares += extinction * extinction;
  }
  return this->Media.size() > 1 && sum > 0.0 ? squares / sum : sum;
}

void PathMatter::read_voxels(const std::int32_t*,
  const std::int32_t*,
  const std::int32_t*,
  const std::uint8_t*,
  int,
  float*) const
{
  throw std::logic_error("this matter is not read voxel by voxel");
}

glm::dvec3 PathMatter::albedo(const glm::dvec3& place) const
{
  const Medium& first = this->volume().medium;
  if (!this->Scatters)
  {
    return glm::dvec3(0.0);
  }
  if (this->medium().is_density())
  {
    return first.albedo;
  }
  glm::dvec3 scattered(0.0);
  double sum = 0.0;
  double squares = 0.0;
  for (const ReferenceMedium* medium : this->Media)
  {
    const FoundMatter found = medium->matter(place);
    const double extinction = medium->volume().weight * found.extinction;
    scattered += extinction * medium->volume().medium.albedo * found.colour;
    sum += extinction;
    squares += extinction * extinction;
  }
  const double extinction = this->Media.size() > 1 && sum > 0.0 ? squares / sum : sum;
  return extinction > 0.0 ? scattered / extinction : glm::dvec3(0.0);
}

glm::dvec3 PathMatter::emission(const glm::dvec3& place) const
{
  glm::dvec3 sum(0.0);
  if (this->Cut && !this->is_drawn(place))
  {
    return sum;
  }
  for (std::size_t i = 0; i < this->Media.size(); ++i)
  {
    const ReferenceMedium& own = *this->Media[i];
    const Medium& medium = own.volume().medium;
    const FoundMatter found = own.matter(place);
    if (!medium.lit)
    {
      sum += own.volume().weight * found.extinction *
             (own.is_density() ? glm::dvec3(0.0) : found.colour);
      continue;
    }
    glm::dvec3 radiance = medium.emission;
    if (this->Temperatures[i])
    {
      radiance += medium.black_body *
                  black_body_radiance(medium.temperature_scale * this->Temperatures[i]->value(place,
                                                                   medium.temperature.component),
                    medium.black_body_reference);
    }
    sum += own.volume().weight * (own.is_density() ? radiance * std::max(found.value, 0.0)
                                                   : radiance * found.colour * found.extinction);
  }
  return sum;
}

namespace
{

/// Whether the volumes are components of one grid that send colours as VTK's mappers mix them. Lit
/// ones would send more than they take, again at each scattering: their extinctions add up instead.
bool mixes_as_components(const Scene& scene)
{
  const Volume& first = scene.volumes.front();
  return scene.mixture == Mixture::Components && scene.volumes.size() > 1 &&
         std::all_of(scene.volumes.begin(),
           scene.volumes.end(),
           [&first](const Volume& v)
           {
             return v.grid.voxels == first.grid.voxels && v.grid.sparse == first.grid.sparse &&
                    std::equal(v.grid.dims, v.grid.dims + 3, first.grid.dims) && !v.medium.lit &&
                    v.meaning == ValueMeaning::Classified;
           });
}

}

std::vector<std::unique_ptr<PathMatter>> find_path_matter(const Scene& scene,
  const std::vector<ReferenceMedium>& media)
{
  std::vector<std::unique_ptr<PathMatter>> result;
  if (mixes_as_components(scene))
  {
    std::vector<int> all(scene.volumes.size());
    std::iota(all.begin(), all.end(), 0);
    result.push_back(std::make_unique<PathMatter>(scene, media, all));
    return result;
  }
  for (std::size_t v = 0; v < scene.volumes.size(); ++v)
  {
    result.push_back(make_matter(scene, media, static_cast<int>(v)));
  }
  return result;
}

}
