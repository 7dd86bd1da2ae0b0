// What a kernel needs to march the rays of one tile. Internal to Transport.
#pragma once

#include "Transport/bricks.h"
#include "Transport/film.h"
#include "Transport/lookup_table.h"
#include "Transport/ray.h"
#include "Transport/shading.h"

#include <cstdint>

namespace brume
{

struct MarchTask
{
  const Grid* grid = nullptr;
  ValueMeaning meaning = ValueMeaning::Classified;
  const RayMaker* rays = nullptr;
  const LookupTable* table = nullptr; ///< classified grids
  const ShadeModel* shade = nullptr;  ///< classified grids
  float gradient_scale[3] = { 1, 1, 1 };  ///< a voxel's difference to places in the gradient's table
  double depth_per_value = 0.0;           ///< density grids: optical depth of a step of density 1
  float half_depth = 0.0f; ///< density grids: the sum of densities, in steps, that takes half
  const VisibleBricks* bricks = nullptr;  ///< null: nothing to leap over
  bool non_finite = false;                ///< the grid holds NaN or infinities
  double step = 1.0;                      ///< in the data's units
  float step_error = 0.0f;                ///< part of Film::error
  float brightest = 1.0f;                 ///< bound of the light that may come from behind
  float leave_below = 0.0f;               ///< a ray ends when its transmittance is below this
  int x0 = 0, x1 = 0, y0 = 0, y1 = 0;     ///< the tile's pixels
  Film* film = nullptr;
};

struct MarchCount
{
  std::uint64_t samples = 0; ///< places at which the grid was read
  std::uint64_t rays = 0;    ///< rays that met the grid
};

/// The kernels, one file a voxel type; each chooses the best SIMD target of the machine.
MarchCount march_uint8(const MarchTask& task);
MarchCount march_int8(const MarchTask& task);
MarchCount march_uint16(const MarchTask& task);
MarchCount march_int16(const MarchTask& task);
MarchCount march_float32(const MarchTask& task);
MarchCount march_rgba8(const MarchTask& task);

}
