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
  Dicom ///< a file, or a folder with any
};

/// Finds the format in the content; throws fail() when it is none of these, with a remedy that
/// fits what the content or the name suggests.
Format find_format(const std::string& path);

}
