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

vtkBrumeParticleSource::vtkBrumeParticleSource()
{
  this->Size = 128;
  this->EndTime = 10.0;
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
    emitter.start = -this->WarmUp;
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

std::shared_ptr<const brume::Field> vtkBrumeParticleSource::MakeField()
{
  const double half = 0.5 * this->Width;
  return std::make_shared<brume::ParticleField>(this->GetOptions(),
    brume::Box{ { -half, -half, 0.0 }, { half, half, this->Width } },
    1.5 * (this->Width / this->Size));
}

bool vtkBrumeParticleSource::Prepare(const brume::Field& field, double time)
{
  return static_cast<const brume::ParticleField&>(field).prepare(
    time, brume::progress_of(this, 0.0, this->GetPreparedShare()));
}

double vtkBrumeParticleSource::GetPreparedShare() const
{
  return 0.5;
}

bool vtkBrumeParticleSource::FillImage(vtkImageData* image,
  const brume::Field& field,
  const brume::Lattice& grid,
  double time)
{
  // The same voxels as by the field, gathered faster.
  return brume::deposit(*static_cast<const brume::ParticleField&>(field).particles(time),
    grid,
    brume::extent_of(image->GetExtent()),
    static_cast<float*>(image->GetScalarPointer()),
    brume::progress_of(this, this->GetPreparedShare()));
}

void vtkBrumeParticleSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Width: " << this->Width << " m\n";
  os << indent << "NumberOfEmitters: " << this->NumberOfEmitters << "\n";
  os << indent << "EmitterRadius: " << this->EmitterRadius << " m\n";
  os << indent << "Rate: " << this->Rate << " /s\n";
  os << indent << "Speed: " << this->Speed << " m/s\n";
  os << indent << "Spread: " << this->Spread << " m/s\n";
  os << indent << "WarmUp: " << this->WarmUp << " s\n";
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
