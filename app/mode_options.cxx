#include "mode_options.h"

#include "command.h"
#include "input.h"
#include "option_checks.h"

#include "vtkContourValues.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkPointData.h"
#include "vtkVolumeMapper.h"
#include "vtkVolumeProperty.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <utility>

namespace brume::app
{

namespace
{

const std::vector<std::pair<const char*, int>>& blend_modes()
{
  static const std::vector<std::pair<const char*, int>> modes{
    { "composite", vtkVolumeMapper::COMPOSITE_BLEND },
    { "mip", vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND },
    { "minip", vtkVolumeMapper::MINIMUM_INTENSITY_BLEND },
    { "average", vtkVolumeMapper::AVERAGE_INTENSITY_BLEND },
    { "additive", vtkVolumeMapper::ADDITIVE_BLEND },
    { "isosurface", vtkVolumeMapper::ISOSURFACE_BLEND },
  };
  return modes;
}

const std::vector<std::pair<const char*, int>>& cropping_names()
{
  static const std::vector<std::pair<const char*, int>> names{
    { "subvolume", VTK_CROP_SUBVOLUME },
    { "fence", VTK_CROP_FENCE },
    { "inverted-fence", VTK_CROP_INVERTED_FENCE },
    { "cross", VTK_CROP_CROSS },
    { "inverted-cross", VTK_CROP_INVERTED_CROSS },
  };
  return names;
}

std::vector<std::string> names_of(const std::vector<std::pair<const char*, int>>& list)
{
  std::vector<std::string> names;
  for (const auto& entry : list)
  {
    names.emplace_back(entry.first);
  }
  return names;
}

/// The flags that a word or a number stands for, or −1.
int flags_of(const std::string& text)
{
  for (const auto& entry : cropping_names())
  {
    if (text == entry.first)
    {
      return entry.second;
    }
  }
  char* end = nullptr;
  const long flags = std::strtol(text.c_str(), &end, 0); // 0x… is hexadecimal
  return end != text.c_str() && *end == '\0' && flags >= 0 && flags <= 0x7ffffff
    ? static_cast<int>(flags)
    : -1;
}

/// The four numbers of a plane; false where there are others, or where it has no normal.
bool plane_of(const std::string& text, std::array<double, 4>& plane)
{
  std::istringstream in(text);
  std::string part;
  std::size_t count = 0;
  for (; std::getline(in, part, ','); ++count)
  {
    char* end = nullptr;
    const double value = std::strtod(part.c_str(), &end);
    if (count == 4 || end == part.c_str() || *end != '\0' || !(std::abs(value) <= 1e30))
    {
      return false;
    }
    plane[count] = value;
  }
  return count == 4 && text.back() != ',' && (plane[0] != 0 || plane[1] != 0 || plane[2] != 0);
}

CLI::Validator words_or_flags()
{
  return CLI::Validator(
    [](std::string& text) -> std::string
    {
      return flags_of(text) >= 0 ? std::string()
                                 : "'" + text + "' is neither a name nor a number of 27 bits";
    },
    "");
}

CLI::Validator plane()
{
  return CLI::Validator(
    [](std::string& text) -> std::string
    {
      std::array<double, 4> numbers{};
      return plane_of(text, numbers)
        ? std::string()
        : "'" + text + "' is not a normal that is not 0,0,0 and a distance: four numbers";
    },
    "", "numbers:4");
}

}

void add_mode_options(CLI::App& command, ModeOptions& o)
{
  const char* group = "Mode and cuts";
  const auto any = number("a number from -1e30 to 1e30", [](double v) { return std::abs(v) <= 1e30; });
  command
    .add_option("--blend-mode", o.blend_mode,
      "How what a ray meets becomes a pixel: composite, mip (the largest value), minip (the "
      "smallest), average, additive, isosurface [composite]")
    ->type_name("MODE")
    ->check(one_of(names_of(blend_modes())))
    ->group(group);
  command
    .add_option("--isovalues", o.isovalues,
      "Values of the surfaces of --blend-mode isosurface, in the volume's own unit")
    ->delimiter(',')
    ->allow_extra_args(false)
    ->type_name("V[,V]")
    ->check(any)
    ->group(group);
  command
    .add_option("--average-range", o.average_range,
      "Values that --blend-mode average counts, from L to U, in the volume's own unit [all]")
    ->delimiter(',')
    ->type_name("L,U")
    ->check(any)
    ->group(group);
  CLI::Option* cropping =
    command
      .add_option("--cropping", o.cropping,
        "Two planes across each axis, in world units; the box between them is drawn, or what "
        "--cropping-flags says [no cropping]")
      ->delimiter(',')
      ->type_name("X0,X1,Y0,Y1,Z0,Z1")
      ->check(any)
      ->group(group);
  command
    .add_option("--cropping-flags", o.cropping_flags,
      "Which of the 27 regions between and beside the planes are drawn: subvolume, fence, "
      "inverted-fence, cross, inverted-cross, or a number of 27 bits, x fastest [subvolume]")
    ->type_name("N")
    ->check(words_or_flags())
    ->needs(cropping)
    ->group(group);
  command
    .add_option("--clipping-plane", o.clipping_planes,
      "Draw only where NX x + NY y + NZ z + D is 0 or more, x, y, z in world units; may be given "
      "several times")
    ->allow_extra_args(false)
    ->type_name("NX,NY,NZ,D")
    ->check(plane())
    ->group(group);
  command
    .add_option("--mask", o.mask,
      "Draw only voxels that are not 0 in this volume, which has as many voxels as INPUT")
    ->type_name("FILE")
    ->group(group);
}

void check(const ModeOptions& o)
{
  const bool surfaces = o.blend_mode == "isosurface";
  if (surfaces && o.isovalues.empty())
  {
    throw Failure("--blend-mode isosurface", "there is no value to draw a surface at",
      "give --isovalues V", BadCall);
  }
  if (!surfaces && !o.isovalues.empty())
  {
    throw Failure("--isovalues", "no surfaces are drawn in --blend-mode " + o.blend_mode,
      "add --blend-mode isosurface, or leave it out", BadCall);
  }
  if (o.average_range && o.blend_mode != "average")
  {
    throw Failure("--average-range", "nothing is averaged in --blend-mode " + o.blend_mode,
      "add --blend-mode average, or leave it out", BadCall);
  }
  for (int axis = 0; axis < 3 && o.cropping; ++axis)
  {
    if (!((*o.cropping)[2 * axis] < (*o.cropping)[2 * axis + 1]))
    {
      throw Failure("--cropping",
        std::string("the first plane across ") + "xyz"[axis] + " is not below the second",
        "give them in the order X0,X1,Y0,Y1,Z0,Z1", BadCall);
    }
  }
}

vtkSmartPointer<vtkImageData> open_mask(
  const ModeOptions& options, vtkImageData* input, const std::string& input_name,
  std::int64_t max_memory, bool quiet)
{
  if (options.mask.empty())
  {
    return nullptr;
  }
  if (!input)
  {
    throw Failure("--mask", input_name + " is sparse, and masks are for dense volumes",
      "leave it out", BadCall);
  }
  InputChoice choice;
  choice.max_memory = max_memory;
  const Input file = open_input_with_bar(options.mask, choice, quiet);
  if (!file.image || !input)
  {
    throw Failure(options.mask, "sparse volumes are neither masks nor masked",
      "take dense ones: .nrrd, .nii, .mha, .vti");
  }
  if (!file.image)
  {
    throw Failure(options.mask, "a mask is a dense volume, not an OpenVDB file",
      "name an image of the volume's voxels");
  }
  vtkDataArray* values = file.image->GetPointData()->GetScalars();
  int dims[3];
  int wanted[3];
  file.image->GetDimensions(dims);
  input->GetDimensions(wanted);
  const auto size = [](const int n[3])
  { return std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x " + std::to_string(n[2]); };
  if (dims[0] != wanted[0] || dims[1] != wanted[1] || dims[2] != wanted[2])
  {
    throw Failure(options.mask,
      "the mask has " + size(dims) + " voxels, and " + input_name + " has " + size(wanted),
      "resample the mask to the volume's voxels");
  }
  if (values->GetNumberOfComponents() != 1)
  {
    throw Failure(options.mask, "the mask has several values for each voxel",
      "take a volume of one component");
  }
  auto mask = vtkSmartPointer<vtkImageData>::New();
  mask->SetDimensions(dims);
  mask->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  auto* out = static_cast<unsigned char*>(mask->GetScalarPointer());
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
  {
    const double value = values->GetComponent(i, 0);
    out[i] = value != 0.0 && !std::isnan(value);
  }
  return mask;
}

void apply(const ModeOptions& o, vtkVolumeMapper* mapper, vtkVolumeProperty* property)
{
  for (const auto& mode : blend_modes())
  {
    if (o.blend_mode == mode.first)
    {
      mapper->SetBlendMode(mode.second);
    }
  }
  if (!o.isovalues.empty())
  {
    vtkContourValues* values = property->GetIsoSurfaceValues();
    values->SetNumberOfContours(static_cast<int>(o.isovalues.size()));
    for (std::size_t i = 0; i < o.isovalues.size(); ++i)
    {
      values->SetValue(static_cast<int>(i), o.isovalues[i]);
    }
  }
  if (o.average_range)
  {
    mapper->SetAverageIPScalarRange((*o.average_range)[0], (*o.average_range)[1]);
  }
  // A mapper may have had others.
  mapper->SetCropping(o.cropping.has_value());
  mapper->RemoveAllClippingPlanes();
  if (o.cropping)
  {
    std::array<double, 6> planes = *o.cropping;
    mapper->SetCroppingRegionPlanes(planes.data());
    mapper->SetCroppingRegionFlags(flags_of(o.cropping_flags));
  }
  for (const std::string& text : o.clipping_planes)
  {
    std::array<double, 4> p{};
    plane_of(text, p);
    const double square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
    vtkNew<vtkPlane> plane;
    const double length = std::sqrt(square);
    plane->SetNormal(p[0] / length, p[1] / length, p[2] / length);
    plane->SetOrigin(-p[3] * p[0] / square, -p[3] * p[1] / square, -p[3] * p[2] / square);
    mapper->AddClippingPlane(plane);
  }
}

void apply_cropping_of_voxels(const Cropping& cropping, vtkImageData* image, vtkVolumeMapper* mapper)
{
  if (!cropping.enabled)
  {
    return;
  }
  double planes[6];
  for (int axis = 0; axis < 3; ++axis)
  {
    const double spacing = std::abs(image->GetSpacing()[axis]);
    const int first = image->GetExtent()[2 * axis];
    planes[2 * axis] = spacing * (cropping.lower[axis] + first);
    planes[2 * axis + 1] = spacing * (cropping.upper[axis] + first);
  }
  mapper->CroppingOn();
  mapper->SetCroppingRegionPlanes(planes);
  mapper->SetCroppingRegionFlags(static_cast<int>(cropping.regions));
}

std::string not_drawn_by(const ModeOptions& o, MapperKind mapper)
{
  if (mapper == MapperKind::PathTrace && o.blend_mode != "composite")
  {
    return "vtkBrumePathTraceMapper has no --blend-mode " + o.blend_mode;
  }
  if (mapper == MapperKind::FixedPoint)
  {
    if (o.blend_mode == "average" || o.blend_mode == "additive" || o.blend_mode == "isosurface")
    {
      return "vtkFixedPointVolumeRayCastMapper has no --blend-mode " + o.blend_mode;
    }
    if (!o.mask.empty())
    {
      return "vtkFixedPointVolumeRayCastMapper has no --mask";
    }
  }
  return {};
}

}
