#include "scan_header.h"

#include "file_access.h"
#include "header_text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

namespace brume::io
{

const char* scalar_name(Scalar type)
{
  static const char* const names[] = { "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64",
    "uint64", "float32", "float64" };
  return names[static_cast<int>(type)];
}

int scalar_size(Scalar type)
{
  switch (type)
  {
    case Scalar::Int8:
    case Scalar::UInt8:
      return 1;
    case Scalar::Int16:
    case Scalar::UInt16:
      return 2;
    case Scalar::Int32:
    case Scalar::UInt32:
    case Scalar::Float32:
      return 4;
    default:
      return 8;
  }
}

std::uint64_t ScanHeader::voxels() const
{
  return static_cast<std::uint64_t>(dimensions[0]) * dimensions[1] * dimensions[2];
}

std::uint64_t ScanHeader::bytes() const
{
  return voxels() * components * scalar_size(scalar);
}

void fail(const std::string& path, const std::string& wrong, const std::string& remedy)
{
  std::string text = wrong + ": " + remedy;
  for (char& c : text)
  {
    c = static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c; // of a damaged file's own words
  }
  throw std::runtime_error(path + ": " + text);
}

void check_header(const ScanHeader& header)
{
  const char* remedy = "check that the file is whole, or export the volume again";
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::int64_t n = header.dimensions[axis];
    if (n < 1 || n > std::numeric_limits<std::int32_t>::max())
    {
      fail(header.path,
        "the header gives " + std::to_string(n) + " voxels along axis " + std::to_string(axis + 1),
        remedy);
    }
  }
  if (header.components < 1 || header.components > 64)
  {
    fail(header.path, "the header gives " + std::to_string(header.components) +
        " numbers a voxel", "Brume reads 1 to 64");
  }
  const std::string size = std::to_string(header.dimensions[0]) + " x " +
    std::to_string(header.dimensions[1]) + " x " + std::to_string(header.dimensions[2]);
  // The product is taken in floating point first: it cannot wrap around there.
  const double numbers = static_cast<double>(header.dimensions[0]) * header.dimensions[1] *
    header.dimensions[2] * header.components;
  if (numbers * scalar_size(header.scalar) > 1e15)
  {
    fail(header.path, "the header promises " + size + " voxels, more than any machine holds",
      remedy);
  }

  const std::uint64_t promised = header.bytes();
  const std::uint64_t parts = header.parts.size();
  if (parts == 0 || promised % parts != 0)
  {
    fail(header.path, "the header does not name as many data files as the volume needs", remedy);
  }
  for (const DataPart& part : header.parts)
  {
    const std::uint64_t length = file_length(header.path, part.path);
    const std::uint64_t start = header.offset_is_inflated ? 0 : part.offset;
    const std::uint64_t available = length > start ? length - start : 0;
    if (part.skip > (std::uint64_t(1) << 60))
    {
      fail(header.path, "the header promises more voxels than any machine holds", remedy);
    }
    const std::uint64_t wanted = promised / parts + part.skip;
    std::uint64_t most = available; // numbers' bytes that this many bytes of file can hold
    if (header.encoding == Encoding::Deflated)
    {
      most = available > (std::uint64_t(1) << 50) ? wanted : available * 1032;
    }
    else if (header.encoding == Encoding::Dicom || header.encoding == Encoding::Pictures)
    {
      most = available > 0 ? wanted : 0; // as many as a decoder likes to make
    }
    else if (header.encoding == Encoding::Text)
    {
      most = (available + 1) / 2 * scalar_size(header.scalar);
    }
    if (most < wanted)
    {
      fail(part.path == header.path ? header.path : header.path + ": " + part.path,
        "the file is cut short: the header promises " + std::to_string(wanted) +
          " bytes of voxels (" + size + "), the file has room for " + std::to_string(most),
        "copy or download it again");
    }
  }
}

void set_series(
  ScanHeader& header, std::int64_t count, double start, double step, const std::string& unit)
{
  constexpr std::int64_t Most = 1000000;
  if (count > Most)
  {
    fail(header.path, "the header promises a series of " + std::to_string(count) + " volumes",
      "Brume reads up to 1,000,000: check that the file is whole");
  }
  const bool told = std::isfinite(step) && step != 0 && std::isfinite(start);
  header.times.clear();
  for (std::int64_t i = 0; i < count; ++i)
  {
    header.times.push_back(told ? start + static_cast<double>(i) * step : static_cast<double>(i));
  }
  header.time_unit = told ? unit : "";
  header.more_follows = header.more_follows || count > 1;
}

