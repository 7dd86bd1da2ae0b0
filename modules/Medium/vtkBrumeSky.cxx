#include "vtkBrumeSky.h"

#include "checked_values.h"

#include "Transport/environment.h"
#include "Transport/scene.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"

#include <glm/geometric.hpp>

#include <array>
#include <utility>

vtkStandardNewMacro(vtkBrumeSky);

struct vtkBrumeSky::Internals
{
  vtkSmartPointer<vtkImageData> Map;
  std::vector<brume::Light> Lights; ///< of the map
  std::shared_ptr<const brume::PlacedEnvironment> Placed; ///< the map; null: none that is usable
  std::string Wrong;                ///< with the map
  vtkMTimeType LightsTime = 0;      ///< when they were made; 0: never
};

vtkBrumeSky::vtkBrumeSky()
  : Internal(std::make_unique<Internals>())
{
}

vtkBrumeSky::~vtkBrumeSky() = default;

void vtkBrumeSky::SetSkyRadiance(double red, double green, double blue)
{
  brume::set_values(
    this, "SkyRadiance", this->SkyRadiance, { red, green, blue }, 0.0, VTK_DOUBLE_MAX);
}

void vtkBrumeSky::SetGroundRadiance(double red, double green, double blue)
{
  brume::set_values(
    this, "GroundRadiance", this->GroundRadiance, { red, green, blue }, 0.0, VTK_DOUBLE_MAX);
}

void vtkBrumeSky::SetUp(double x, double y, double z)
{
  const double largest = std::max({ std::abs(x), std::abs(y), std::abs(z) });
  if (largest == 0.0)
  {
    vtkWarningMacro("Up must not be a vector of length 0; kept: "
                    << this->Up[0] << ' ' << this->Up[1] << ' ' << this->Up[2] << '.');
    return;
  }
  // Scaled first, so that no square is too large or too small; not where a component is not finite.
  const double scale = std::isfinite(largest) ? largest : 1.0;
  const glm::dvec3 up = glm::dvec3(x, y, z) / scale;
  const double length = std::isfinite(largest) ? glm::length(up) : 1.0;
  brume::set_values(
    this, "Up", this->Up, { up.x / length, up.y / length, up.z / length }, -1.0, 1.0);
}

void vtkBrumeSky::SetEnvironmentMap(vtkImageData* map)
{
  if (this->Internal->Map != map)
  {
    this->Internal->Map = map;
    this->Modified();
  }
}

vtkImageData* vtkBrumeSky::GetEnvironmentMap()
{
  return this->Internal->Map;
}

void vtkBrumeSky::SetEnvironmentRotation(double degrees)
{
  brume::set_value(this,
    "EnvironmentRotation",
    this->EnvironmentRotation,
    degrees,
    -VTK_DOUBLE_MAX,
    VTK_DOUBLE_MAX);
}

vtkMTimeType vtkBrumeSky::GetMTime()
{
  vtkMTimeType time = this->Superclass::GetMTime();
  if (vtkImageData* map = this->Internal->Map)
  {
    time = std::max(time, map->GetMTime());
    if (vtkDataArray* pixels = map->GetPointData()->GetScalars())
    {
      time = std::max(time, pixels->GetMTime());
    }
  }
  return time;
}

void vtkBrumeSky::FillSky(brume::Sky& sky) const
{
  const auto vector = [](const double(&v)[3]) { return glm::dvec3(v[0], v[1], v[2]); };
  sky.radiance = vector(this->SkyRadiance);
  sky.ground = vector(this->GroundRadiance);
  sky.up = vector(this->Up);
}

std::string vtkBrumeSky::AppendEnvironmentLights(std::vector<brume::Light>& lights)
{
  Internals& self = *this->Internal;
  if (!self.Map)
  {
    return {};
  }
  const vtkMTimeType time = this->GetMTime();
  if (time != self.LightsTime)
  {
    self.Lights.clear();
    self.Wrong.clear();
    self.Placed = nullptr;
    self.LightsTime = time;
    int dims[3];
    self.Map->GetDimensions(dims);
    vtkDataArray* pixels = self.Map->GetPointData()->GetScalars();
    const vtkIdType count = static_cast<vtkIdType>(dims[0]) * dims[1];
    if (!pixels || pixels->GetNumberOfComponents() < 3 || dims[2] != 1 || count < 1 ||
        pixels->GetNumberOfTuples() != count)
    {
      self.Wrong = "the environment map is not a picture: set one with "
                   "vtkBrumeSky::SetEnvironmentMap that has one slice and point scalars of R, G, B";
    }
    else
    {
      auto placed = std::make_shared<brume::PlacedEnvironment>();
      brume::EnvironmentMap& map = placed->map;
      map.width = dims[0];
      map.height = dims[1];
      map.rgb.resize(3 * static_cast<std::size_t>(count));
      for (vtkIdType i = 0; i < count; ++i)
      {
        for (int c = 0; c < 3; ++c)
        {
          map.rgb[3 * i + c] = static_cast<float>(pixels->GetComponent(i, c));
        }
      }
      const glm::dvec3 up(this->Up[0], this->Up[1], this->Up[2]);
      placed->world_from_map = brume::world_from_environment(up, this->EnvironmentRotation);
      self.Lights = brume::environment_lights(
        map, this->NumberOfEnvironmentLights, placed->world_from_map);
      self.Placed = std::move(placed);
    }
  }
  lights.insert(lights.end(), self.Lights.begin(), self.Lights.end());
  return self.Wrong;
}

std::shared_ptr<const brume::PlacedEnvironment> vtkBrumeSky::TakeEnvironment(
  std::vector<brume::Light>& lights)
{
  const Internals& self = *this->Internal;
  if (!self.Map || !self.Placed || lights.size() < self.Lights.size())
  {
    return nullptr;
  }
  lights.erase(lights.end() - static_cast<std::ptrdiff_t>(self.Lights.size()), lights.end());
  return self.Placed;
}

void vtkBrumeSky::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto vector = [&](const char* name, const double(&v)[3])
  { os << indent << name << ": " << v[0] << ' ' << v[1] << ' ' << v[2] << '\n'; };
  vector("SkyRadiance", this->SkyRadiance);
  vector("GroundRadiance", this->GroundRadiance);
  vector("Up", this->Up);
  os << indent << "EnvironmentMap: ";
  if (vtkImageData* map = this->Internal->Map)
  {
    os << map->GetDimensions()[0] << " x " << map->GetDimensions()[1] << " pixels\n";
  }
  else
  {
    os << "(none)\n";
  }
  os << indent << "EnvironmentRotation: " << this->EnvironmentRotation << '\n';
  os << indent << "NumberOfEnvironmentLights: " << this->NumberOfEnvironmentLights << '\n';
}
