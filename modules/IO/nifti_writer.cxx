// NIfTI in one file: NIfTI-1, or NIfTI-2 for what NIfTI-1's 16-bit counts do not hold. The fields: R. W.
// Cox et al., nifti1.h and nifti2.h, NIfTI Data Format Working Group; offsets below are theirs.
#include "image_file.h"

#include "atomic_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace brume::io
{

namespace
{

/// The header's 348 or 540 bytes, the four of "no extension" behind them: voxels begin at 352 or 544.
/// Each field is given by its place in NIfTI-1 and in NIfTI-2.
class Header
{
public:
  explicit Header(bool second)
    : second_(second)
    , bytes_(second ? 544 : 352, '\0')
  {
  }
  std::size_t size() const { return bytes_.size(); }
  /// The i-th of real numbers in a row.
  void real(std::size_t first, std::size_t second, std::size_t i, double value)
  {
    second_ ? put(second + 8 * i, value) : put(first + 4 * i, static_cast<float>(value));
  }
  /// The i-th of counts in a row.
  void count(std::size_t first, std::size_t second, std::size_t i, std::int64_t value)
  {
    second_ ? put(second + 8 * i, value) : put(first + 2 * i, static_cast<std::int16_t>(value));
  }
  /// A code: 16 bits in NIfTI-1, 32 in NIfTI-2.
  void code(std::size_t first, std::size_t second, std::int32_t value)
  {
    second_ ? put(second, value) : put(first, static_cast<std::int16_t>(value));
  }
  template <class T>
  void put(std::size_t offset, T value)
  {
    std::memcpy(&bytes_[offset], &value, sizeof(T));
  }
  void put(std::size_t offset, const std::string& text, std::size_t room)
  {
    std::memcpy(&bytes_[offset], text.data(), std::min(text.size(), room - 1));
  }
  const std::string& bytes() const { return bytes_; }

private:
  bool second_;
  std::string bytes_;
};

std::int16_t type_code(Scalar scalar)
{
  switch (scalar)
  {
    case Scalar::UInt8:
      return 2;
    case Scalar::Int16:
      return 4;
    case Scalar::Int32:
      return 8;
    case Scalar::Float32:
      return 16;
    case Scalar::Float64:
      return 64;
    case Scalar::Int8:
      return 256;
    case Scalar::UInt16:
      return 512;
    case Scalar::UInt32:
      return 768;
    case Scalar::Int64:
      return 1024;
    case Scalar::UInt64:
      return 1280;
  }
  return 0;
}

double determinant(const std::array<double, 9>& m)
{
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
         m[2] * (m[3] * m[7] - m[4] * m[6]);
}

/// The unit quaternion (w, x, y, z), w >= 0, of a rotation: the largest of its four components
/// comes first, so that no other is divided by a small number (S. W. Shepperd, "Quaternion from
/// rotation matrix", J. Guidance and Control 1, 1978).
std::array<double, 4> quaternion(const std::array<double, 9>& m)
{
  const double squares[4] = {
    1 + m[0] + m[4] + m[8], 1 + m[0] - m[4] - m[8], 1 - m[0] + m[4] - m[8], 1 - m[0] - m[4] + m[8]
  };
  const int largest = static_cast<int>(std::max_element(squares, squares + 4) - squares);
  const double sums[3] = { m[3] + m[1], m[6] + m[2], m[7] + m[5] };  // 4xy, 4xz, 4yz
  const double turns[3] = { m[7] - m[5], m[2] - m[6], m[3] - m[1] }; // 4wx, 4wy, 4wz
  std::array<double, 4> q;
  switch (largest)
  {
    case 0:
      q = { { squares[0], turns[0], turns[1], turns[2] } };
      break;
    case 1:
      q = { { turns[0], squares[1], sums[0], sums[1] } };
      break;
    case 2:
      q = { { turns[1], sums[0], squares[2], sums[2] } };
      break;
    default:
      q = { { turns[2], sums[1], sums[2], squares[3] } };
  }
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& v : q)
  {
    v = (q[0] < 0 ? -v : v) / norm;
  }
  return q;
}

bool ends_with_gz(const std::string& path)
{
  return path.size() > 3 && (path.compare(path.size() - 3, 3, ".gz") == 0 ||
                              path.compare(path.size() - 3, 3, ".GZ") == 0);
}

}

