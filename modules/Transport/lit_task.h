// What the kernels of lit media need besides MarchTask. Internal to Transport. "Index space" is the
// first volume's.
#pragma once

#include "Transport/black_body.h"
#include "Transport/field_view.h"
#include "Transport/marcher.h"
#include "Transport/medium.h"
#include "Transport/phase.h"
#include "Transport/shading.h"

#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace brume
{

/// Quantities on a lattice of nodes, and where the nodes are.
struct LightGrid
{
  FieldView field;
  float scale = 1.0f;         ///< of the values
  float node_from_index[12]{}; ///< row-major 3 × 4
};

/// A map of functions of depth: eight planes of texels. Texel (i, j) stands at the places (i, j, any)
/// of its light's lattice.
struct ShadowFunctions
{
  enum Plane
  {
    Begin, ///< where matter begins, in nodes along the light
    Scale, ///< 1 / (end − begin)
    FirstCoefficient,
  };
  static constexpr int coefficients = 6;
  static constexpr int planes = FirstCoefficient + coefficients;
  const float* texels = nullptr; ///< plane after plane
  int dims[2] = { 0, 0 };
  float node_from_index[12]{};
};

/// A light and the way to it.
struct LitLight
{
  float irradiance[3] = { 0, 0, 0 }; ///< π · Light::diffuse
  ShadeLight source{};               ///< its place, direction, attenuation and cone
  /// In fog: its optical depth up to a light at infinity where its profile is 1, or that no light of it
  /// arrives; of a light that is not at infinity, the exponent (FogTask) at its place.
  float fog_above = 0.0f;
  bool fog_hides = false;
  float fog_exponent = 0.0f;
  /// Index space: the vector toward a light at infinity, of a world unit's length; the place of one
  /// that is not.
  float toward[3] = { 0, 0, 0 };
  float place[3] = { 0, 0, 0 };
  /// Index space to the world, as seen from a light that is not at infinity; its `source` is at the
  /// origin, so that nothing cancels far from the world's own.
  float offset_from_index[12]{};
  /// Optical depths toward it, of channels that are 1, or of R, G and B apart (LitTask::maps).
  LightGrid depth[3];
  ShadowFunctions functions[3];
};

/// One volume's medium.
struct LitVolume
{
  bool lit = false;
  float albedo[3] = { 1, 1, 1 };
  float channels[3] = { 1, 1, 1 };
  struct Octave
  {
    float attenuation;  ///< aᵐ
    float contribution; ///< bᵐ
    PhaseModel phase;
  };
  std::vector<Octave> octaves; ///< at least one
  bool emits = false;
  float emission[3] = { 0, 0, 0 };
  const BlackBodyTable* black_body = nullptr;
  FieldView temperature;
  float temperature_scale = 1.0f; ///< kelvin
  float black_body_scale = 1.0f;
  bool powder = false;
  Powder::Form powder_form = Powder::Form::Exponential;
  float powder_strength = 0.0f;
  float powder_scale = 1.0f;
  float unit_distance = 1.0f;                ///< classified: of the opacity that d is
  float height[4] = { 0, 0, 0, 0 };          ///< h = height · (x, y, z, 1) in its own index space
};

/// Where a volume is, for rays that begin anywhere.
struct LitFrame
{
  float from_first[12]{}; ///< its index space from the first volume's
  bool is_first = true;   ///< which is the same
  float data_from_index[9]{}; ///< row-major, for lengths
  float lower[3]{};       ///< the box that is drawn: the grid's, cut by a box of cropping
  float upper[3]{};
  float rounding[3]{}; ///< what places are off by: as far outside of a face still counts as on it
  std::vector<glm::vec4> planes; ///< half spaces a x + b y + c z + d ≥ 0 of its index space
  bool cropped = false;          ///< by other regions than that box
  float crop_lower[3]{};
  float crop_upper[3]{};
  std::uint32_t regions = 0;
};

/// Light of sky or ground, which reaches a place by E₂ of the optical depth toward it.
struct AmbientLight
{
  float radiance[3] = { 0, 0, 0 };
  LightGrid depth[3];    ///< as of LitLight
  bool from_above = true; ///< the sky: it comes through the fog's layers too
};

/// Fog (fog.h), as kernels read it. Its profile is e^(−exponent), the exponent linear in index space.
struct FogTask
{
  bool enabled = false;
  float extinction = 0.0f; ///< where the profile is 1, per world unit; LitVolume::channels times it
  float falloff = 0.0f;
  float exponent[4] = { 0, 0, 0, 0 }; ///< of the place (x, y, z): this times (x, y, z, 1)
  /// The profile is cut off at e^80, and depths at 1e30: deeper is as dark, and single precision holds
  /// their products.
  static constexpr float least_exponent = -80.0f;
  static constexpr float deepest = 1e30f;
};

struct VolumeTask;

struct LitTask
{
  std::vector<LitVolume> volumes; ///< as many as the scene's, and one for the fog, if there is any
  FogTask fog;
  std::vector<LitFrame> frames;
  std::vector<LitLight> lights;
  std::vector<AmbientLight> ambient;
  ShadowMethod shadows = ShadowMethod::None;
  float shadow_step = 1.0f; ///< in the data's units of the first volume
  bool by_cells = false;    ///< shadow rays go cell by cell, exactly: of one density
  /// Maps for each light: 1 where all volumes have the same channels, which are `channels` then; 3
  /// where not, and `channels` are 1.
  int maps = 1;
  float channels[3] = { 1, 1, 1 };
  float world_from_index[12]{};
  bool components = false; ///< Mixture::Components, of several volumes
  /// Depths that no light comes through, by the thinnest octave and the thinnest channel.
  float deep_enough = 30.0f;
  bool has_channel[3] = { true, true, true }; ///< whether any volume dims R, G, B
  bool absorption = true;
  // What has to be compiled for.
  bool chromatic = false; ///< channels differ
  bool rich = false;      ///< anything but lights at infinity and one octave
};

/// What light meets on its way through a lattice of nodes, asked for by sweep().
struct SweepTask
{
  const std::vector<VolumeTask>* volumes = nullptr;
  const LitTask* lit = nullptr;
  int dims[3] = { 0, 0, 0 }; ///< nodes; the first a multiple of most_lanes
  float index_from_node[12]{};
  /// Light at infinity travels along the lattice's third axis, and enters at node 0. Else it is at
  /// `place` in index space.
  bool positional = false;
  float place[3] = { 0, 0, 0 };
  int pieces = 1; ///< samples between two nodes

  enum class Result
  {
    Depth,     ///< optical depths toward the light
    Functions, ///< ShadowFunctions::planes planes a map
    BothWays,  ///< optical depths toward both ends of the third axis
  };
  Result result = Result::Depth;
  bool floats = false; ///< results of 32 bits instead of 16; functions always are
  float scale = 1.0f;  ///< of 16 bits: what 1 stands for
  /// Depth, Functions: one a map. BothWays: those toward node 0, one a map, then, from the fourth on,
  /// those toward the other end. Null: not wanted.
  void* out[6] = { nullptr, nullptr, nullptr, nullptr, nullptr, nullptr };
};
constexpr int most_lanes = 16;

/// Rows of the lattice: those of its first axis, numbered along the second; for a light that is not
/// at infinity, along the second and third.
void sweep(const SweepTask& task, int first_row, int last_row);

}

