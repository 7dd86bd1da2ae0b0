// The pictures of one DICOM series into a volume: which belong together, in which order, and where
// that lies. Private to this module.
#pragma once

#include "dicom_file.h"

namespace brume::io
{

/// The header of a series of pictures whose parts are their pixels, by place along the stack, and by
/// time. `path` is what the user named. Throws fail().
ScanHeader stack_dicom(const std::string& path, const std::vector<DicomFile>& files);

}
