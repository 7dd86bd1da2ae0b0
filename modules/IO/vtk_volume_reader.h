// VTK's own formats, through VTK's own readers in a process of its own (guarded_process.h), with their
// errors caught and what they do not check checked. Private to this module.
#pragma once

#include "voxel_reader.h"

#include "vtkSmartPointer.h"

class vtkImageData;

namespace brume::io
{

struct VtkVolume
{
  vtkSmartPointer<vtkImageData> image; ///< with scalars on its points, as many as it has points
  std::string format;
  std::vector<std::string> messages;
  std::string length_unit;   ///< of a VTI that says so in its field data (vtkBrumeImageWriter)
  std::string value_unit;    ///< likewise
  bool patient_axes = false; ///< likewise
};

/// VTK XML image data (.vti) whose arrays take no more than `limit` bytes (memory_limit.h). Throws
/// fail().
VtkVolume read_vti(const std::string& path, std::uint64_t limit, const Progress& progress);
/// Legacy VTK structured points (.vtk) of the layouts that read_legacy_header() leaves to VTK. Throws
/// fail().
VtkVolume read_legacy(const std::string& path, std::uint64_t limit, const Progress& progress);

}
