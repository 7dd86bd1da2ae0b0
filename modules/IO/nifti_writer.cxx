// NIfTI-1 in one file. The fields: R. W. Cox et al., nifti1.h, NIfTI Data Format Working Group.
#include "image_file.h"

#include "atomic_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace brume::io
{

namespace
{

/// The header's 348 bytes, the four of "no extension" behind them: voxels begin at 352.
class Header
{
public:
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
  std::string bytes_ = std::string(352, '\0');
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
  for (int axis = 0; axis < 3; ++axis)
  {
    if (image.dimensions[axis] > 32767)
    {
      fail(path,
        "NIfTI-1 holds 32767 voxels along an axis, and the volume has " +
          std::to_string(image.dimensions[axis]),
        "write .nrrd, .mha or .vti");
    }
  }
  if (image.components > 16)
  {
    fail(path,
      "it would have " + std::to_string(image.components) +
        " components, and Brume reads up to 16 of NIfTI",
      "write .nrrd, .mha or .vti");
  }
  Header h;
  h.put<std::int32_t>(0, 348);
  h.put<char>(38, 'r'); // "regular", for Analyze
  const bool several = image.components > 1;
  const std::int16_t dim[8] = { static_cast<std::int16_t>(several ? 5 : 3),
    static_cast<std::int16_t>(image.dimensions[0]),
    static_cast<std::int16_t>(image.dimensions[1]),
    static_cast<std::int16_t>(image.dimensions[2]),
    1,
    static_cast<std::int16_t>(image.components),
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
  const float pixdim[8] = { left ? -1.f : 1.f,
    static_cast<float>(spacing[0]),
    static_cast<float>(spacing[1]),
    static_cast<float>(spacing[2]),
    1,
    1,
    1,
    1 };
  for (std::size_t i = 0; i < 8; ++i)
  {
    h.put(40 + 2 * i, dim[i]);
    h.put(76 + 4 * i, pixdim[i]);
  }
  h.put<std::int16_t>(68, several ? 1007 : 0); // a vector a voxel
  h.put(70, type_code(image.scalar));
  h.put(72, static_cast<std::int16_t>(8 * scalar_size(image.scalar)));
  h.put<float>(108, 352);
  h.put<float>(112, 1); // slope
  const std::string& unit = image.length_unit;
  const char code = unit == "m" ? 1 : unit == "mm" ? 2 : unit == "um" ? 3 : 0;
  h.put<char>(123, code);
  h.put(148, write_mark(image, code != 0), 80);

  // The same transform twice: readers differ in which they take.
  const std::int16_t kind =
    image.patient ? 1 : 2; // scanner's axes; other ones, which the mark tells
  h.put(252, kind);
  h.put(254, kind);
  const std::array<double, 4> q = quaternion(turn);
  for (std::size_t i = 0; i < 3; ++i)
  {
    h.put(256 + 4 * i, static_cast<float>(q[1 + i]));
    h.put(268 + 4 * i, static_cast<float>(image.affine[4 * i + 3]));
  }
  bool rounded = false;
  for (std::size_t i = 0; i < 12; ++i)
  {
    h.put(280 + 4 * i, static_cast<float>(image.affine[i]));
    rounded =
      rounded || static_cast<double>(static_cast<float>(image.affine[i])) != image.affine[i];
  }
  h.put(344, std::string("n+1"), 4);

  if (rounded)
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
