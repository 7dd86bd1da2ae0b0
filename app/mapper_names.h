// The mappers that the program can draw with.
#pragma once

#include <string>
#include <vector>

namespace brume::app
{

enum class MapperKind
{
  RayMarch,   ///< vtkBrumeRayMarchMapper
  PathTrace,  ///< vtkBrumePathTraceMapper
  Smart,      ///< vtkBrumeSmartVolumeMapper: one of the two before, by an error or a time
  FixedPoint, ///< vtkFixedPointVolumeRayCastMapper, VTK's own on the CPU
  Gpu,        ///< vtkOpenGLGPUVolumeRayCastMapper, VTK's own on the GPU
};

struct MapperName
{
  MapperKind kind;
  const char* name;       ///< on the command line and in file names
  const char* title;      ///< for people
  const char* class_name; ///< VTK's or Brume's
};

/// Whether it is one of Brume's own, which need no display.
inline bool is_own(MapperKind kind)
{
  return kind == MapperKind::RayMarch || kind == MapperKind::PathTrace || kind == MapperKind::Smart;
}

/// All of them, in the order in which they are shown.
const std::vector<MapperName>& mapper_names();

/// The mapper of that name. Throws Failure (BadCall), listing the names, when there is none;
/// `option` is where the name was given.
const MapperName& find_mapper(const std::string& name, const std::string& option);

/// The names, separated by commas.
std::string list_mapper_names();

}
