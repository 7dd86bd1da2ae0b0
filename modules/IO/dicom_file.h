// What one DICOM file says of its pictures, through vtk-dicom. Private to this module.
#pragma once

#include "dicom_layout.h"
#include "scan_header.h"

#include <array>
#include <string>
#include <vector>

namespace brume::io
{

/// One picture of a file; the only one, or a frame of an enhanced object.
struct DicomFrame
{
  bool placed = false; ///< position and orientation are there, and are numbers
  std::array<double, 3> position{ { 0, 0, 0 } };             ///< of the first pixel, LPS+, mm
  std::array<double, 6> rows{ { 1, 0, 0, 0, 1, 0 } };        ///< along a row, then along a column
  std::array<double, 2> pixel{ { 1, 1 } };                   ///< mm along a row, along a column
  double between = 0;  ///< mm from slice to slice as the header has it; 0: not told
  double slope = 1;
  double intercept = 0;
  /// What may tell the volumes of a series over time apart, in the order of preference; NaN: not there.
  /// Temporal position (a count), trigger time, acquisition time, content time (seconds).
  std::array<double, 4> times{};
};

struct DicomFile
{
  std::string path;
  DicomLayout layout;
  std::string series_uid;
  std::string instance_uid;
  std::string description; ///< of the series
  std::string modality;    ///< "CT"
  int series_number = 0;
  int instance_number = 0;
  std::int64_t width = 0;
  std::int64_t height = 0;
  int components = 1;
  bool planar = false;
  Scalar scalar = Scalar::UInt16;
  int bits = 16; ///< of each number that count, from the lowest on
  double temporal_resolution = 0; ///< ms between temporal positions; 0: not told
  std::string value_unit; ///< that the file names: "Gy" of a dose; else empty
  /// The file's frames have no places of their own, nor offsets: they are set one `between` apart.
  bool spread = false;
  std::vector<DicomFrame> frames;

  std::uint64_t frame_bytes() const;
};

/// Reads everything but the pixels. Throws fail() for a file that is damaged, that has no pictures, or
/// whose pictures are of a kind that Brume does not read.
DicomFile read_dicom_file(const std::string& path);

}
