// NIfTI-1, NIfTI-2 and Analyze 7.5 headers. The fields and their meaning: R. W. Cox et al.,
// nifti1.h and nifti2.h, NIfTI Data Format Working Group; offsets below are theirs.
#include "scan_header.h"

#include "file_access.h"
#include "image_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>

namespace brume::io
{

namespace
{

/// Numbers at byte offsets of a header, in the file's byte order.
class Fields
{
public:
  Fields(const unsigned char* bytes, bool swap)
    : bytes_(bytes)
    , swap_(swap)
  {
  }
  template <typename T>
  T get(std::size_t offset) const
  {
    unsigned char raw[sizeof(T)];
    std::memcpy(raw, bytes_ + offset, sizeof(T));
    if (swap_)
    {
      std::reverse(raw, raw + sizeof(T));
    }
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }

private:
  const unsigned char* bytes_;
  bool swap_;
};

/// The fields that this reader uses, the same for every version.
struct Nifti
{
  int version = 0; // 0: Analyze 7.5
  bool detached = false;
  std::int64_t dim[8] = {};
  int datatype = 0;
  double pixdim[8] = {};
  double vox_offset = 0;
  double slope = 0;
  double intercept = 0;
  int units = 0;
  double time_offset = 0;
  int qform = 0;
  int sform = 0;
  double quaternion[3] = {};
  double offset[3] = {};
  double rows[12] = {};
  std::string description; // descrip; empty in Analyze
};

template <typename Dim, typename Real>
void take(Nifti& n, const Fields& f, std::size_t dim, std::size_t pixdim)
{
  for (int i = 0; i < 8; ++i)
  {
    n.dim[i] = f.get<Dim>(dim + i * sizeof(Dim));
    n.pixdim[i] = f.get<Real>(pixdim + i * sizeof(Real));
  }
}

template <typename Real>
void take_forms(Nifti& n, const Fields& f, std::size_t quaternion)
{
  for (std::size_t i = 0; i < 3; ++i)
  {
    n.quaternion[i] = f.get<Real>(quaternion + i * sizeof(Real));
    n.offset[i] = f.get<Real>(quaternion + (3 + i) * sizeof(Real));
  }
  for (std::size_t i = 0; i < 12; ++i)
  {
    n.rows[i] = f.get<Real>(quaternion + (6 + i) * sizeof(Real));
  }
}

/// Whether dim[0] is a count of dimensions when read in this byte order.
Nifti parse(const std::string& path, const unsigned char* bytes, std::size_t length, bool& swap)
{
  const char* remedy = "check that it is NIfTI (.nii, .nii.gz, .hdr with .img)";
  if (length < 348)
  {
    fail(path, "holds " + std::to_string(length) + " bytes, fewer than a NIfTI header", remedy);
  }
  const std::int32_t plain = Fields(bytes, false).get<std::int32_t>(0);
  const std::int32_t swapped = Fields(bytes, true).get<std::int32_t>(0);
  swap = plain != 348 && plain != 540;
  const std::int32_t size = swap ? swapped : plain;
  const Fields f(bytes, swap);
  Nifti n;
  if (size == 540)
  {
    if (std::memcmp(bytes + 4, "n+2", 4) != 0 && std::memcmp(bytes + 4, "ni2", 4) != 0)
    {
      fail(path, "is not NIfTI: the header's mark is missing", remedy);
    }
    if (std::memcmp(bytes + 8, "\r\n\032\n", 4) != 0)
    {
      fail(path, "was damaged by a transfer in text mode", "transfer it again as binary");
    }
    if (length < 540)
    {
      fail(path, "the file is cut short within its header", "copy or download it again");
    }
    n.version = 2;
    n.detached = bytes[5] == 'i';
    n.datatype = f.get<std::int16_t>(12);
    take<std::int64_t, double>(n, f, 16, 104);
    n.vox_offset = static_cast<double>(f.get<std::int64_t>(168));
    n.slope = f.get<double>(176);
    n.time_offset = f.get<double>(216);
    n.intercept = f.get<double>(184);
    n.qform = f.get<std::int32_t>(344);
    n.sform = f.get<std::int32_t>(348);
    take_forms<double>(n, f, 352);
    n.units = f.get<std::int32_t>(500);
    const auto* text = reinterpret_cast<const char*>(bytes + 240);
    n.description.assign(text, std::find(text, text + 80, '\0'));
    return n;
  }
  if (size != 348)
  {
    fail(path, "is not NIfTI: it does not begin with a header's length", remedy);
  }
  n.datatype = f.get<std::int16_t>(70);
  take<std::int16_t, float>(n, f, 40, 76);
  n.vox_offset = f.get<float>(108);
  const bool single = std::memcmp(bytes + 344, "n+1", 4) == 0;
  const bool pair = std::memcmp(bytes + 344, "ni1", 4) == 0;
  n.version = single || pair ? 1 : 0;
  n.detached = !single;
  if (n.version == 1)
  {
    n.slope = f.get<float>(112);
    n.intercept = f.get<float>(116);
    n.units = bytes[123];
    const auto* text = reinterpret_cast<const char*>(bytes + 148);
    n.description.assign(text, std::find(text, text + 80, '\0'));
    n.time_offset = f.get<float>(136);
    n.qform = f.get<std::int16_t>(252);
    n.sform = f.get<std::int16_t>(254);
    take_forms<float>(n, f, 256);
  }
  return n;
}

/// The quaternion's rotation times the voxel size, third column times qfac; nifti1.h, method 2.
std::array<double, 12> affine_of_qform(const Nifti& n)
{
  const double b = n.quaternion[0];
  const double c = n.quaternion[1];
  const double d = n.quaternion[2];
  const double rest = 1 - (b * b + c * c + d * d);
  double q[4] = { rest > 0 ? std::sqrt(rest) : 0, b, c, d };
  const double norm = std::sqrt(q[0] * q[0] + b * b + c * c + d * d);
  for (double& v : q)
  {
    v /= norm;
  }
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  const double turn[9] = { w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y),
    2 * (x * y + w * z), w * w + y * y - x * x - z * z, 2 * (y * z - w * x), 2 * (x * z - w * y),
    2 * (y * z + w * x), w * w + z * z - x * x - y * y };
  const double qfac = n.pixdim[0] < 0 ? -1 : 1;
  std::array<double, 12> affine{};
  for (int row = 0; row < 3; ++row)
  {
    affine[4 * row] = turn[3 * row] * n.pixdim[1];
    affine[4 * row + 1] = turn[3 * row + 1] * n.pixdim[2];
    affine[4 * row + 2] = turn[3 * row + 2] * n.pixdim[3] * qfac;
    affine[4 * row + 3] = n.offset[row];
  }
  return affine;
}

/// Whether an affine has three columns of some length, all finite.
bool usable(const double* rows)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double length = std::hypot(rows[axis], rows[4 + axis], rows[8 + axis]);
    if (!(length > 1e-30 && length < 1e30))
    {
      return false;
    }
  }
  return std::isfinite(rows[3]) && std::isfinite(rows[7]) && std::isfinite(rows[11]);
}

