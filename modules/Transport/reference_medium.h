// Optical properties of a scene at a place, in double precision. Internal to Transport.
#pragma once

#include "Transport/bricks.h"
#include "Transport/lookup_table.h"
#include "Transport/optics.h"
#include "Transport/shading.h"
#include "Transport/sparse_voxels.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace brume
{

/// Extinction and source at a place.
struct Optical
{
  double extinction = 0.0; ///< per unit of the data's length
  glm::dvec3 source{ 0.0 };
};

/// T is the type of a dense grid's voxels, or SparseVoxels.
template <class T>
class ReferenceMedium
{
public:
  ReferenceMedium(const Scene& scene, const Volume& volume)
    : TheVolume(volume)
    , Shade(prepare_shading(scene, volume))
    , Voxels(static_cast<const T*>(volume.grid.voxels))
    , NeedsGradient(volume.meaning == ValueMeaning::Classified &&
        (volume.shading.enabled || !volume.classification.gradient_opacity.empty()))
  {
    if (volume.meaning == ValueMeaning::Classified)
    {
      const Classification& c = volume.classification;
      // What a non-finite voxel stands for is settled in one place, with the marcher's table.
      this->EmptyValue = make_lookup_table(c).empty_value;
      for (double opacity : c.opacity)
      {
        this->Extinction.push_back(extinction_from_opacity(opacity, c.unit_distance));
      }
    }
    this->find_visible();
    if (!this->Extinction.empty())
    {
      this->add_up_variation();
    }
    const glm::dmat4 world_from_index = volume.world_from_data * volume.data_from_index;
    this->WorldFromIndex = world_from_index;
    this->WorldFromGradient = glm::transpose(glm::inverse(glm::dmat3(world_from_index)));
  }

  /// Whether anything can be seen in the brick that holds the place. Only a way to save time: what
  /// cannot be seen has no extinction.
  bool visible(const glm::dvec3& place) const
  {
    std::size_t index = 0;
    for (int axis = 2; axis >= 0; --axis)
    {
      const int brick = static_cast<int>(std::max(place[axis], 0.0)) >> this->Bricks.shift;
      index = index * this->Bricks.dims[axis] + std::min(brick, this->Bricks.dims[axis] - 1);
    }
    return this->Bricks.distance[index] == 0;
  }

  /// The value at a place, as interpolation gives it.
  double value(const glm::dvec3& place) const
  {
    return this->interpolated(this->inside(place), this->TheVolume.grid.component);
  }

  /// How much the transfer functions go up and down between two values: 1 for a way from nothing to
  /// their largest extinction, or from black to white. 0 for densities.
  double variation(double from, double to) const
  {
    if (this->Variation.empty())
    {
      return 0.0;
    }
    const Classification& c = this->TheVolume.classification;
    const std::size_t count = this->Variation.size();
    return std::abs(
      interpolate(this->Variation.data(), table_position(to, c.lower, c.upper, count)) -
      interpolate(this->Variation.data(), table_position(from, c.lower, c.upper, count)));
  }

  /// `along` is the ray's direction in index space.
  Optical at(const glm::dvec3& place, const glm::dvec3& along) const
  {
    Optical result;
    const Grid& grid = this->TheVolume.grid;
    const glm::dvec3 p = this->inside(place);
    const double value = this->interpolated(p, grid.component);
    if (this->TheVolume.meaning == ValueMeaning::Density)
    {
      result.extinction = this->TheVolume.density.extinction * std::max(value, 0.0);
      return result;
    }
    const Classification& c = this->TheVolume.classification;
    const TablePosition position = table_position(value, c.lower, c.upper, c.opacity.size());
    result.extinction = interpolate(this->Extinction.data(), position);
    if (result.extinction <= 0.0)
    {
      return result;
    }
    for (int channel = 0; channel < 3; ++channel)
    {
      result.source[channel] = grid.colour == VoxelColour::RGB
        ? this->interpolated(p, channel) / 255.0
        : interpolate(c.rgb.data() + channel, position, 3);
    }
    if (this->NeedsGradient)
    {
      this->apply_gradient(p, place, along, result);
    }
    return result;
  }

private:
  /// The place that the value at `place` is read at.
  glm::dvec3 inside(const glm::dvec3& place) const
  {
    const Grid& grid = this->TheVolume.grid;
    glm::dvec3 p;
    for (int axis = 0; axis < 3; ++axis)
    {
      p[axis] = std::clamp(place[axis], 0.0, double(grid.dims[axis] - 1));
      if (!grid.linear)
      {
        p[axis] = std::floor(p[axis] + 0.5);
      }
    }
    return p;
  }

  void add_up_variation()
  {
    const Classification& c = this->TheVolume.classification;
    const double most =
      std::max(*std::max_element(this->Extinction.begin(), this->Extinction.end()), 1e-300);
    this->Variation.assign(this->Extinction.size(), 0.0);
    for (std::size_t i = 1; i < this->Extinction.size(); ++i)
    {
      double step = std::abs(this->Extinction[i] - this->Extinction[i - 1]) / most;
      for (std::size_t channel = 0; channel < 3 && !c.rgb.empty(); ++channel)
      {
        step = std::max(step, std::abs(c.rgb[3 * i + channel] - c.rgb[3 * i - 3 + channel]));
      }
      this->Variation[i] = this->Variation[i - 1] + step;
    }
  }

  void find_visible()
  {
    const Volume& volume = this->TheVolume;
    std::vector<bool> seen;
    for (double extinction : this->Extinction)
    {
      seen.push_back(extinction > 0.0);
    }
    const VisibleValues values = seen.empty()
      ? VisibleValues()
      : VisibleValues(volume.classification.lower, volume.classification.upper, seen);
    this->Bricks =
      find_visible_bricks(volume.ranges ? *volume.ranges : measure_bricks(volume.grid),
        [&](float lower, float upper)
        { return seen.empty() ? upper > 0.0f : values.any(lower, upper); },
        static_cast<float>(this->EmptyValue));
  }

  double stored_voxel(int i, int j, int k, int component) const
  {
    const Grid& grid = this->TheVolume.grid;
    if constexpr (std::is_same_v<T, SparseVoxels>)
    {
      return grid.sparse->value(i, j, k);
    }
    else
    {
      const std::size_t index =
        ((static_cast<std::size_t>(k) * grid.dims[1] + j) * grid.dims[0] + i) * grid.components +
        component;
      return static_cast<double>(this->Voxels[index]);
    }
  }

  double voxel(int i, int j, int k, int component) const
  {
    const double value = this->stored_voxel(i, j, k, component);
    return std::isfinite(value) ? value : this->EmptyValue;
  }

  /// The voxels that interpolation and its gradient read along one axis, −1 to 2 around a place.
  struct Taps
  {
    int index[4];
    double value[4]; ///< weights of the linear interpolation
  };

  Taps taps(double p, int axis) const
  {
    Taps t;
    const int last = this->TheVolume.grid.dims[axis] - 1;
    const int low = std::min(static_cast<int>(p), last);
    const double f = p - low;
    for (int i = 0; i < 4; ++i)
    {
      t.index[i] = std::clamp(low + i - 1, 0, last);
    }
    const double value[4] = { 0.0, 1.0 - f, f, 0.0 };
    std::copy(value, value + 4, t.value);
    return t;
  }

  /// Trilinear at a place inside the grid; whole coordinates give the voxel itself.
  double interpolated(const glm::dvec3& p, int component) const
  {
    const Taps x = this->taps(p.x, 0);
    const Taps y = this->taps(p.y, 1);
    const Taps z = this->taps(p.z, 2);
    double sum = 0.0;
    for (int k = 1; k < 3; ++k)
    {
      for (int j = 1; j < 3; ++j)
      {
        sum += z.value[k] * y.value[j] *
          (x.value[1] * this->voxel(x.index[1], y.index[j], z.index[k], component) +
            x.value[2] * this->voxel(x.index[2], y.index[j], z.index[k], component));
      }
    }
    return sum;
  }

  /// Voxels' central differences, one-sided by half at the grid's ends, then interpolated. The
  /// differences come first, so that the gradient of a constant is 0 and not a rounding error.
  glm::dvec3 gradient(const glm::dvec3& p) const
  {
    const int component = this->TheVolume.grid.component;
    const Taps t[3] = { this->taps(p.x, 0), this->taps(p.y, 1), this->taps(p.z, 2) };
    glm::dvec3 sum(0.0);
    for (int corner = 0; corner < 8; ++corner)
    {
      const int at[3] = { 1 + (corner & 1), 1 + (corner >> 1 & 1), 1 + (corner >> 2 & 1) };
      const double weight = t[0].value[at[0]] * t[1].value[at[1]] * t[2].value[at[2]];
      for (int axis = 0; axis < 3; ++axis)
      {
        const auto neighbour = [&](int offset)
        {
          int index[3];
          for (int a = 0; a < 3; ++a)
          {
            index[a] = t[a].index[at[a] + (a == axis ? offset : 0)];
          }
          return this->voxel(index[0], index[1], index[2], component);
        };
        sum[axis] += weight * 0.5 * (neighbour(1) - neighbour(-1));
      }
    }
    return sum;
  }

  void apply_gradient(const glm::dvec3& p, const glm::dvec3& place, const glm::dvec3& along,
    Optical& result) const
  {
    const Classification& c = this->TheVolume.classification;
    const glm::dvec3 slope = this->gradient(p);
    if (!c.gradient_opacity.empty())
    {
      const double magnitude = glm::length(slope / c.gradient_scale);
      const TablePosition position =
        table_position(magnitude, 0.0, c.gradient_upper, c.gradient_opacity.size());
      result.extinction *=
        std::clamp(interpolate(c.gradient_opacity.data(), position), 0.0, 1.0);
    }
    if (this->TheVolume.shading.enabled)
    {
      using scalar::Vec3;
      const glm::dvec3 normal = this->WorldFromGradient * slope;
      const glm::dvec3 view = -glm::normalize(glm::dmat3(this->WorldFromIndex) * along);
      const glm::dvec3 world = glm::dvec3(this->WorldFromIndex * glm::dvec4(place, 1.0));
      const Vec3<double> shaded = scalar::shade<double>(this->Shade,
        Vec3<double>{ normal.x, normal.y, normal.z }, Vec3<double>{ view.x, view.y, view.z },
        Vec3<double>{ world.x, world.y, world.z },
        Vec3<double>{ result.source.x, result.source.y, result.source.z });
      result.source = { shaded.x, shaded.y, shaded.z };
    }
  }

  const Volume& TheVolume;
  ShadeModel Shade;
  const T* Voxels;
  bool NeedsGradient;
  double EmptyValue = 0.0;
  std::vector<double> Extinction; ///< at the nodes of the opacity
  std::vector<double> Variation;  ///< summed from the first node on
  VisibleBricks Bricks;
  glm::dmat4 WorldFromIndex{ 1.0 };
  glm::dmat3 WorldFromGradient{ 1.0 };
};

}