void write_nifti(ImageFile& image, const std::string& path)
{
  const bool second =
    *std::max_element(image.dimensions.begin(), image.dimensions.end()) > 32767;
  if (image.components > 16)
  {
    fail(path,
      "it would have " + std::to_string(image.components) +
        " components, and Brume reads up to 16 of NIfTI",
      "write .nrrd, .mha or .vti");
  }
  Header h(second);
  h.put<std::int32_t>(0, second ? 540 : 348);
  if (second)
  {
    h.put(4, std::string("n+2\0\r\n\032\n", 8), 9);
  }
  else
  {
    h.put<char>(38, 'r'); // "regular", for Analyze
    h.put(344, std::string("n+1"), 4);
  }
  const bool several = image.components > 1;
  const std::int64_t dim[8] = { several ? 5 : 3,
    image.dimensions[0],
    image.dimensions[1],
    image.dimensions[2],
    1,
    image.components,
    1,
    1 };
  const std::array<double, 3> spacing = image.spacing();
  std::array<double, 9> turn = image.direction();
  const bool left = determinant(turn) < 0;
  if (left)
  {
    for (int row = 0; row < 3; ++row)
    {
      turn[3 * row + 2] = -turn[3 * row + 2]; // and qfac = −1 turns it back
    }
  }
  const double pixdim[8] = {
    left ? -1.0 : 1.0, spacing[0], spacing[1], spacing[2], 1.0, 1.0, 1.0, 1.0
  };
  for (std::size_t i = 0; i < 8; ++i)
  {
    h.count(40, 16, i, dim[i]);
    h.real(76, 104, i, pixdim[i]);
  }
  h.code(68, 504, several ? 1007 : 0); // a vector a voxel
  h.put(second ? 12 : 70, type_code(image.scalar));
  h.put(second ? 14 : 72, static_cast<std::int16_t>(8 * scalar_size(image.scalar)));
  second ? h.put<std::int64_t>(168, 544) : h.put<float>(108, 352); // where voxels begin
  h.real(112, 176, 0, 1.0);                                        // slope
  const std::string& unit = image.length_unit;
  const char code = unit == "m" ? 1 : unit == "mm" ? 2 : unit == "um" ? 3 : 0;
  second ? h.put<std::int32_t>(500, code) : h.put<char>(123, code);
  h.put(second ? 240 : 148, write_mark(image, code != 0), 80);

  // The same transform twice: readers differ in which they take.
  const int kind = image.patient ? 1 : 2; // scanner's axes; other ones, which the mark tells
  h.code(252, 344, kind);
  h.code(254, 348, kind);
  const std::array<double, 4> q = quaternion(turn);
  for (std::size_t i = 0; i < 3; ++i)
  {
    h.real(256, 352, i, q[1 + i]);
    h.real(268, 376, i, image.affine[4 * i + 3]);
  }
  bool rounded = false;
  for (std::size_t i = 0; i < 12; ++i)
  {
    h.real(280, 400, i, image.affine[i]);
    rounded =
      rounded || static_cast<double>(static_cast<float>(image.affine[i])) != image.affine[i];
  }

  if (second)
  {
    image.messages.push_back("an axis has more than 32767 voxels, which NIfTI-1 does not hold: it is "
                             "NIfTI-2, which not every program reads");
  }
  if (rounded && !second)
  {
    image.messages.push_back("NIfTI-1 holds spacing, origin and direction in single precision: "
                             "they are rounded to seven digits");
  }
  if (code == 0 && !unit.empty())
  {
    image.messages.push_back("NIfTI knows m, mm and um: the unit of length, " + unit +
                             ", is in a comment that Brume alone reads");
  }
  if (!image.patient)
  {
    image.messages.push_back(
      "NIfTI's axes are a patient's: that these are not is in a comment that "
      "Brume alone reads");
  }
  if (!image.value_unit.empty())
  {
    image.messages.push_back("NIfTI has no field for the unit of the values: " + image.value_unit +
                             " is in a comment that Brume alone reads");
  }

  AtomicFile file(path);
  if (ends_with_gz(path))
  {
    write_gzip(file, image, h.bytes(), several);
  }
  else
  {
    file.write(h.bytes().data(), h.bytes().size());
    write_plain(file, image, several);
  }
  file.commit();
}

}