void orient(ScanHeader& h, Nifti& n)
{
  for (int axis = 1; axis <= 3; ++axis)
  {
    double& step = n.pixdim[axis];
    if (!std::isfinite(step) || step == 0)
    {
      if (axis <= n.dim[0])
      {
        h.messages.push_back("the header gives no voxel size along axis " + std::to_string(axis) +
          "; 1 is assumed");
      }
      step = 1;
    }
    step = std::abs(step);
  }
  h.affine = { { n.pixdim[1], 0, 0, 0, 0, n.pixdim[2], 0, 0, 0, 0, n.pixdim[3], 0 } };
  if (n.version > 0 && n.sform > 0)
  {
    if (usable(n.rows))
    {
      std::copy(n.rows, n.rows + 12, h.affine.begin());
      h.patient = true;
    }
    else
    {
      h.messages.push_back("the sform holds no usable matrix and is set aside");
    }
  }
  if (n.version > 0 && n.qform > 0 && !h.patient)
  {
    const std::array<double, 12> affine = affine_of_qform(n);
    if (usable(affine.data()))
    {
      h.affine = affine;
      h.patient = true;
    }
    else
    {
      h.messages.push_back("the qform holds no usable rotation and is set aside");
    }
  }
  bool world_axes = false; // not a patient's: Brume's own writer says so in a comment
  std::string length_unit;
  read_mark(n.description, world_axes, length_unit, h.value_unit);
  if (!h.patient)
  {
    h.messages.push_back(
      "the header says nothing of how the patient lies; axes are those of the voxels");
  }
  h.patient = h.patient && !world_axes;
  static const char* const names[4] = { "", "m", "mm", "um" };
  const int unit = n.units & 7;
  if (unit >= 1 && unit <= 3)
  {
    convert_to_millimetres(h, names[unit]);
  }
  else if (!length_unit.empty() || world_axes)
  {
    h.length_unit = length_unit;
  }
  else
  {
    h.length_unit = "mm";
    h.messages.push_back("the header names no unit of length; mm is assumed");
  }
}