void check_series(ScanHeader& header)
{
  const std::size_t promised = header.times.size();
  if (promised < 2 || header.parts.size() != 1 || header.encoding != Encoding::Raw)
  {
    return;
  }
  const std::uint64_t length = file_length(header.path, header.parts[0].path);
  const std::uint64_t whole = (length - header.parts[0].offset) / header.bytes();
  if (whole < promised)
  {
    header.times.resize(static_cast<std::size_t>(std::max<std::uint64_t>(whole, 1)));
    header.messages.push_back("the file is cut short: of its " + std::to_string(promised) +
      " volumes it holds " + std::to_string(header.times.size()));
  }
}

ScanHeader select_volume(const ScanHeader& header, std::size_t index)
{
  ScanHeader chosen = header;
  const std::size_t volumes = std::max<std::size_t>(header.times.size(), 1);
  if (header.parts.size() == 1)
  {
    const double skip = static_cast<double>(index) * static_cast<double>(header.voxels()) *
      static_cast<double>(header.components) * scalar_size(header.scalar);
    if (skip > 1e18)
    {
      fail(header.path, "the header promises more voxels than any machine holds",
        "check that the file is whole, or export the volume again");
    }
    chosen.parts[0].skip += index * header.bytes();
  }
  else if (volumes > 1)
  {
    if (header.parts.size() % volumes != 0)
    {
      fail(header.path,
        "the header names " + std::to_string(header.parts.size()) + " data files for " +
          std::to_string(volumes) + " volumes",
        "list as many for each volume");
    }
    const std::size_t each = header.parts.size() / volumes;
    chosen.parts.assign(header.parts.begin() + static_cast<std::ptrdiff_t>(index * each),
      header.parts.begin() + static_cast<std::ptrdiff_t>((index + 1) * each));
    if (header.part_rescale.size() == header.parts.size())
    {
      chosen.part_rescale.assign(
        header.part_rescale.begin() + static_cast<std::ptrdiff_t>(index * each),
        header.part_rescale.begin() + static_cast<std::ptrdiff_t>((index + 1) * each));
    }
  }
  return chosen;
}

void convert_to_millimetres(ScanHeader& header, const std::string& unit)
{
  static const std::map<std::string, double> factors{ { "mm", 1 }, { "millimeter", 1 },
    { "millimetre", 1 }, { "millimeters", 1 }, { "um", 1e-3 }, { "micron", 1e-3 },
    { "microns", 1e-3 }, { "micrometer", 1e-3 }, { "micrometre", 1e-3 }, { "\u00b5m", 1e-3 },
    { "cm", 10 }, { "centimeter", 10 }, { "centimetre", 10 }, { "m", 1000 }, { "meter", 1000 },
    { "metre", 1000 } };
  const auto found = factors.find(unit);
  if (!header.patient || found == factors.end())
  {
    header.length_unit = found != factors.end() && found->second == 1 ? "mm" : unit;
    if (header.patient)
    {
      header.messages.push_back("lengths are in \"" + unit + "\" and are not converted to mm");
    }
    return;
  }
  header.length_unit = "mm";
  if (found->second != 1)
  {
    for (double& a : header.affine)
    {
      a *= found->second;
    }
    header.messages.push_back("lengths converted from " + unit + " to mm");
  }
}

void add_data_files(const std::string& path, LineReader& lines, const std::string& data, bool list,
  std::uint64_t skip, ScanHeader& header)
{
  const std::vector<std::string> words = split_words(data);
  if (list)
  {
    std::string line;
    while (lines.next(line))
    {
      if (!trimmed(line).empty())
      {
        header.parts.push_back({ beside(path, trimmed(line)), skip });
      }
    }
  }
  else if (words.size() >= 4 && words[0].find('%') != std::string::npos)
  {
    for (const std::string& name : expand_pattern(path, words))
    {
      header.parts.push_back({ beside(path, name), skip });
    }
  }
  else
  {
    header.parts.push_back({ beside(path, data), skip });
  }
}

}
