#include "vtkBrumeSmokeSource.h"

#include "vtkBrumeSourceTools.h"

#include "data-generators/plume.h"

#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

#include <cstdint>

vtkStandardNewMacro(vtkBrumeSmokeSource);

vtkBrumeSmokeSource::vtkBrumeSmokeSource()
{
  this->EndTime = 10.0;
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

std::shared_ptr<const brume::Field> vtkBrumeSmokeSource::MakeField()
{
  auto plume = std::make_shared<const brume::Plume>(this->GetOptions());
  if (this->IsTemperature())
  {
    return std::make_shared<const brume::PlumeTemperature>(plume);
  }
  return plume;
}

bool vtkBrumeSmokeSource::IsTemperature() const
{
  return this->Sparse && this->SparseQuantity == Temperature;
}

const char* vtkBrumeSmokeSource::GetFieldName() const
{
  return this->IsTemperature() ? "temperature" : "density";
}

float vtkBrumeSmokeSource::GetFieldBackground() const
{
  return this->IsTemperature() ? static_cast<float>(this->AirTemperature) : 0.0f;
}

bool vtkBrumeSmokeSource::FillImage(vtkImageData* image,
  const brume::Field& field,
  const brume::Lattice& grid,
  double time)
{
  const auto& plume = static_cast<const brume::Plume&>(field); // dense: never the temperature alone
  const brume::Extent block = brume::extent_of(image->GetExtent());
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
  return brume::for_each_row(block, row, brume::progress_of(this));
}

void vtkBrumeSmokeSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Width: " << this->Width << " m\n";
  os << indent << "Rise: " << this->Rise << " m/s\n";
  os << indent << "AirTemperature: " << this->AirTemperature << " K\n";
  os << indent << "SourceTemperature: " << this->SourceTemperature << " K\n";
  os << indent
     << "SparseQuantity: " << (this->SparseQuantity == Density ? "Density" : "Temperature") << "\n";
}