/// The other file of a .hdr and .img pair, in the case of the name's own letters, with or without
/// .gz; empty when there is none.
std::string partner(const std::string& path, const char* ending)
{
  namespace fs = std::filesystem;
  fs::path base = path;
  if (base.extension() == ".gz" || base.extension() == ".GZ")
  {
    base.replace_extension();
  }
  std::string upper = ending;
  std::transform(upper.begin(), upper.end(), upper.begin(), ::toupper);
  for (const std::string& name : { std::string(ending), upper })
  {
    for (const char* more : { "", ".gz", ".GZ" })
    {
      fs::path candidate = base;
      candidate.replace_extension(name);
      candidate += more;
      std::error_code error;
      if (fs::exists(candidate, error))
      {
        return candidate.string();
      }
    }
  }
  return {};
}

bool ends_as_img(const std::string& path)
{
  std::string lower = path;
  std::transform(lower.begin(), lower.end(), lower.begin(), ::tolower);
  const auto ends = [&](const std::string& e)
  { return lower.size() >= e.size() && lower.compare(lower.size() - e.size(), e.size(), e) == 0; };
  return ends(".img") || ends(".img.gz");
}

}

ScanHeader read_nifti_header(const std::string& path)
{
  std::string header_path = path;
  if (ends_as_img(path))
  {
    header_path = partner(path, ".hdr");
    if (header_path.empty())
    {
      fail(path, "its header (.hdr) is not beside it", "keep both files in one folder");
    }
  }
  ByteStream stream(path, header_path, 0, ByteStream::Guess);
  unsigned char bytes[540];
  const std::size_t length = stream.read(bytes, sizeof(bytes));
  ScanHeader h;
  h.path = path;
  Nifti n = parse(path, bytes, length, h.swap_bytes);

  const char* remedy = "check that the file is whole, or export the volume again";
  if (n.dim[0] < 1 || n.dim[0] > 7)
  {
    fail(path, "the header gives " + std::to_string(n.dim[0]) + " dimensions", remedy);
  }
  for (int i = static_cast<int>(n.dim[0]) + 1; i < 8; ++i)
  {
    n.dim[i] = 1;
  }
  for (int i = 0; i < 3; ++i)
  {
    h.dimensions[i] = n.dim[i + 1];
  }
  for (int i = 4; i < 8; ++i)
  {
    if (n.dim[i] < 1)
    {
      fail(path,
        "the header gives " + std::to_string(n.dim[i]) + " volumes along dimension " +
          std::to_string(i),
        remedy);
    }
  }

  struct Type
  {
    Scalar scalar;
    int components;
  };
  static const std::map<int, Type> types{ { 2, { Scalar::UInt8, 1 } }, { 4, { Scalar::Int16, 1 } },
    { 8, { Scalar::Int32, 1 } }, { 16, { Scalar::Float32, 1 } }, { 32, { Scalar::Float32, 2 } },
    { 64, { Scalar::Float64, 1 } }, { 128, { Scalar::UInt8, 3 } }, { 256, { Scalar::Int8, 1 } },
    { 512, { Scalar::UInt16, 1 } }, { 768, { Scalar::UInt32, 1 } }, { 1024, { Scalar::Int64, 1 } },
    { 1280, { Scalar::UInt64, 1 } }, { 1792, { Scalar::Float64, 2 } },
    { 2304, { Scalar::UInt8, 4 } } };
  const auto type = types.find(n.datatype);
  if (type == types.end())
  {
    fail(path, "its voxels are of NIfTI type " + std::to_string(n.datatype) +
        ", which Brume does not read", "convert it to integers or to 32-bit floats");
  }
  h.scalar = type->second.scalar;
  h.components = type->second.components;
  if (n.dim[5] > 1)
  {
    if (n.dim[4] == 1 && h.components == 1 && n.dim[5] <= 16)
    {
      h.components = n.dim[5]; // a vector a voxel, one volume for each component
      h.planar = true;
    }
    else
    {
      h.more_follows = true;
      h.messages.push_back("holds " + std::to_string(n.dim[5]) + " components; the first is taken");
    }
  }
  if (n.dim[4] > 1)
  {
    // Bits 3 to 5 of the units: seconds, milliseconds, microseconds; others are no times.
    const int unit = n.units & 0x38;
    const double seconds = unit == 16 ? 1e-3 : unit == 24 ? 1e-6 : 1;
    set_series(h, n.dim[4], n.time_offset * seconds, n.pixdim[4] * seconds,
      unit == 8 || unit == 16 || unit == 24 ? "s" : "");
  }
  if (n.dim[6] > 1 || n.dim[7] > 1)
  {
    h.more_follows = true;
    h.messages.push_back("has more than five dimensions; the first volume is taken");
  }

  DataPart part;
  part.path = header_path;
  if (n.detached)
  {
    part.path = ends_as_img(path) ? path : partner(path, ".img");
    if (part.path.empty())
    {
      fail(path,
        n.version == 0 ? "is not NIfTI: the mark is missing, and no .img with the voxels is beside it"
                       : "the data file (.img) is not there",
        "keep .hdr and .img in one folder");
    }
  }
  const double least = n.detached ? 0 : n.version == 2 ? 544 : 352;
  if (n.vox_offset == 0 && !n.detached)
  {
    n.vox_offset = least;
  }
  if (!(n.vox_offset >= (n.detached ? 0 : least - 4)) || n.vox_offset > 1e15 ||
    n.vox_offset != std::floor(n.vox_offset))
  {
    fail(path, "the header's place of the data (vox_offset) makes no sense", remedy);
  }
  part.offset = static_cast<std::uint64_t>(n.vox_offset);
  const bool deflated = ByteStream(path, part.path, 0, ByteStream::Guess).deflated();
  h.encoding = deflated ? Encoding::Deflated : Encoding::Raw;
  h.offset_is_inflated = deflated;
  h.parts.push_back(part);
  h.format = n.version == 0 ? "Analyze 7.5" : n.version == 1 ? "NIfTI-1" : "NIfTI-2";
  h.format += deflated ? " (gzip)" : "";

  // A slope of 0 means that values are not scaled.
  if (n.version > 0 && n.slope != 0 && std::isfinite(n.slope) && std::isfinite(n.intercept) &&
    type->second.components == 1)
  {
    h.slope = n.slope;
    h.intercept = n.intercept;
  }
  orient(h, n);
  return h;
}

}
