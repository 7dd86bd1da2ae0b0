#include "vtkBrumePhantomSource.h"

#include "vtkBrumeSourceTools.h"

#include "data-generators/head_ct.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

#include <cstdint>
#include <exception>

vtkStandardNewMacro(vtkBrumePhantomSource);

vtkBrumePhantomSource::vtkBrumePhantomSource()
{
  this->SetNumberOfInputPorts(0);
}

vtkBrumePhantomSource::~vtkBrumePhantomSource() = default;

int vtkBrumePhantomSource::RequestInformation(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  brume::describe_grid(brume::grid_over(brume::head_ct_bounds(), this->Size),
    VTK_SHORT,
    outputs->GetInformationObject(0));
  return 1;
}

int vtkBrumePhantomSource::RequestData(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  vtkImageData* image = vtkImageData::GetData(info);
  const int* extent = info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT());
  try
  {
    const brume::Lattice grid = brume::grid_over(brume::head_ct_bounds(), this->Size);
    const auto seed = static_cast<std::uint32_t>(this->Seed);
    if (!this->Head || this->HeadTime != this->GetMTime())
    {
      brume::HeadCTOptions options;
      options.seed = seed;
      options.edge = this->EdgeWidth * grid.spacing.x;
      this->Head = std::make_unique<brume::HeadCT>(options);
      this->HeadTime = this->GetMTime();
    }
    this->AllocateOutputData(image, info);
    image->GetPointData()->GetScalars()->SetName("Hounsfield");
    const brume::Extent block = brume::extent_of(image->GetExtent());
    if (block.voxels() > 0 && !brume::sample_head_ct(*this->Head,
                                this->NoiseLevel,
                                seed,
                                grid,
                                block,
                                static_cast<std::int16_t*>(image->GetScalarPointer()),
                                brume::progress_of(this)))
    {
      image->Initialize();
    }
  }
  catch (const std::exception& problem)
  {
    image->Initialize();
    vtkErrorMacro("the phantom could not be made for the extent "
                  << extent[0] << ' ' << extent[1] << ' ' << extent[2] << ' ' << extent[3] << ' '
                  << extent[4] << ' ' << extent[5] << ": " << problem.what());
    return 0;
  }
  return 1;
}

void vtkBrumePhantomSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Kind: HeadCT\n";
  os << indent << "Size: " << this->Size << " voxels\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "NoiseLevel: " << this->NoiseLevel << " HU\n";
  os << indent << "EdgeWidth: " << this->EdgeWidth << " voxels\n";
}
