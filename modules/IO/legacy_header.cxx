// Legacy VTK structured points (.vtk). The format: "VTK File Formats", The VTK User's Guide, 11th
// edition, "Simple Legacy Formats".
#include "scan_header.h"

#include "file_access.h"
#include "header_text.h"

#include <cmath>
#include <map>

namespace brume::io
{

namespace
{

const char* const Remedy = "check that the file is whole, or write it again";

/// The three numbers behind a line's keyword.
std::array<double, 3> three(const std::string& path, const std::string& line)
{
  std::vector<double> numbers;
  const std::vector<std::string> words = split_words(line);
  if (words.size() != 4 || !parse_numbers(words[1] + " " + words[2] + " " + words[3], numbers))
  {
    fail(path, "its " + words[0] + " are not three numbers: \"" + shortened(line) + "\"", Remedy);
  }
  return { { numbers[0], numbers[1], numbers[2] } };
}

}

ScanHeader read_legacy_header(const std::string& path)
{
  static const std::map<std::string, Scalar> types{ { "char", Scalar::Int8 },
    { "signed_char", Scalar::Int8 }, { "unsigned_char", Scalar::UInt8 }, { "short", Scalar::Int16 },
    { "unsigned_short", Scalar::UInt16 }, { "int", Scalar::Int32 },
    { "unsigned_int", Scalar::UInt32 }, { "long", Scalar::Int64 },
    { "unsigned_long", Scalar::UInt64 }, { "vtktypeint64", Scalar::Int64 },
    { "vtktypeuint64", Scalar::UInt64 }, { "float", Scalar::Float32 },
    { "double", Scalar::Float64 } };
  ScanHeader h;
  h.path = path;
  LineReader lines(path);
  std::string line;
  lines.next(line); // the mark
  lines.next(line); // the title
  std::string kind;
  while (kind.empty() && lines.next(line))
  {
    kind = lowered(trimmed(line));
  }
  if (kind != "ascii" && kind != "binary")
  {
    fail(path, "its third line is neither ASCII nor BINARY", Remedy);
  }
  h.encoding = kind == "ascii" ? Encoding::Text : Encoding::Raw;
  h.format = kind == "ascii" ? "legacy VTK (ASCII)" : "legacy VTK (binary)";
  h.swap_bytes = !machine_is_big_endian(); // binary is big-endian, by the format
  std::array<double, 3> spacing{ { 1, 1, 1 } };
  std::array<double, 3> origin{ { 0, 0, 0 } };
  bool sized = false;
  bool known = false;
  while (!known && lines.next(line))
  {
    const std::vector<std::string> words = split_words(lowered(trimmed(line)));
    if (words.empty())
    {
      continue;
    }
    if (words[0] == "dataset" && (words.size() < 2 || words[1] != "structured_points"))
    {
      fail(path, "holds " + (words.size() < 2 ? std::string("no dataset") : shortened(words[1])) +
          ", not structured points", "resample it to an image (vtkResampleToImage)");
    }
    if (words[0] == "dimensions")
    {
      const std::array<double, 3> sizes = three(path, trimmed(line));
      for (int axis = 0; axis < 3; ++axis)
      {
        h.dimensions[axis] = whole_number(sizes[axis]);
        if (h.dimensions[axis] < 1)
        {
          fail(path, "its DIMENSIONS are not counts from 1 on: \"" + shortened(line) + "\"", Remedy);
        }
      }
      sized = true;
    }
    else if (words[0] == "spacing" || words[0] == "aspect_ratio")
    {
      spacing = three(path, trimmed(line));
    }
    else if (words[0] == "origin")
    {
      origin = three(path, trimmed(line));
    }
    else if (words[0] == "point_data")
    {
      std::vector<double> count;
      if (!sized || words.size() != 2 || !parse_numbers(words[1], count) || count.empty() ||
        count[0] != static_cast<double>(h.dimensions[0]) * h.dimensions[1] * h.dimensions[2])
      {
        fail(path, "its POINT_DATA do not count as many points as its DIMENSIONS", Remedy);
      }
    }
    else if (words[0] == "scalars")
    {
      const auto type = words.size() < 3 ? types.end() : types.find(words[2]);
      if (type == types.end())
      {
        break;
      }
      h.scalar = type->second;
      h.array = split_words(trimmed(line))[1];
      std::vector<double> components{ 1 };
      if (words.size() > 3)
      {
        components.clear();
        if (!parse_numbers(words[3], components))
        {
          components = { 0 };
        }
      }
      h.components = whole_number(components[0]);
      // The line of the lookup table may be left out; then the numbers have begun already.
      const std::uint64_t before = lines.position();
      std::uint64_t start = before;
      if (h.encoding == Encoding::Raw || lines.next(line))
      {
        if (h.encoding == Encoding::Raw)
        {
          char next[12] = {};
          ByteStream peek(path, path, before, ByteStream::Plain);
          line.assign(next, peek.read(next, sizeof(next)));
        }
        if (lowered(trimmed(line)).compare(0, 12, "lookup_table") == 0)
        {
          if (h.encoding == Encoding::Raw)
          {
            lines.next(line);
          }
          start = lines.position();
        }
      }
      h.parts.push_back({ path, start });
      known = true;
    }
    else if (words[0] == "field" || words[0] == "color_scalars" || words[0] == "cell_data" ||
      words[0] == "extent")
    {
      break; // what follows is of no length that is known here
    }
  }
  if (known && !sized)
  {
    fail(path, "its DIMENSIONS are missing", Remedy);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    h.affine[5 * axis] = spacing[axis];
    h.affine[4 * axis + 3] = origin[axis];
  }
  if (!known && sized)
  {
    // One bit a voxel is the least that VTK's reader can make of any layout.
    const double voxels =
      static_cast<double>(h.dimensions[0]) * h.dimensions[1] * h.dimensions[2];
    if (voxels / 8 > static_cast<double>(file_length(path, path)))
    {
      fail(path, "the file is cut short, or its header is wrong: it promises more voxels than the "
                 "file has room for", "copy or download it again");
    }
  }
  return h;
}

}
