// Clouds by their kind: cumulus, layers, cirrus, cumulonimbus.
#pragma once

#include "data-generators/field.h"

#include <cstdint>
#include <memory>

namespace brume
{

enum class CloudKind
{
  Cumulus,       ///< one fair-weather cloud: flat base, cauliflower top (cumulus.h)
  CumulusField,  ///< many of them of all sizes, over one level
  Stratus,       ///< a grey sheet, ragged below, waved above
  Stratocumulus, ///< a layer of cells, domed, with gaps between
  Cirrus,        ///< streaks of ice, drawn out by the wind
  Cumulonimbus   ///< a tower with an anvil
};

/// What cloud it is. Lengths are metres, time is in seconds, z is up. The defaults of each kind are
/// cloud_defaults(kind); those here are a cumulus'.
struct CloudOptions
{
  CloudKind kind = CloudKind::Cumulus;

  /// Which cloud of its kind. Any value.
  std::uint32_t seed = 1;

  /// Width of the box: x and y in [-width/2, width/2]. Above 0.
  double width = 2000.0;

  /// Heights of the cloud's base and of its top; base < top. For a cumulus 0 is what its width
  /// gives (0.08 width, and 0.44 width above the base). What stands highest ends near the top,
  /// within some tenths of the cloud's height; layers lie strictly between. Heaps (cumulus, cumulus
  /// field, cumulonimbus) have a box from 0 to a little above the top, and need a base of
  /// half their cloud_side_fade() or more. A layer's box reaches a tenth of its height below its
  /// base and above its top.
  double base = 0.0;
  double top = 0.0;

  /// Fraction of the ground under cloud, for cumulus fields and layers, 0 … 1: of the vertical
  /// lines that meet a density above `thinnest` somewhere, away from the box's sides (farther than
  /// cloud_side_fade()), where clouds get fewer. It is met within 0.05 (of a field with
  /// an offset of 0: 0.06) at time 0, in boxes from one
  /// cloud to 64 clouds wide; later on a narrow layer has what the wind brings.
  double coverage = 0.5;
  static constexpr double thinnest = 0.01;

  /// Size of the largest features of the noise that frays it; for cirrus the distance of its
  /// streaks. The finest are 2^(octaves - 1) times smaller. Above 0; octaves 1 … 8.
  double detail_size = 160.0;
  int octaves = 5;

  /// What is left where the noise is 0, (0.8 noise + offset): larger fills and smooths the cloud,
  /// smaller frays and tears it. 0 … 1.
  double offset = 0.12;

  /// Contrast of the cloud's edge. Above 0.
  double crispness = 4.0;

  /// Domain warp: the largest shift along an axis and the size of its eddies. An amplitude of 0 is
  /// none; it is held to [0, 0.06 width] for heaps and to [0, width] for layers.
  double warp_amplitude = 50.0;
  double warp_size = 300.0;

  /// Wind, metres a second. Layers move with it, and come in at the box's upwind side; a heap
  /// stays, and its noise moves through it. The streaks of cirrus lie along its level part (along x
  /// where there is none).
  glm::dvec3 wind{ 4.0, 1.0, 1.5 };
};

/// Usual options of a kind: heights, extents and wind as such clouds have them over middle
/// latitudes (World Meteorological Organization, International Cloud Atlas, 2017).
CloudOptions cloud_defaults(CloudKind kind);

/// How far from the sides of the box clouds of a kind are whole, metres: nearer they get fewer or
/// fade away. 0.06 width for heaps, of a field 0.6 of its clouds' height at most; for layers 0.2
/// width, and the size of their largest patches at most.
double cloud_side_fade(const CloudOptions& options);

/// A cloud: its density, in [0, 1] without a unit, exactly 0 outside its box and at its faces.
/// Multiply by an extinction per metre: some 0.02 to 0.1 for clouds of droplets, 0.0005 to 0.003
/// for cirrus.
///
/// Heaps are soft ellipsoids in a pile, eroded by noise: the recipe of cumulus.h. A cumulus field
/// is many small piles, scattered until they cover enough; a cumulonimbus is a tower of ever larger
/// heaps under flat ones that spread downwind, and from its freezing level on its noise is drawn
/// out into fibres and its edge softens.
///
/// Layers are a cover c(x, y) of noise, a profile over the height h in [0, 1] from base to top, and
/// the same noise n to fray them, with w the warped place moved back by the wind:
///   f       = held(k (c(w) - threshold)) profile(h, c(w))
///   density = held(crispness (f (0.8 n(w) + offset) - 1/4))
/// where the threshold is the one at which `coverage` is met. c is fBm for stratus and
/// cirrus, with cirrus drawn out 3:1 along the wind, and cells (1 - Worley) grouped by fBm for
/// stratocumulus, whose profile is a dome the higher the larger c is. Cirrus has in place of n the
/// ridges of fBm drawn out 9:1, and its places lag by 2.5 (top - base) (1 - h)^2 upwind: ice that
/// falls out of the wind above it trails behind.
///
/// The same options give the same bytes on every machine, SIMD target and number of threads.
/// Throws std::invalid_argument for options out of their range.
std::unique_ptr<Field> make_cloud(const CloudOptions& options);

}
