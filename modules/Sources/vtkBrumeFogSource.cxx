#include "vtkBrumeFogSource.h"

#include "data-generators/fog_bank.h"

#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <stdexcept>
#include <string>

vtkStandardNewMacro(vtkBrumeFogSource);

namespace
{

const char* const kind_names[] = { "Homogeneous", "Height", "Valley" };

std::shared_ptr<const brume::HeightMap> height_map_from(vtkImageData* image)
{
  vtkDataArray* scalars = image->GetPointData()->GetScalars();
  int dimensions[3];
  image->GetDimensions(dimensions);
  if (!scalars || dimensions[2] != 1 ||
      scalars->GetNumberOfTuples() != vtkIdType(dimensions[0]) * dimensions[1])
  {
    throw std::invalid_argument("the height map is an image with point scalars, one layer along z, "
                                "not of " +
                                std::to_string(dimensions[0]) + " x " +
                                std::to_string(dimensions[1]) + " x " +
                                std::to_string(dimensions[2]));
  }
  if (!image->GetDirectionMatrix()->IsIdentity())
  {
    throw std::invalid_argument("the height map has a direction other than the identity: resample "
                                "it along x and y, or set its direction matrix to the identity");
  }
  auto map = std::make_shared<brume::HeightMap>();
  const double* bounds = image->GetBounds(); // of the extent, which may begin anywhere
  for (int axis = 0; axis < 2; ++axis)
  {
    map->dimensions[axis] = dimensions[axis];
    map->origin[axis] = bounds[2 * axis];
    map->spacing[axis] = image->GetSpacing()[axis];
  }
  map->heights.resize(scalars->GetNumberOfTuples());
  for (vtkIdType n = 0; n < scalars->GetNumberOfTuples(); ++n)
  {
    map->heights[n] = static_cast<float>(scalars->GetComponent(n, 0));
  }
  return map;
}

}

vtkBrumeFogSource::vtkBrumeFogSource()
{
  this->SetNumberOfInputPorts(1);
}

vtkBrumeFogSource::~vtkBrumeFogSource() = default;

int vtkBrumeFogSource::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

int vtkBrumeFogSource::RequestUpdateExtent(vtkInformation*,
  vtkInformationVector** inputs,
  vtkInformationVector*)
{
  // Whatever piece of fog is asked for, it takes the whole map.
  if (vtkInformation* info = inputs[0]->GetInformationObject(0))
  {
    int whole[6];
    info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole);
    info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), whole, 6);
  }
  return 1;
}

vtkImageData* vtkBrumeFogSource::UpdateHeightMap()
{
  if (this->GetNumberOfInputConnections(0) == 0)
  {
    return nullptr;
  }
  int port = 0;
  vtkAlgorithm* producer = this->GetInputAlgorithm(0, 0, port);
  producer->UpdateInformation();
  vtkInformation* info = producer->GetOutputInformation(port);
  if (info->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()) > 1)
  {
    throw std::invalid_argument(
      "the height map changes over time, and the ground of a fog bank does "
      "not: take one moment of it (vtkForceTime)");
  }
  producer->UpdateWholeExtent();
  return vtkImageData::SafeDownCast(producer->GetOutputDataObject(port));
}

vtkMTimeType vtkBrumeFogSource::GetFieldMTime()
{
  vtkMTimeType changed = this->GetMTime();
  if (this->Kind == KindValley)
  {
    if (vtkImageData* image = this->UpdateHeightMap())
    {
      changed = std::max(changed, image->GetMTime());
    }
  }
  return changed;
}

std::shared_ptr<const brume::Field> vtkBrumeFogSource::MakeField()
{
  brume::FogOptions options;
  options.kind = static_cast<brume::FogKind>(this->Kind);
  options.seed = static_cast<std::uint32_t>(this->Seed);
  options.width = this->Width;
  options.base = this->BaseHeight;
  options.top = this->TopHeight;
  options.scale_height = this->ScaleHeight;
  options.noise = this->Noise;
  options.detail_size = this->DetailSize;
  options.octaves = this->Octaves;
  options.coverage = this->Coverage;
  options.softness = this->Softness;
  options.sink = this->Sink;
  options.relief = this->Relief;
  options.wind = { this->Wind[0], this->Wind[1], this->Wind[2] };
  std::shared_ptr<const brume::HeightMap> ground;
  if (this->Kind == KindValley)
  {
    if (vtkImageData* image = this->UpdateHeightMap())
    {
      ground = height_map_from(image);
    }
  }
  return std::make_shared<const brume::FogBank>(options, ground);
}

void vtkBrumeFogSource::GetGround(vtkImageData* image)
{
  image->Initialize();
  try
  {
    const auto& fog = static_cast<const brume::FogBank&>(this->GetField());
    if (const brume::HeightMap* map = fog.ground().get())
    {
      image->SetDimensions(map->dimensions.x, map->dimensions.y, 1);
      image->SetOrigin(map->origin.x, map->origin.y, 0.0);
      image->SetSpacing(map->spacing.x, map->spacing.y, 1.0);
      vtkNew<vtkFloatArray> heights;
      heights->SetName("height");
      heights->SetNumberOfTuples(static_cast<vtkIdType>(map->heights.size()));
      std::copy(map->heights.begin(), map->heights.end(), heights->GetPointer(0));
      image->GetPointData()->SetScalars(heights);
    }
  }
  catch (const std::exception& problem)
  {
    vtkErrorMacro("the settings make no fog: " << problem.what());
  }
}

void vtkBrumeFogSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Kind: " << kind_names[this->Kind] << "\n";
  os << indent << "Width: " << this->Width << " m\n";
  os << indent << "BaseHeight: " << this->BaseHeight << " m\n";
  os << indent << "TopHeight: " << this->TopHeight << " m\n";
  os << indent << "ScaleHeight: " << this->ScaleHeight << " m\n";
  os << indent << "Noise: " << this->Noise << "\n";
  os << indent << "DetailSize: " << this->DetailSize << " m\n";
  os << indent << "Octaves: " << this->Octaves << "\n";
  os << indent << "Coverage: " << this->Coverage << "\n";
  os << indent << "Softness: " << this->Softness << " m\n";
  os << indent << "Sink: " << this->Sink << " m\n";
  os << indent << "Relief: " << this->Relief << " m\n";
  os << indent << "Wind: " << this->Wind[0] << " " << this->Wind[1] << " " << this->Wind[2]
     << " m/s\n";
}
