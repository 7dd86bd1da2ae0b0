// Scans made byte by byte, for the tests of the readers: nothing of the code under test is used.
#pragma once

#include <gtest/gtest.h>

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace scan_files
{

using Affine = std::array<double, 12>; // voxel index to world, rows

constexpr int Nx = 5, Ny = 4, Nz = 3;
// The marker's voxel. No two coordinates agree with each other or with their mirror images.
constexpr int Mi = 3, Mj = 2, Mk = 0;
constexpr int Marker = 1000;

/// A folder of this test's own, empty.
inline std::string folder()
{
  const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test->test_suite_name()) + "-" + test->name();
  for (char& c : name)
  {
    c = c == '/' ? '-' : c;
  }
  const std::filesystem::path path = std::filesystem::path(BRUME_TEST_OUTPUT) / name;
  std::filesystem::remove_all(path);
  std::filesystem::create_directories(path);
  return path.string() + "/";
}

inline std::string save(const std::string& path, const std::string& bytes)
{
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

inline std::string load(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  return { std::istreambuf_iterator<char>(file), {} };
}

/// gzip with window bits 31, zlib with 15.
inline std::string deflated(const std::string& bytes, int window_bits = 31)
{
  z_stream z{};
  deflateInit2(&z, 6, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&z, bytes.size()) + 64, '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(&out[0]);
  z.avail_out = static_cast<uInt>(out.size());
  deflate(&z, Z_FINISH);
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}

template <typename T>
void put(std::string& bytes, std::size_t offset, T value, bool swap = false)
{
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T); ++i)
  {
    bytes[offset + i] = raw[swap ? sizeof(T) - 1 - i : i];
  }
}

/// Voxel n holds n, but for the marker.
inline std::vector<int> numbers()
{
  std::vector<int> values(Nx * Ny * Nz);
  for (std::size_t n = 0; n < values.size(); ++n)
  {
    values[n] = static_cast<int>(n);
  }
  values[Mi + Nx * (Mj + Ny * Mk)] = Marker;
  return values;
}

template <typename T = std::int16_t>
std::string voxels(bool swap = false)
{
  std::string bytes(Nx * Ny * Nz * sizeof(T), '\0');
  std::size_t at = 0;
  for (int value : numbers())
  {
    put<T>(bytes, at, static_cast<T>(value), swap);
    at += sizeof(T);
  }
  return bytes;
}

inline std::string text_voxels()
{
  std::string text;
  for (int value : numbers())
  {
    text += std::to_string(value) + (value % 7 ? " " : "\n");
  }
  return text;
}

struct NiftiOptions
{
  bool swap = false;
  std::int16_t datatype = 4; // int16
  std::int16_t dim[8] = { 3, Nx, Ny, Nz, 1, 1, 1, 1 };
  float pixdim[4] = { 1, 2, 3, 4 };
  float slope = 0, intercept = 0;
  char units = 2; // mm
  int qform = 0, sform = 0;
  float quaternion[3] = { 0, 0, 0 };
  float offset[3] = { 0, 0, 0 };
  Affine srow{};
  const char* magic = "n+1";
};

/// The 352 bytes in front of the voxels of a NIfTI-1 file.
inline std::string nifti_header(const NiftiOptions& o)
{
  std::string h(352, '\0');
  put<std::int32_t>(h, 0, 348, o.swap);
  for (int i = 0; i < 8; ++i)
  {
    put<std::int16_t>(h, 40 + 2 * i, o.dim[i], o.swap);
    put<float>(h, 76 + 4 * i, i < 4 ? o.pixdim[i] : 1.f, o.swap);
  }
  put<std::int16_t>(h, 70, o.datatype, o.swap);
  put<float>(h, 108, std::strcmp(o.magic, "n+1") == 0 ? 352.f : 0.f, o.swap);
  put<float>(h, 112, o.slope, o.swap);
  put<float>(h, 116, o.intercept, o.swap);
  h[123] = o.units;
  put<std::int16_t>(h, 252, static_cast<std::int16_t>(o.qform), o.swap);
  put<std::int16_t>(h, 254, static_cast<std::int16_t>(o.sform), o.swap);
  for (int i = 0; i < 3; ++i)
  {
    put<float>(h, 256 + 4 * i, o.quaternion[i], o.swap);
    put<float>(h, 268 + 4 * i, o.offset[i], o.swap);
  }
  for (int i = 0; i < 12; ++i)
  {
    put<float>(h, 280 + 4 * i, static_cast<float>(o.srow[i]), o.swap);
  }
  std::memcpy(&h[344], o.magic, std::strlen(o.magic));
  return h;
}

/// The 544 bytes in front of the voxels of a NIfTI-2 file, with an sform.
inline std::string nifti2_header(const Affine& affine, std::int16_t datatype, bool swap = false)
{
  std::string h(544, '\0');
  put<std::int32_t>(h, 0, 540, swap);
  std::memcpy(&h[4], "n+2\0\r\n\032\n", 8);
  put<std::int16_t>(h, 12, datatype, swap);
  const std::int64_t dim[4] = { 3, Nx, Ny, Nz };
  for (int i = 0; i < 4; ++i)
  {
    put<std::int64_t>(h, 16 + 8 * i, dim[i], swap);
    put<double>(h, 104 + 8 * i, 1, swap);
  }
  put<std::int64_t>(h, 168, 544, swap);
  put<std::int32_t>(h, 348, 1, swap);
  for (int i = 0; i < 12; ++i)
  {
    put<double>(h, 400 + 8 * i, affine[i], swap);
  }
  put<std::int32_t>(h, 500, 2, swap);
  return h;
}

inline std::array<double, 3> apply(const Affine& a, double i, double j, double k)
{
  return { { a[0] * i + a[1] * j + a[2] * k + a[3], a[4] * i + a[5] * j + a[6] * k + a[7],
    a[8] * i + a[9] * j + a[10] * k + a[11] } };
}

}
