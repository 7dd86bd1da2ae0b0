#include "vtkBrumeSmokeSource.h"

#include "vtkBrumeSourceTools.h"

#include "data-generators/plume.h"

#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

#include <cstdint>
#include <exception>

vtkStandardNewMacro(vtkBrumeSmokeSource);

vtkBrumeSmokeSource::vtkBrumeSmokeSource()
{
  this->SetNumberOfInputPorts(0);
}

vtkBrumeSmokeSource::~vtkBrumeSmokeSource() = default;

brume::PlumeOptions vtkBrumeSmokeSource::GetOptions() const
{
  brume::PlumeOptions options;
  options.seed = static_cast<std::uint32_t>(this->Seed);
  options.width = this->Width;
  options.rise = this->Rise;
  options.air_temperature = this->AirTemperature;
  options.source_temperature = this->SourceTemperature;
  return options;
}

int vtkBrumeSmokeSource::RequestInformation(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  try
  {
    const brume::Plume plume(this->GetOptions());
    brume::describe_grid(
      brume::grid_over(plume.bounds(), this->Size), VTK_FLOAT, outputs->GetInformationObject(0));
    brume::describe_time(
      this->StartTime, this->EndTime, this->NumberOfTimeSteps, outputs->GetInformationObject(0));
  }
  catch (const std::exception& problem)
  {
    vtkErrorMacro("the settings make no smoke: " << problem.what());
    return 0;
  }
  return 1;
}

int vtkBrumeSmokeSource::RequestData(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  vtkImageData* image = vtkImageData::GetData(info);
  try
  {
    const brume::Plume plume(this->GetOptions());
    const brume::Lattice grid = brume::grid_over(plume.bounds(), this->Size);
    this->AllocateOutputData(image, info);
    image->GetPointData()->GetScalars()->SetName("density");
    const brume::Extent block = brume::extent_of(image->GetExtent());
    if (block.voxels() == 0)
    {
      return 1;
    }
    const double time = brume::requested_time(info, this->Time);
    image->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    vtkNew<vtkFloatArray> temperatures;
    temperatures->SetName("temperature");
    temperatures->SetNumberOfTuples(static_cast<vtkIdType>(block.voxels()));
    image->GetPointData()->AddArray(temperatures);
    float* density = static_cast<float*>(image->GetScalarPointer());
    float* temperature = temperatures->GetPointer(0);
    const auto row = [&](int j, int k, std::size_t offset)
    {
      for (int i = block.first.x; i <= block.last.x; ++i, ++offset)
      {
        const brume::Plume::State state = plume.at(grid.place(i, j, k), time);
        density[offset] = state.density;
        temperature[offset] = state.temperature;
      }
    };
    if (!brume::for_each_row(block, row, brume::progress_of(this)))
    {
      image->Initialize();
    }
  }
  catch (const std::exception& problem)
  {
    image->Initialize();
    vtkErrorMacro("the smoke could not be made: " << problem.what());
    return 0;
  }
  return 1;
}

void vtkBrumeSmokeSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Size: " << this->Size << " voxels\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "Time: " << this->Time << " s\n";
  os << indent << "StartTime: " << this->StartTime << " s\n";
  os << indent << "EndTime: " << this->EndTime << " s\n";
  os << indent << "NumberOfTimeSteps: " << this->NumberOfTimeSteps << "\n";
  os << indent << "Width: " << this->Width << " m\n";
  os << indent << "Rise: " << this->Rise << " m/s\n";
  os << indent << "AirTemperature: " << this->AirTemperature << " K\n";
  os << indent << "SourceTemperature: " << this->SourceTemperature << " K\n";
}
