// A dense volume on its way into a file, freed of VTK, and the formats that Brume writes by itself.
// Private to this module.
#pragma once

#include "scan_header.h"
#include "voxel_reader.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace brume
{
class AtomicFile;
}

namespace brume::io
{

struct ImageFile
{
  std::array<std::int64_t, 3> dimensions{ { 0, 0, 0 } }; ///< voxels, x fastest
  int components = 1;                                    ///< numbers a voxel, together
  Scalar scalar = Scalar::Float32;
  const void* voxels = nullptr; ///< in this machine's byte order
  std::string array;            ///< the name of the scalars; may be empty

  /// Index to world, row-major 3 × 4: world = affine · (i, j, k, 1). The columns may be
  /// left-handed.
  std::array<double, 12> affine{ { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 } };
  bool patient = false;    ///< the world is RAS+
  std::string length_unit; ///< "mm", "m", …; empty where unknown
  std::string value_unit;  ///< "HU", …; empty where unknown

  bool compress = false;             ///< where the format leaves the choice
  Progress progress;                 ///< may be empty
  std::vector<std::string> messages; ///< what the format could not hold, one line each

  std::uint64_t values() const;
  std::uint64_t bytes() const;
  /// The lengths of the affine's columns.
  std::array<double, 3> spacing() const;
  /// The affine's columns divided by their lengths, row-major 3 × 3.
  std::array<double, 9> direction() const;
};

// Each writes the whole file beside its place and moves it there (atomic_file.h). Throws
// std::runtime_error, "PATH: what is wrong: what to do", also where `progress` asks to stop, and
// for what the format cannot hold at all; what it can hold in part goes into `messages`.

/// NRRD, raw or gzip. `space` is right-anterior-superior for a patient's volume, else the axes are
/// the world's.
void write_nrrd(ImageFile& image, const std::string& path);
/// MetaImage in one file, raw or deflated; in LPS for a patient's volume, as ITK has it.
void write_meta(ImageFile& image, const std::string& path);
/// NIfTI-1 in one file, gzipped where the path ends in .gz; the affine as sform and qform. NIfTI-2 where
/// an axis is longer than the 32767 voxels that NIfTI-1 holds.
void write_nifti(ImageFile& image, const std::string& path);
/// Raw voxels, and PATH.json that describes them.
void write_raw(ImageFile& image, const std::string& path);
/// A TIFF of one page a slice, deflated or not; spacing and unit as ImageJ has them.
void write_tiff(ImageFile& image, const std::string& path);

// What the above share.

/// What MetaImage and NIfTI have no field for, as words of a comment that Brume's reader knows
/// again (read_mark): "brume: axes=world length=m values=HU"; empty where all of it goes into
/// fields.
std::string write_mark(const ImageFile& image, bool length_fits);
/// Takes the words of such a comment into a header, whose affine is in the file's own axes and
/// units. False where the text is no such comment.
bool read_mark(const std::string& text,
  bool& world_axes,
  std::string& length_unit,
  std::string& value_unit);

/// The number in as few digits as bring it back exactly.
std::string exact(double number);

/// Writes voxels in their order, or, `planar`, component by component; with a gzip stream around
/// them and what `head` holds before them. Reports progress.
void write_plain(AtomicFile& file, const ImageFile& image, bool planar = false);
void write_gzip(AtomicFile& file,
  const ImageFile& image,
  const std::string& head = {},
  bool planar = false);
/// The same as a zlib stream, in memory.
std::string zlib_stream(const ImageFile& image);

}
