#include "presets.h"

#include "command.h"

#include "Transport/sparse_voxels.h"

#include "vtkBrumeSparseVolume.h"

#include <vtkColorTransferFunction.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointData.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

namespace brume::app
{
namespace
{

constexpr std::size_t most_samples = 1 << 20;

/// Calls visit(i) for each of `count` values, or for an evenly strided sample of them.
template <class Visit>
void visit_sample(std::size_t count, const Visit& visit)
{
  // An odd stride meets every column of the usual even-sized grids in turn.
  const std::size_t stride = count > most_samples ? (count / most_samples) | 1 : 1;
  for (std::size_t i = 0; i < count; i += stride)
  {
    visit(i);
  }
}

/// The finite values of component 0, every one or an evenly strided sample, in rising order. Of a
/// sparse volume those that are stored.
std::vector<double> sorted_sample(vtkDataObject* volume)
{
  std::vector<double> sample;
  const auto add = [&sample](double value)
  {
    if (std::isfinite(value))
    {
      sample.push_back(value);
    }
  };
  if (auto* sparse = vtkBrumeSparseVolume::SafeDownCast(volume))
  {
    const SparseVoxels& voxels = *sparse->GetVoxels();
    visit_sample((voxels.slot_count() - 1) * SparseVoxels::brick_voxels,
      [&](std::size_t i)
      {
        add(voxels.value_in_slot(1 + i / SparseVoxels::brick_voxels,
          static_cast<int>(i % SparseVoxels::brick_voxels)));
      });
  }
  else
  {
    auto* image = vtkImageData::SafeDownCast(volume);
    vtkDataArray* scalars = image ? image->GetPointData()->GetScalars() : nullptr;
    if (!scalars || scalars->GetNumberOfTuples() == 0)
    {
      throw Failure("volume", "it holds no scalar values", "give a volume with a scalar array");
    }
    visit_sample(static_cast<std::size_t>(scalars->GetNumberOfTuples()),
      [&](std::size_t i) { add(scalars->GetComponent(static_cast<vtkIdType>(i), 0)); });
  }
  if (sample.empty())
  {
    throw Failure("volume", "it holds no finite value", "look at what wrote it");
  }
  std::sort(sample.begin(), sample.end());
  return sample;
}

double percentile(const std::vector<double>& sorted, double fraction)
{
  return sorted[static_cast<std::size_t>(std::lround(fraction * (sorted.size() - 1)))];
}

std::array<double, 2> robust_range(const std::vector<double>& sorted)
{
  std::array<double, 2> range = { percentile(sorted, 0.001), percentile(sorted, 0.999) };
  if (!(range[0] < range[1]))
  {
    range = { sorted.front(), sorted.back() };
  }
  if (!(range[0] < range[1]))
  {
    range[1] = range[0] + 1.0;
  }
  return range;
}

/// The share of the sample in [low, high].
double share(const std::vector<double>& sorted, double low, double high)
{
  const auto first = std::lower_bound(sorted.begin(), sorted.end(), low);
  const auto last = std::upper_bound(first, sorted.end(), high);
  return static_cast<double>(last - first) / static_cast<double>(sorted.size());
}

std::string number(double value)
{
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string percent(double fraction)
{
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%", 100.0 * fraction);
  return text;
}

/// The lengths of the volume's edges in world units; of a sparse volume those of a cube as large as
/// all that is stored.
std::array<double, 3> edges(vtkDataObject* volume)
{
  std::array<double, 3> lengths;
  if (auto* sparse = vtkBrumeSparseVolume::SafeDownCast(volume))
  {
    const SparseVoxels& voxels = *sparse->GetVoxels();
    double bricks = static_cast<double>(voxels.places().size());
    for (const BrickBox& box : voxels.tiles())
    {
      bricks += static_cast<double>(box.size());
    }
    const double edge = SparseVoxels::brick_edge * std::cbrt(bricks);
    double spacing[3];
    sparse->GetSpacing(spacing);
    for (int i = 0; i < 3; ++i)
    {
      lengths[i] = edge * spacing[i];
    }
    return lengths;
  }
  auto* image = vtkImageData::SafeDownCast(volume);
  int size[3];
  image->GetDimensions(size);
  const double* spacing = image->GetSpacing();
  for (int i = 0; i < 3; ++i)
  {
    lengths[i] = std::max(size[i] - 1, 1) * std::abs(spacing[i]);
  }
  return lengths;
}

PresetChoice choose_ct(const std::vector<double>& sample, const std::string& because)
{
  const double air = share(sample, -1e30, -900);
  const double lung = share(sample, -950, -500) - share(sample, -950, -900);
  if (lung > 0.1)
  {
    return { &find_preset("ct-lung"),
      because + ", and " + percent(lung) + " of the values are lung tissue's" };
  }
  const double body = std::max(1.0 - air, 1e-9);
  const double bone = share(sample, 250, 1e30) / body;
  if (bone >= 0.005)
  {
    return { &find_preset("ct-bone"),
      because + ", and " + percent(bone) + " of what is not air is bone" };
  }
  return { &find_preset("ct-muscle"), because + ", with little bone" };
}

}

const Preset& find_preset(const std::string& name)
{
  std::string names;
  for (const Preset& preset : presets())
  {
    if (preset.name == name)
    {
      return preset;
    }
    names += (names.empty() ? "" : ", ") + preset.name;
  }
  throw Failure("--preset " + name, "no such preset", "choose one of " + names, BadCall);
}

std::array<double, 2> robust_range(vtkDataObject* volume)
{
  return robust_range(sorted_sample(volume));
}

std::array<double, 2> value_range(const Preset& preset, vtkDataObject* volume)
{
  if (preset.value_unit == ValueUnit::Hounsfield)
  {
    return { 0.0, 1.0 };
  }
  std::array<double, 2> range = robust_range(volume);
  if (preset.value_unit == ValueUnit::DensityFraction)
  {
    range = { 0.0, range[1] > 0.0 ? range[1] : 1.0 };
  }
  return range;
}

double opacity_unit_distance(const Preset& preset, vtkDataObject* volume)
{
  if (preset.length_unit == LengthUnit::Millimetre)
  {
    return preset.opacity_unit_distance;
  }
  const auto lengths = edges(volume);
  return preset.opacity_unit_distance * *std::max_element(lengths.begin(), lengths.end());
}

void apply(const Preset& preset, vtkDataObject* volume, vtkVolumeProperty* property)
{
  const auto range = value_range(preset, volume);
  const double scale = range[1] - range[0];

  vtkNew<vtkColorTransferFunction> colour;
  for (const ColourPoint& p : preset.colour)
  {
    colour->AddRGBPoint(range[0] + p.value * scale, p.red, p.green, p.blue);
  }
  vtkNew<vtkPiecewiseFunction> opacity;
  for (const OpacityPoint& p : preset.opacity)
  {
    opacity->AddPoint(range[0] + p.value * scale, p.opacity);
  }
  vtkNew<vtkPiecewiseFunction> gradient;
  for (const OpacityPoint& p : preset.gradient_opacity)
  {
    gradient->AddPoint(p.value * scale, p.opacity);
  }
  if (preset.gradient_opacity.empty())
  {
    gradient->AddPoint(0.0, 1.0);
  }

  property->SetInterpolationTypeToLinear();
  const double unit = opacity_unit_distance(preset, volume);
  for (int c = 0; c < VTK_MAX_VRCOMP; ++c) // each component alike
  {
    property->SetColor(c, colour);
    property->SetScalarOpacity(c, opacity);
    property->SetScalarOpacityUnitDistance(c, unit);
    property->SetDisableGradientOpacity(c, preset.gradient_opacity.empty() ? 1 : 0);
    property->SetGradientOpacity(c, gradient);
    property->SetShade(c, preset.shading.on ? 1 : 0);
    property->SetAmbient(c, preset.shading.ambient);
    property->SetDiffuse(c, preset.shading.diffuse);
    property->SetSpecular(c, preset.shading.specular);
    property->SetSpecularPower(c, preset.shading.power);
  }
}

PresetChoice choose_preset(vtkDataObject* volume, const VolumeHints& hints)
{
  const std::vector<double> sample = sorted_sample(volume);
  const double low = sample.front();
  const double high = sample.back();
  const bool whole = std::all_of(
    sample.begin(), sample.end(), [](double value) { return value == std::floor(value); });
  const std::string span = number(low) + " to " + number(high);

  if (vtkBrumeSparseVolume::SafeDownCast(volume) && low >= 0.0)
  {
    return { &find_preset("cloud"),
      "the values of a sparse volume, " + span + ", are taken for a density" };
  }
  if (hints.modality == "CT")
  {
    return choose_ct(sample, "the scan's header says CT");
  }
  if (hints.modality != "MR" && whole && low <= -900.0 && share(sample, -1100, -900) >= 0.02)
  {
    return choose_ct(sample,
      "whole numbers from " + span + " with a peak at air are Hounsfield units");
  }

  std::string name = hints.array_name;
  auto* image = vtkImageData::SafeDownCast(volume);
  const char* own_name = image ? image->GetPointData()->GetScalars()->GetName() : nullptr;
  if (name.empty() && own_name)
  {
    name = own_name;
  }
  std::transform(name.begin(), name.end(), name.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool fractional = !whole || high <= 1.0;
  if (hints.modality != "MR" && fractional && low >= 0.0 && name.find("density") != name.npos)
  {
    return { &find_preset("cloud"), "the values, " + span + ", are named a density" };
  }

  if (hints.modality == "MR" || (whole && low >= 0.0 && high > 1.0))
  {
    const std::string because = hints.modality == "MR"
      ? std::string("the scan's header says MR")
      : "whole numbers from " + span + ", none negative, are taken for magnetic resonance";
    const auto lengths = edges(volume);
    const bool head = std::all_of(lengths.begin(), lengths.end(),
      [](double length) { return length >= 120.0 && length <= 330.0; });
    return head ? PresetChoice{ &find_preset("mr-brain"), because + ", and the size is a head's" }
                : PresetChoice{ &find_preset("mr-default"), because };
  }
  return { &find_preset("grey"), "nothing is known of values from " + span };
}

}
