#include "vtkBrumeCloudSource.h"

#include "vtkBrumeSourceTools.h"

#include "data-generators/cumulus.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

#include <cstdint>
#include <exception>

vtkStandardNewMacro(vtkBrumeCloudSource);

vtkBrumeCloudSource::vtkBrumeCloudSource()
{
  this->SetNumberOfInputPorts(0);
}

vtkBrumeCloudSource::~vtkBrumeCloudSource() = default;

const brume::Cumulus& vtkBrumeCloudSource::GetCloud()
{
  if (!this->Cloud || this->CloudTime != this->GetMTime())
  {
    brume::CumulusOptions options;
    options.seed = static_cast<std::uint32_t>(this->Seed);
    options.width = this->Width;
    options.detail_size = this->DetailSize;
    options.octaves = this->Octaves;
    options.offset = this->Offset;
    options.crispness = this->Crispness;
    options.warp_amplitude = this->WarpAmplitude;
    options.warp_size = this->WarpSize;
    options.wind = { this->Wind[0], this->Wind[1], this->Wind[2] };
    this->Cloud = std::make_unique<brume::Cumulus>(options);
    this->CloudTime = this->GetMTime();
  }
  return *this->Cloud;
}

int vtkBrumeCloudSource::RequestInformation(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  try
  {
    brume::describe_grid(brume::grid_over(this->GetCloud().bounds(), this->Size),
      VTK_FLOAT,
      outputs->GetInformationObject(0));
  }
  catch (const std::exception& problem)
  {
    vtkErrorMacro("the settings make no cloud: " << problem.what());
    return 0;
  }
  return 1;
}

int vtkBrumeCloudSource::RequestData(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  vtkImageData* image = vtkImageData::GetData(info);
  try
  {
    const brume::Cumulus& cloud = this->GetCloud();
    const brume::Lattice grid = brume::grid_over(cloud.bounds(), this->Size);
    this->AllocateOutputData(image, info);
    image->GetPointData()->GetScalars()->SetName("density");
    const brume::Extent block = brume::extent_of(image->GetExtent());
    if (block.voxels() > 0 && !brume::sample(cloud,
                                this->Time,
                                grid,
                                block,
                                static_cast<float*>(image->GetScalarPointer()),
                                brume::progress_of(this)))
    {
      image->Initialize();
    }
  }
  catch (const std::exception& problem)
  {
    image->Initialize();
    vtkErrorMacro("the cloud could not be made: " << problem.what());
    return 0;
  }
  return 1;
}

void vtkBrumeCloudSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Size: " << this->Size << " voxels\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "Time: " << this->Time << " s\n";
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
