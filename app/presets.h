// Transfer functions with a name: how the values of a scan become colour and opacity when the user
// brings no transfer function of his own (--preset NAME), and which of them suits a volume.
#pragma once

#include <array>
#include <string>
#include <vector>

class vtkDataObject;
class vtkVolumeProperty;

namespace brume::app
{

/// What the values of a preset's points are.
enum class ValueUnit
{
  Hounsfield,      ///< Hounsfield units: water 0, air -1000. The points are the data's own values.
  RangeFraction,   ///< 0 and 1 are the ends of the data's robust range, see robust_range().
  DensityFraction, ///< 0 is the value 0, 1 the upper end of the robust range.
};

/// What a preset's opacity unit distance is measured in.
enum class LengthUnit
{
  Millimetre,   ///< world units, which scans give in millimetres
  /// A fraction of the volume's longest edge, for data of any scale; of a sparse volume that of a cube
  /// as large as all that is stored, however far apart it lies.
  EdgeFraction,
};

/// A colour at a value, linear in between and constant outside. Red, green and blue in [0, 1].
struct ColourPoint
{
  double value, red, green, blue;
};

/// An opacity at a value (or at a gradient magnitude), linear in between and constant outside:
/// what a slab of the opacity unit distance hides, in [0, 1].
struct OpacityPoint
{
  double value, opacity;
};

/// VTK's shading terms: ambient, diffuse and specular factors in [0, 1], and the exponent.
struct Shading
{
  bool on;
  double ambient, diffuse, specular, power;
};

/// A named transfer function.
struct Preset
{
  std::string name;     ///< as --preset takes it
  std::string title;    ///< as a report shows it
  std::string modality; ///< "CT", "MR" or "any density"
  ValueUnit value_unit;
  LengthUnit length_unit;
  double opacity_unit_distance; ///< in length_unit, positive
  std::vector<ColourPoint> colour;
  std::vector<OpacityPoint> opacity;
  /// Opacity against gradient magnitude, in value_unit per millimetre. May be empty, and is in every
  /// preset here: stock mappers do not agree on the scale of a gradient.
  std::vector<OpacityPoint> gradient_opacity;
  Shading shading;
  std::string description;
};

/// All presets, in the order in which they are listed to the user.
const std::vector<Preset>& presets();

/// The preset of that name. Throws Failure (BadCall) with the list of names when there is none.
const Preset& find_preset(const std::string& name);

/// The range that most of the volume's values lie in, blind to single outliers: the 0.1th and the
/// 99.9th percentile of the finite values of the first component. Volumes of more than a million
/// values are sampled at a fixed, even stride, and of a sparse volume what is stored. Where the two percentiles coincide (a small object in
/// much background) the range is the smallest to the largest sampled value, where these coincide
/// too, (value, value + 1). Throws Failure for a volume without scalars or without a finite value.
std::array<double, 2> robust_range(vtkDataObject* volume);

/// The data values that a preset's points 0 and 1 stand for in this volume: (0, 1) for Hounsfield
/// units. A point p lies at range[0] + p (range[1] - range[0]).
std::array<double, 2> value_range(const Preset& preset, vtkDataObject* volume);

/// The preset's opacity unit distance for this volume, in world units.
double opacity_unit_distance(const Preset& preset, vtkDataObject* volume);

/// Fills the property (colour, opacity, gradient opacity, unit distance, shading, linear
/// interpolation; component 0) for this volume. What the property held of these is replaced.
/// Throws Failure as robust_range() does.
void apply(const Preset& preset, vtkDataObject* volume, vtkVolumeProperty* property);

/// A volume is a vtkImageData with point scalars or a vtkBrumeSparseVolume, here and above.
/// What is known of one beyond its values; empty where it is not known.
struct VolumeHints
{
  std::string modality;   ///< as DICOM writes it: "CT", "MR"
  std::string array_name; ///< the name of the scalars; taken from the volume when empty
};

/// A preset and why it was taken, one sentence for the user.
struct PresetChoice
{
  const Preset* preset; ///< never null, one of presets()
  std::string reason;
};

/// The preset for a volume when the user names none. In this order:
/// - a sparse volume without negative values: cloud;
/// - the modality CT, or whole numbers from -900 or less with a peak at air (at least 2 % of the
///   values in [-1100, -900]): ct-lung where lung tissue, [-950, -500], is more than a tenth of the
///   volume, else ct-bone where values over 250 are at least 0.5 % of what is not air, else
///   ct-muscle;
/// - fractional, no value negative, and the array named after a density: cloud;
/// - the modality MR, or whole numbers, none negative: mr-brain where each edge is between 120 and
///   330 mm, as a head's scan has it, else mr-default;
/// - anything else: grey.
/// The same volume always gets the same preset. Throws Failure as robust_range() does.
PresetChoice choose_preset(vtkDataObject* volume, const VolumeHints& hints = {});

}
