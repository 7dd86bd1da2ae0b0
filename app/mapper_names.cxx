#include "mapper_names.h"

#include "command.h"

namespace brume::app
{

const std::vector<MapperName>& mapper_names()
{
  static const std::vector<MapperName> names{
    { MapperKind::RayMarch, "raymarch", "Brume's ray march", "vtkBrumeRayMarchMapper" },
    { MapperKind::PathTrace, "pathtrace", "Brume's path tracer", "vtkBrumePathTraceMapper" },
    { MapperKind::Smart, "smart", "Brume, by error or time", "vtkBrumeSmartVolumeMapper" },
    { MapperKind::FixedPoint, "vtk-fixed-point", "VTK on the CPU",
      "vtkFixedPointVolumeRayCastMapper" },
    { MapperKind::Gpu, "vtk-gpu", "VTK on the GPU", "vtkOpenGLGPUVolumeRayCastMapper" },
  };
  return names;
}

std::string list_mapper_names()
{
  std::string list;
  for (const MapperName& mapper : mapper_names())
  {
    list += (list.empty() ? "" : ", ") + std::string(mapper.name);
  }
  return list;
}

const MapperName& find_mapper(const std::string& name, const std::string& option)
{
  for (const MapperName& mapper : mapper_names())
  {
    if (name == mapper.name)
    {
      return mapper;
    }
  }
  throw Failure(option + " " + name, "there is no such mapper",
    "take one of " + list_mapper_names(), BadCall);
}

}
