// What a kernel needs to march the rays of one tile. Internal to Transport.
#pragma once

#include "Transport/bricks.h"
#include "Transport/field_view.h"
#include "Transport/film.h"
#include "Transport/lookup_table.h"
#include "Transport/marcher.h"
#include "Transport/ray.h"
#include "Transport/shading.h"

#include <array>
#include <cstdint>
#include <vector>

namespace brume
{

/// One volume, with its tables.
struct VolumeTask
{
  ValueMeaning meaning = ValueMeaning::Classified;
  FieldView field;
  const VisibleBricks* visible = nullptr; ///< null: all of them
  const VisibleBricks* bricks = nullptr;  ///< the same, for leaping; null: nothing to leap over
  float extinction = 1.0f; ///< density grids: per unit of density and of the data's length
  float largest = 0.0f;    ///< density grids: value
  float weight = 1.0f;     ///< classified grids: a factor on the table's extinction

  const LookupTable* table = nullptr; ///< classified grids
  ShadeModel shade;                   ///< classified grids
  bool needs_gradient = false;
  float gradient_scale[3] = { 1, 1, 1 }; ///< a voxel's difference to places in the gradient's table
  VoxelColour colour = VoxelColour::Value;
  FieldView colours[3]; ///< the components that give the colour, unless it is the value

  bool masked = false;
  FieldView labels;
  /// For each label the first of its nodes in the table, or −1 for a hidden one.
  std::array<std::int32_t, 256> first_node{};

  /// Extremes: 1 for the largest value, −1 for the smallest; the largest of sign · value in each
  /// brick and in all.
  ///@{
  float sign = 1.0f;
  const float* bounds = nullptr;
  int brick_dims[3] = { 0, 0, 0 };
  int brick_shift = 3; ///< log2 of their edge
  float top = 0.0f;
  float rounding = 0.0f; ///< more than two ways to interpolate one value differ by
  ///@}
  float black = 0.0f;  ///< greys: the value that is black
  float whiten = 0.0f; ///< greys: what a value above it is times to be a grey
  float per_unit = 1.0f; ///< greys: 1 / unit distance
  /// Isosurfaces: colour and opacity of each value, for the classification and then for each label.
  const LookupNode* surfaces = nullptr;
  float slice[4] = { 0, 0, 0, 0 }; ///< the plane in index space
};

struct LitTask;
class FogModel;
class FogRays;

struct MarchTask
{
  const std::vector<VolumeTask>* volumes = nullptr;
  const LitTask* lit = nullptr; ///< of lit media
  const FogModel* fog = nullptr; ///< with lit, of fog
  const FogRays* fog_rays = nullptr;
  const RayMaker* rays = nullptr;
  StepRule rule = StepRule::Midpoint;
  Mixture mixture = Mixture::Sum;
  double step = 1.0; ///< in the data's units
  bool jitter = false;
  int refinements = 0;       ///< how often the step of a packet may be halved
  float refine_error = 0.0f; ///< where its estimated error is larger than this
  float step_error = 0.0f;            ///< part of Film::error
  float brightest = 1.0f;             ///< bound of the light that may come from behind
  float leave_below = 0.0f;           ///< a ray ends when its transmittance is below this
  float average_range[2] = { 0, 0 };
  std::vector<float> isosurfaces;     ///< sorted, each once
  int x0 = 0, x1 = 0, y0 = 0, y1 = 0; ///< the tile's pixels
  Film* film = nullptr;
};

struct MarchCount
{
  std::uint64_t samples = 0; ///< places at which a grid was read
  std::uint64_t rays = 0;    ///< rays that met a volume
};

/// The integrators; each chooses the best SIMD target of the machine.
///@{
MarchCount march_density(const MarchTask& task);   ///< one grid of densities
MarchCount march_composite(const MarchTask& task); ///< one classified grid
MarchCount march_mixture(const MarchTask& task);   ///< any number of volumes, masks, colours
MarchCount march_lit_density(const MarchTask& task); ///< one grid of densities, lit
MarchCount march_lit_mixture(const MarchTask& task); ///< any volumes, some of them lit
MarchCount march_fog(const MarchTask& task);         ///< any volumes, in fog
MarchCount march_extreme(const MarchTask& task);   ///< MaximumIntensity, MinimumIntensity
MarchCount march_mean(const MarchTask& task);      ///< AverageIntensity
MarchCount march_sum(const MarchTask& task);       ///< Additive
MarchCount march_surfaces(const MarchTask& task);  ///< Isosurface, of the first volume
MarchCount march_slice(const MarchTask& task);     ///< Slice, of the first volume
///@}
}
