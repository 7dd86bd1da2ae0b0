#include "vtkBrumeCloudSource.h"

#include "data-generators/clouds.h"

#include "vtkObjectFactory.h"

#include <algorithm>
#include <cstdint>

vtkStandardNewMacro(vtkBrumeCloudSource);

namespace
{

const char* const kind_names[] = { "Cumulus",
  "CumulusField",
  "Stratus",
  "Stratocumulus",
  "Cirrus",
  "Cumulonimbus" };

}

vtkBrumeCloudSource::vtkBrumeCloudSource() = default;

vtkBrumeCloudSource::~vtkBrumeCloudSource() = default;

void vtkBrumeCloudSource::SetKind(int kind)
{
  kind = std::clamp<int>(kind, KindCumulus, KindCumulonimbus);
  if (kind == this->Kind)
  {
    return;
  }
  const brume::CloudOptions usual = brume::cloud_defaults(static_cast<brume::CloudKind>(kind));
  this->Kind = kind;
  this->BaseHeight = usual.base;
  this->TopHeight = usual.top;
  this->Coverage = usual.coverage;
  this->Width = usual.width;
  this->DetailSize = usual.detail_size;
  this->Octaves = usual.octaves;
  this->Offset = usual.offset;
  this->Crispness = usual.crispness;
  this->WarpAmplitude = usual.warp_amplitude;
  this->WarpSize = usual.warp_size;
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Wind[axis] = usual.wind[axis];
  }
  this->Modified();
}

std::shared_ptr<const brume::Field> vtkBrumeCloudSource::MakeField()
{
  brume::CloudOptions options;
  options.kind = static_cast<brume::CloudKind>(this->Kind);
  options.seed = static_cast<std::uint32_t>(this->Seed);
  options.width = this->Width;
  options.base = this->BaseHeight;
  options.top = this->TopHeight;
  options.coverage = this->Coverage;
  options.detail_size = this->DetailSize;
  options.octaves = this->Octaves;
  options.offset = this->Offset;
  options.crispness = this->Crispness;
  options.warp_amplitude = this->WarpAmplitude;
  options.warp_size = this->WarpSize;
  options.wind = { this->Wind[0], this->Wind[1], this->Wind[2] };
  return brume::make_cloud(options);
}

void vtkBrumeCloudSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Kind: " << kind_names[this->Kind] << "\n";
  os << indent << "BaseHeight: " << this->BaseHeight << " m\n";
  os << indent << "TopHeight: " << this->TopHeight << " m\n";
  os << indent << "Coverage: " << this->Coverage << "\n";
  os << indent << "Width: " << this->Width << " m\n";
  os << indent << "DetailSize: " << this->DetailSize << " m\n";
  os << indent << "Octaves: " << this->Octaves << "\n";
  os << indent << "Offset: " << this->Offset << "\n";
  os << indent << "Crispness: " << this->Crispness << "\n";
  os << indent << "WarpAmplitude: " << this->WarpAmplitude << " m\n";
  os << indent << "WarpSize: " << this->WarpSize << " m\n";
  os << indent << "Wind: " << this->Wind[0] << " " << this->Wind[1] << " " << this->Wind[2]
     << " m/s\n";
}
