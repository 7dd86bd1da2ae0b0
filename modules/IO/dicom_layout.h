// Where things lie in a DICOM file, found without a parser of others: lengths and nesting are checked
// here before vtk-dicom and GDCM, which believe them, are called. Private to this module.
// The encoding: DICOM PS3.5 (data structures) section 7, PS3.10 (files) section 7.
#pragma once

#include <cstdint>
#include <string>

namespace brume::io
{

struct DicomLayout
{
  std::string transfer_syntax; ///< a UID, "1.2.840.10008.1.2.1"
  bool big_endian = false;     ///< of the data set and its pixels
  bool encapsulated = false;   ///< pixels are compressed, in fragments
  std::uint64_t pixel_offset = 0; ///< of the first pixel or of the first fragment's item; 0: none
  std::uint64_t pixel_length = 0; ///< bytes of pixels; of fragments with their heads
  std::uint64_t fragments = 0;    ///< behind the table of offsets
  std::uint16_t pixel_element = 0; ///< 0x0010 integers, 0x0008 floats, 0x0009 doubles
};

/// Whether the file begins as DICOM files do, with "DICM" behind 128 bytes. Throws nothing.
bool looks_like_dicom(const std::string& path);

/// Walks a file up to the end of its pixels. Throws fail() where an element is longer than what is
/// around it or than the file, where sequences nest deeper than 16, and for a deflated data set.
DicomLayout dicom_layout(const std::string& path);

/// "JPEG 2000" of a transfer syntax; its UID where it has no name here.
std::string syntax_name(const std::string& uid);

}
