// What is to be drawn, as plain data: the grid and its place, what its values mean, lights, camera.
// Conventions and units: docs/dev/units.md.
#pragma once

#include "Transport/bricks.h"
#include "Transport/grid.h"
#include "Transport/medium.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace brume
{

/// Values as a density of matter: the extinction coefficient is `extinction * value`.
/// Negative and non-finite values count as 0. Without a lit medium (Volume::medium) the matter
/// absorbs and does not emit.
struct Density
{
  double extinction = 1.0; ///< per unit of length and of density; ≥ 0
  /// What R, G and B have of it, each in [0, 1]: σt = extinction · channels · value.
  glm::dvec3 channels{ 1.0 };
};

/// Values classified by transfer functions, as a vtkVolumeProperty does.
///
/// The functions are given as tables over [lower, upper], piecewise linear between nodes at even
/// distances; values outside take the end's entry. Fine tables (65537 nodes) make the reference's
/// truth; the marcher makes its own from them.
struct Classification
{
  double lower = 0.0;
  double upper = 1.0;
  /// Opacity in [0, 1] of a stretch of `unit_distance`; σt = −ln(1 − opacity) / unit_distance.
  std::vector<double> opacity;
  /// Source colour, R, G, B a node, linear. Empty for grids that carry theirs (VoxelColour::RGB).
  std::vector<double> rgb;
  /// The length that `opacity` speaks of, in the units of the data's own coordinates; > 0.
  double unit_distance = 1.0;

  /// A factor on the extinction by the magnitude of the gradient, at even distances over
  /// [0, gradient_upper], the last entry beyond. Empty: no such factor.
  std::vector<double> gradient_opacity;
  double gradient_upper = 1.0;
  /// What one voxel of central difference is divided by, for each axis: spacing / mean spacing
  /// gives VTK's gradient magnitude, in values per mean voxel.
  glm::dvec3 gradient_scale{ 1.0 };

  /// A transfer function of value and gradient magnitude in place of opacity, rgb and
  /// gradient_opacity, which must then be empty: R, G, B, A a node, values from `lower` to `upper`
  /// along a row, gradient magnitudes from 0 to `gradient_upper` from row to row. Colour and
  /// opacity (not extinction) are bilinear between nodes; the end's entry holds beyond. Empty:
  /// none.
  std::vector<double> value_gradient;
  int value_gradient_width = 0; ///< nodes in a row; ≥ 2, and as many rows as fit, ≥ 2
};

/// How the voxels under labels are drawn: one label a voxel, on the grid's own lattice, read at the
/// nearest voxel (labels do not interpolate).
struct Mask
{
  /// As many as the grid has voxels, padding included, x fastest; the caller owns the memory. Null:
  /// no mask.
  const std::uint8_t* labels = nullptr;
  static constexpr std::uint8_t hidden = 255;
  /// For each label the classification it is drawn with: 0 for Volume::classification, n for
  /// Volume::label_classifications[n − 1], or `hidden`.
  std::array<std::uint8_t, 256> classification_of_label{};
};

/// The parts of a volume that are drawn: boxes between planes across the grid's axes, and half
/// spaces.
struct Cropping
{
  bool enabled = false;
  /// Two planes across each axis of index space, lower ≤ upper, in voxels. They may lie outside the
  /// grid.
  double lower[3] = { 0, 0, 0 };
  double upper[3] = { 0, 0, 0 };
  /// Bit x + 3 y + 9 z tells whether the region is drawn that is the x-th along the first axis (0
  /// before the lower plane, 1 between, 2 beyond the upper), the y-th and the z-th along the
  /// others. A ray that runs in a plane is between. The same 27 bits as vtkVolumeMapper's; 0x2000
  /// is the box in the middle.
  std::uint32_t regions = 0x2000;

  /// Whether the region of a place of index space is drawn, if cropping is enabled.
  bool draws(const glm::dvec3& place) const;
};

/// Surface-like shading of classified values by the direction of their gradient, after Blinn and
/// Phong, as VTK's volume mappers do: colour · (ambient + diffuse) + specular.
struct Shading
{
  bool enabled = false;
  double ambient = 0.1;
  double diffuse = 0.7;
  double specular = 0.2;
  double specular_power = 10.0;
  /// Normals that point away from the viewer are turned round.
  bool two_sided = true;
  /// Colour of the ambient light.
  glm::dvec3 ambient_light{ 1.0 };
};

/// A light, in world space. Colours include the intensity.
struct Light
{
  /// What a white diffuse surface that faces the light sends: its irradiance is π times this.
  glm::dvec3 diffuse{ 1.0 };
  glm::dvec3 specular{ 1.0 };
  /// Unit vector along which the light travels.
  glm::dvec3 direction{ 0.0, 0.0, -1.0 };
  bool positional = false;
  glm::dvec3 position{ 0.0 };
  /// 1 / (a + b d + c d²) at the distance d; positional lights only.
  glm::dvec3 attenuation{ 1.0, 0.0, 0.0 };
  /// Half angle of the cone in degrees; from 90 on the light shines all round. Positional only.
  double cone_angle = 180.0;
  /// Exponent of the fall-off inside the cone.
  double exponent = 1.0;
};

/// The camera as one matrix, so that perspective, parallel, sheared and off-axis views are alike.
struct Camera
{
  /// World to normalised device coordinates, [-1, 1] along x and y for the picture's edges and
  /// along z from the near to the far plane. Nothing nearer or farther is drawn.
  glm::dmat4 clip_from_world{ 1.0 };
  /// The direction of projection in world space, for shading; a unit vector.
  glm::dvec3 direction{ 0.0, 0.0, -1.0 };
};

/// How the grid's values become optical properties.
enum class ValueMeaning
{
  Density,
  Classified,
};

/// One grid, where it is and what its values mean.
struct Volume
{
  Grid grid;
  /// The grid's brick ranges, where the caller has measured them; otherwise the marcher does.
  std::shared_ptr<const BrickRanges> ranges;
  /// Index space to the data's own coordinates (spacing, direction, origin). Lengths along a ray,
  /// steps and unit distances are measured there.
  glm::dmat4 data_from_index{ 1.0 };
  /// The data's coordinates to the world (a prop's matrix). It moves and deforms the picture, and
  /// leaves optical depths as they are, as VTK's mappers do.
  glm::dmat4 world_from_data{ 1.0 };

  ValueMeaning meaning = ValueMeaning::Classified;
  Density density;
  Classification classification;
  /// Where the medium is lit, light that shading sends on is dimmed on its way as all light is, and
  /// shading takes the place of the phase function.
  Shading shading;
  Medium medium;
  /// A factor on the extinction (and so on the light sent), as vtkVolumeProperty's component
  /// weight; ≥ 0. In projections it multiplies the volume's share of the pixel; surfaces do not
  /// take it.
  double weight = 1.0;
  /// The values that AverageIntensity and Additive draw black and white: the range of all values of
  /// the component, for VTK's mappers. Where the second is not above the first, all is black. In
  /// grids whose voxels carry their colour (VoxelColour) the first component is the value meant.
  double grey_range[2] = { 0.0, 1.0 };

  Mask mask;
  /// What labels of the mask are drawn with in place of `classification`.
  std::vector<Classification> label_classifications;

  Cropping cropping;
  /// Half spaces of the world outside of which nothing is drawn: the points with
  /// a x + b y + c z + d ≥ 0 stay, (a, b, c, d) a plane.
  std::vector<glm::dvec4> clipping_planes;

  /// Keys of the marcher's caches; 0 keeps nothing. Give a new number whenever the voxels or the
  /// mask (data_revision) or their meaning (medium_revision: density, classifications, weight)
  /// change.
  std::uint64_t data_revision = 0;
  std::uint64_t medium_revision = 0;
};

/// How what a ray meets becomes a pixel; docs/theory/modes.md. All but Composite need classified
/// volumes. A ray that meets nothing that is drawn (cropped, clipped, masked parts are not) leaves
/// its pixel as it was.
///
/// Of several volumes, the four projections draw each by itself; the pixel is the sum of their
/// pixels times their weights, its opacity at most 1. Isosurface and Slice draw volumes[0] alone.
/// No projection looks at gradient_opacity, Shading or the step.
enum class BlendMode
{
  /// Emission and absorption, front to back.
  Composite,
  /// The largest value on the ray, classified where it is first reached: opacity α and colour c
  /// there make the radiance α c and the transmittance 1 − α. α is not spread over unit_distance.
  /// A non-finite voxel counts as the volume's smallest value, so that it is never the largest.
  MaximumIntensity,
  /// The smallest value, likewise; a non-finite voxel counts as the volume's largest value.
  MinimumIntensity,
  /// The mean of α · grey over the parts of the ray whose value is within Scene::average_range, up
  /// to 1, opaque; grey is the fraction of Volume::grey_range. A ray without such parts draws
  /// nothing.
  AverageIntensity,
  /// ∫ α · grey ds / unit_distance, up to 1, opaque.
  Additive,
  /// Surfaces where the value passes through one of Scene::isosurfaces, classified by that value
  /// (α is a surface's own opacity, not one of a length), lit as Shading has it, gradient_opacity
  /// multiplied in, seen through one another. Where a part begins or ends there is no surface.
  Isosurface,
  /// The plane Scene::slice, classified (α as for Isosurface) and lit.
  Slice,
};

/// How the light of volumes that overlap adds up. Each place sends Σ wσc in both, w being weights,
/// σ extinctions and c colours.
enum class Mixture
{
  /// The extinctions add up: Σ wσ. Matter in the same place.
  Sum,
  /// The extinction is Σ (wσ)² / Σ wσ, the mean of the volumes' own, weighted with themselves: what
  /// VTK's mappers make of independent components. Not physical: two colours in one place make
  /// their sum, as bright as each alone.
  Components,
};

/// What is to be drawn. Several volumes may overlap. Independent components of one grid are volumes
/// that share its voxels, with a component each, mixed as Mixture::Components.
struct Scene
{
  std::vector<Volume> volumes = std::vector<Volume>(1); ///< at least one, or none in fog
  Mixture mixture = Mixture::Sum;
  BlendMode blend_mode = BlendMode::Composite;
  /// Values outside are left out of AverageIntensity; both ends are inside.
  double average_range[2] = { -1e300, 1e300 };
  /// Values of the surfaces, in any order. None: nothing is drawn.
  std::vector<double> isosurfaces;
  /// The plane of BlendMode::Slice in the world: a x + b y + c z + d = 0.
  glm::dvec4 slice{ 0.0, 0.0, 1.0, 0.0 };

  std::vector<Light> lights;
  Sky sky; ///< of lit media and fog
  Fog fog; ///< in BlendMode::Composite
  Camera camera;

  /// Opaque geometry: normalised device depth in [-1, 1] of the nearest surface of each pixel, rows
  /// from the bottom up, as many as the film has pixels; empty for none. Rays end there.
  std::vector<float> surface_depth;

  /// Throws std::invalid_argument for what no integrator can draw: see Grid::validate and the
  /// bounds of Volume's parts; a density of several components, a density in another mode than
  /// Composite, colours that are missing, isovalues or a slice that are not finite.
  void validate() const;
};
}
