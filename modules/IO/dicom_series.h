// From files of DICOM to one volume or a series of volumes over time. Private to this module.
#pragma once

#include "scan_header.h"

#include <string>
#include <vector>

namespace brume::io
{

/// A series of a folder, for people to choose from.
struct DicomChoice
{
  std::string uid;
  std::string text; ///< "CT, Head 5.0, 512 x 512 x 40"
};

/// Whether a folder, or one below it, holds a DICOM file.
bool has_dicom(const std::string& folder);

/// The header of a DICOM file or of a folder with all that is below it: files are found by their
/// content, slices sorted by their place, volumes by their time. `series` is a number from 1 on in
/// the list of `choices`, or a UID; empty takes the only one. `choices` is filled in any case.
/// Throws fail() where there is none, several and none is named, and for what cannot be read.
ScanHeader read_dicom_header(
  const std::string& path, const std::string& series, std::vector<DicomChoice>& choices);

}
