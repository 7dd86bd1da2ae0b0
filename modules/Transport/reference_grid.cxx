#include "Transport/reference_grid.h"

#include "Transport/sparse_voxels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace brume
{

namespace
{

double lerp(double a, double b, double fraction)
{
  return a + fraction * (b - a);
}

/// T is the type of a dense grid's voxels, or SparseVoxels.
template <class T>
class TypedGrid final : public ReferenceGrid
{
public:
  TypedGrid(const Grid& grid, double empty_value)
    : TheGrid(grid)
    , Voxels(static_cast<const T*>(grid.voxels))
    , EmptyValue(empty_value)
  {
  }

  double value(const glm::dvec3& place, int component) const override
  {
    const Taps x = this->taps(place.x, 0);
    const Taps y = this->taps(place.y, 1);
    const Taps z = this->taps(place.z, 2);
    double face[2];
    for (int k = 0; k < 2; ++k)
    {
      double edge[2];
      for (int j = 0; j < 2; ++j)
      {
        const auto voxel = [&](int i)
        { return this->voxel(x.index[1 + i], y.index[1 + j], z.index[1 + k], component); };
        edge[j] = lerp(voxel(0), voxel(1), x.fraction);
      }
      face[k] = lerp(edge[0], edge[1], y.fraction);
    }
    return lerp(face[0], face[1], z.fraction);
  }

  glm::dvec3 gradient(const glm::dvec3& place) const override
  {
    const Taps t[3] = { this->taps(place.x, 0), this->taps(place.y, 1), this->taps(place.z, 2) };
    glm::dvec3 sum(0.0);
    for (int corner = 0; corner < 8; ++corner)
    {
      int at[3];
      double weight = 1.0;
      for (int axis = 0; axis < 3; ++axis)
      {
        const int upper = corner >> axis & 1;
        at[axis] = 1 + upper;
        weight *= upper ? t[axis].fraction : 1.0 - t[axis].fraction;
      }
      for (int axis = 0; axis < 3; ++axis)
      {
        const auto neighbour = [&](int offset)
        {
          int index[3];
          for (int a = 0; a < 3; ++a)
          {
            index[a] = t[a].index[at[a] + (a == axis ? offset : 0)];
          }
          return this->voxel(index[0], index[1], index[2], this->TheGrid.component);
        };
        // The differences come first, so that the gradient of a constant is 0, not a rounding
        // error.
        sum[axis] += weight * 0.5 * (neighbour(1) - neighbour(-1));
      }
    }
    return sum;
  }

private:
  /// The voxels that interpolation and its gradient read along one axis, −1 to 2 around a place.
  struct Taps
  {
    int index[4];
    double fraction;
  };

  Taps taps(double place, int axis) const
  {
    const int last = this->TheGrid.dims[axis] - 1;
    double p = std::clamp(place, 0.0, double(last));
    if (!this->TheGrid.linear)
    {
      p = std::floor(p + 0.5);
    }
    Taps t;
    const int low = std::min(static_cast<int>(p), last);
    t.fraction = p - low;
    for (int i = 0; i < 4; ++i)
    {
      t.index[i] = std::clamp(low + i - 1, 0, last);
    }
    return t;
  }

  double voxel(int i, int j, int k, int component) const
  {
    const Grid& grid = this->TheGrid;
    if constexpr (std::is_same_v<T, SparseVoxels>)
    {
      return this->finite(grid.sparse->value(i, j, k));
    }
    else
    {
      const std::size_t index =
        ((static_cast<std::size_t>(k) * grid.dims[1] + j) * grid.dims[0] + i) * grid.components +
        component;
      return this->finite(static_cast<double>(this->Voxels[index]));
    }
  }

  double finite(double value) const { return std::isfinite(value) ? value : this->EmptyValue; }

  const Grid TheGrid;
  const T* Voxels;
  double EmptyValue;
};

}

std::unique_ptr<ReferenceGrid> ReferenceGrid::make(const Grid& grid, double empty_value)
{
  if (grid.sparse)
  {
    return std::make_unique<TypedGrid<SparseVoxels>>(grid, empty_value);
  }
  switch (grid.type)
  {
    case VoxelType::UInt8:
      return std::make_unique<TypedGrid<std::uint8_t>>(grid, empty_value);
    case VoxelType::Int8:
      return std::make_unique<TypedGrid<std::int8_t>>(grid, empty_value);
    case VoxelType::UInt16:
      return std::make_unique<TypedGrid<std::uint16_t>>(grid, empty_value);
    case VoxelType::Int16:
      return std::make_unique<TypedGrid<std::int16_t>>(grid, empty_value);
    case VoxelType::Float32:
      return std::make_unique<TypedGrid<float>>(grid, empty_value);
    case VoxelType::Float16: // refused by Grid::validate
      break;
  }
  return nullptr;
}

}
