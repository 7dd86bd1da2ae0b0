// What the header of a scan says, freed of the format that says it. The parsers of NIfTI, MetaImage
// and NRRD fill one; the voxel reader and vtkBrumeImageReader consume it. Private to this module.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace brume::io
{

/// The type of one stored number.
enum class Scalar
{
  Int8,
  UInt8,
  Int16,
  UInt16,
  Int32,
  UInt32,
  Int64,
  UInt64,
  Float32,
  Float64
};
/// Bytes of one number of that type: 1 to 8.
int scalar_size(Scalar type);
/// "uint16", "float32": the names of these types in raw sidecars; NRRD's are the same but for "float" and
/// "double".
const char* scalar_name(Scalar type);
/// All of them, in the order above.
inline constexpr Scalar Scalars[] = { Scalar::Int8, Scalar::UInt8, Scalar::Int16, Scalar::UInt16,
  Scalar::Int32, Scalar::UInt32, Scalar::Int64, Scalar::UInt64, Scalar::Float32, Scalar::Float64 };

/// How the numbers lie in the data file.
enum class Encoding
{
  Raw,      ///< binary, as they are
  Deflated, ///< binary in a gzip or zlib stream
  Text,     ///< decimal numbers between blanks
  Dicom,    ///< compressed pictures in DICOM files
  Pictures  ///< pages of picture files
};

class LineReader;

/// One stretch of data: a file and where its numbers begin.
struct DataPart
{
  std::string path;
  std::uint64_t offset = 0; ///< bytes from the file's beginning (into the plain bytes if `inflated_offset`)
  std::uint64_t skip = 0; ///< bytes of stored numbers, once inflated, to pass over from there
  std::uint64_t frame = 0;  ///< of the pictures in a file of Encoding::Dicom or Pictures, which
  std::uint64_t frames = 1; ///< and, of Dicom, how many there are
};

struct ScanHeader
{
  std::string path;   ///< the file as the user named it; errors begin with it
  std::string format; ///< for people: "NIfTI-1 (gzip)", "MetaImage", …
  std::string array = "values"; ///< the name of the scalars

  std::array<std::int64_t, 3> dimensions{ { 0, 0, 0 } }; ///< voxels, x fastest
  std::int64_t components = 1;                           ///< numbers a voxel
  bool planar = false; ///< components lie one volume after another, rather than voxel by voxel
  bool part_planar = false; ///< the same within each slice
  Scalar scalar = Scalar::UInt8;
  int stored_bits = 0; ///< of whole numbers, the lowest that count; 0: all
  bool swap_bytes = false; ///< the file's byte order is not this machine's
  Encoding encoding = Encoding::Raw;
  /// The offset of the data counts inflated bytes (NIfTI: header and data share one gzip stream),
  /// not bytes of the file (NRRD: a plain header, then a gzip stream).
  bool offset_is_inflated = false;
  std::vector<DataPart> parts; ///< one, or several of equal length that follow on each other
  bool more_follows = false;   ///< the stream holds more volumes, which are left unread

  /// The times of a series' volumes, rising by what the format says; one or none: no series. All
  /// else here is of the first volume until select_volume() chooses another.
  std::vector<double> times;
  std::string time_unit; ///< "s"; empty where the format does not say

  /// Voxel index to world, row-major 3 × 4: world = affine · (i, j, k, 1).
  std::array<double, 12> affine{ { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 } };
  /// The world axes are the patient's: x to the right, y to the front, z up (RAS+).
  bool patient = false;

  double slope = 1;         ///< value = slope · stored + intercept
  double intercept = 0;     ///< in units of the value
  /// Slope and intercept of each part (of all volumes), where they are not the same; else empty.
  std::vector<std::array<double, 2>> part_rescale;
  /// Rescaled values are whole and fit into 16 bits, so that they are kept as such; else they become
  /// floats, or doubles where the stored numbers are doubles or integers of 32 bits or more.
  bool values_are_int16 = false;
  std::string length_unit;  ///< "mm", "um", …; empty where the format does not say
  std::string value_unit;   ///< "HU"; empty where the format does not say
  std::vector<std::string> messages; ///< what the reader settled by itself, one line each

  std::uint64_t voxels() const;
  std::uint64_t bytes() const; ///< of the volume that is read: voxels · components · scalar size
};

/// Throws std::runtime_error("PATH: wrong: remedy").
[[noreturn]] void fail(const std::string& path, const std::string& wrong, const std::string& remedy);

/// Checks what every format needs: dimensions from 1 to 2^31 − 1, 1 to 64 components, a total that
/// fits in the address space, and data files that are there and long enough to hold what the header
/// promises (deflate packs at most 1032 : 1, a number in text takes two bytes). Throws as fail()
/// does; nothing of the volume's size has been allocated before it returns.
void check_header(const ScanHeader& header);

/// Makes a header one of a series of `count` volumes, at start, start + step, … A step that is 0 or
/// not finite counts as 1 and a start that is not finite as 0, without a unit. Throws fail() for more
/// than 1,000,000 volumes.
void set_series(
  ScanHeader& header, std::int64_t count, double start, double step, const std::string& unit);

/// What set_series() cannot know: leaves out the volumes that the file is too short for, and says so.
/// For a header that check_header() has passed.
void check_series(ScanHeader& header);

/// The header of one volume of a series: its data follow those of the volumes before it in the one
/// file, or are the next of several files. To be checked again by check_header().
ScanHeader select_volume(const ScanHeader& header, std::size_t index);

/// Brings a length unit to millimetres in the affine of a header that carries patient axes, so that
/// the world of a scan is always RAS+ in mm. `unit` may be um, mm, cm, m (and their long names);
/// any other is kept and named in a message.
void convert_to_millimetres(ScanHeader& header, const std::string& unit);

/// Each throws std::runtime_error as fail() does when the file is not what its format asks for.
ScanHeader read_nifti_header(const std::string& path);
ScanHeader read_meta_header(const std::string& path);
ScanHeader read_nrrd_header(const std::string& path);

/// Adds the files that `data` of a header names, each read from the byte `skip` on: one name, a
/// pattern with its numbers (expand_pattern), or, for a `list`, the header's remaining lines. Throws
/// as the readers of headers do where they hold more volumes than one.
void add_data_files(const std::string& path, LineReader& lines, const std::string& data, bool list,
  std::uint64_t skip, ScanHeader& header);

/// Legacy VTK structured points with one array of SCALARS right behind the header, as nearly every
/// writer makes them: VTK 9.1 fills what such a file lacks with whatever memory holds, and says
/// nothing. Returns a header without parts for other layouts (fields, colour scalars, bits), which
/// are left to VTK's reader once their dimensions have been checked.
ScanHeader read_legacy_header(const std::string& path);

}
