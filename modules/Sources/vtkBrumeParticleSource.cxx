#include "vtkBrumeParticleSource.h"

#include "vtkBrumeSourceTools.h"

#include "data-generators/particles.h"
#include "data-generators/portable_math.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

#include <cstdint>
#include <exception>
#include <stdexcept>
#include <vector>

vtkStandardNewMacro(vtkBrumeParticleSource);

struct vtkBrumeParticleSource::Moment
{
  double Time = 0.0;
  vtkMTimeType SettingsTime = 0; // the source's time of change when they were made
  std::vector<brume::Particle> Particles;
};

vtkBrumeParticleSource::vtkBrumeParticleSource()
{
  this->SetNumberOfInputPorts(0);
}

vtkBrumeParticleSource::~vtkBrumeParticleSource() = default;

brume::ParticleCloudOptions vtkBrumeParticleSource::GetOptions() const
{
  brume::ParticleCloudOptions options;
  options.seed = static_cast<std::uint32_t>(this->Seed);
  options.emitters.clear();
  for (int n = 0; n < this->NumberOfEmitters; ++n)
  {
    brume::Emitter emitter;
    const brume::SineCosine turn =
      brume::portable_sincos(2.0 * brume::pi * n / this->NumberOfEmitters);
    const double ring = this->NumberOfEmitters > 1 ? 0.25 * this->Width : 0.0;
    emitter.place = { ring * turn.cosine, ring * turn.sine, 0.1 * this->Width };
    emitter.radius = this->EmitterRadius;
    emitter.velocity = { 0.0, 0.0, this->Speed };
    emitter.spread = this->Spread;
    emitter.rate = this->Rate;
    options.emitters.push_back(emitter);
  }
  options.flow.seed = options.seed;
  options.flow.wind = { this->Wind[0], this->Wind[1], this->Wind[2] };
  options.flow.turbulence = this->Turbulence;
  options.flow.eddy_size = this->EddySize;
  options.rise = this->Rise;
  options.response = this->Response;
  options.life = this->Life;
  options.radius = this->ParticleRadius;
  options.growth = this->Growth;
  options.density = this->Density;
  return options;
}

namespace
{

brume::Lattice grid_of(double width, int size)
{
  return brume::grid_over(
    { { -0.5 * width, -0.5 * width, 0.0 }, { 0.5 * width, 0.5 * width, width } }, size);
}

}

int vtkBrumeParticleSource::RequestInformation(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  brume::describe_grid(grid_of(this->Width, this->Size), VTK_FLOAT, info);
  brume::describe_time(this->StartTime, this->EndTime, this->NumberOfTimeSteps, info);
  return 1;
}

int vtkBrumeParticleSource::RequestData(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  vtkImageData* image = vtkImageData::GetData(info);
  try
  {
    const double time = brume::requested_time(info, this->Time);
    if (!this->Kept || this->Kept->SettingsTime != this->GetMTime() || this->Kept->Time != time)
    {
      auto moment = std::make_unique<Moment>();
      moment->Particles = brume::ParticleCloud(this->GetOptions()).particles(time);
      moment->Time = time;
      moment->SettingsTime = this->GetMTime();
      this->Kept = std::move(moment);
    }
    this->AllocateOutputData(image, info);
    image->GetPointData()->GetScalars()->SetName("density");
    image->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    const brume::Extent block = brume::extent_of(image->GetExtent());
    if (block.voxels() > 0 && !brume::deposit(this->Kept->Particles,
                                grid_of(this->Width, this->Size),
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
    vtkErrorMacro("the particles could not be made: " << problem.what());
    return 0;
  }
  return 1;
}

void vtkBrumeParticleSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Size: " << this->Size << " voxels\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "Time: " << this->Time << " s\n";
  os << indent << "StartTime: " << this->StartTime << " s\n";
  os << indent << "EndTime: " << this->EndTime << " s\n";
  os << indent << "NumberOfTimeSteps: " << this->NumberOfTimeSteps << "\n";
  os << indent << "Width: " << this->Width << " m\n";
  os << indent << "NumberOfEmitters: " << this->NumberOfEmitters << "\n";
  os << indent << "EmitterRadius: " << this->EmitterRadius << " m\n";
  os << indent << "Rate: " << this->Rate << " /s\n";
  os << indent << "Speed: " << this->Speed << " m/s\n";
  os << indent << "Spread: " << this->Spread << " m/s\n";
  os << indent << "Life: " << this->Life << " s\n";
  os << indent << "ParticleRadius: " << this->ParticleRadius << " m\n";
  os << indent << "Growth: " << this->Growth << " m/s\n";
  os << indent << "Density: " << this->Density << "\n";
  os << indent << "Wind: " << this->Wind[0] << " " << this->Wind[1] << " " << this->Wind[2]
     << " m/s\n";
  os << indent << "Rise: " << this->Rise << " m/s\n";
  os << indent << "Response: " << this->Response << " s\n";
  os << indent << "Turbulence: " << this->Turbulence << " m/s\n";
  os << indent << "EddySize: " << this->EddySize << " m\n";
}
