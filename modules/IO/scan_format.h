// Which format a file is of. Private to this module.
#pragma once

#include <string>

namespace brume::io
{

enum class Format
{
  Nifti,
  MetaImage,
  Nrrd,
  Vti,
  LegacyVtk,
  Dicom, ///< a file, or a folder with any
  Pictures, ///< TIFF or PNG, or a folder with any
  Raw ///< voxels with a sidecar, or the sidecar
};

/// Finds the format in the content; throws fail() when it is none of these, with a remedy that
/// fits what the content or the name suggests.
Format find_format(const std::string& path);

}
