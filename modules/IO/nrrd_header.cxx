// NRRD (.nrrd, .nhdr) headers. The fields: G. Kindlmann, "Definition of NRRD File Format",
// https://teem.sourceforge.net/nrrd/format.html.
#include "scan_header.h"

#include "file_access.h"
#include "header_text.h"

#include <cmath>
#include <map>
#include <set>

namespace brume::io
{

namespace
{

const char* const Remedy = "check that the file is whole, or export the volume again";

using Fields = std::map<std::string, std::string>;

std::string field(const Fields& fields, const char* name, const char* otherwise = "")
{
  const auto found = fields.find(name);
  return found == fields.end() ? otherwise : found->second;
}

Scalar scalar_of(const std::string& path, const std::string& name)
{
  static const std::map<std::string, Scalar> types{ { "signed char", Scalar::Int8 },
    { "int8", Scalar::Int8 }, { "int8_t", Scalar::Int8 }, { "uchar", Scalar::UInt8 },
    { "unsigned char", Scalar::UInt8 }, { "uint8", Scalar::UInt8 }, { "uint8_t", Scalar::UInt8 },
    { "short", Scalar::Int16 }, { "short int", Scalar::Int16 }, { "signed short", Scalar::Int16 },
    { "signed short int", Scalar::Int16 }, { "int16", Scalar::Int16 }, { "int16_t", Scalar::Int16 },
    { "ushort", Scalar::UInt16 }, { "unsigned short", Scalar::UInt16 },
    { "unsigned short int", Scalar::UInt16 }, { "uint16", Scalar::UInt16 },
    { "uint16_t", Scalar::UInt16 }, { "int", Scalar::Int32 }, { "signed int", Scalar::Int32 },
    { "int32", Scalar::Int32 }, { "int32_t", Scalar::Int32 }, { "uint", Scalar::UInt32 },
    { "unsigned int", Scalar::UInt32 }, { "uint32", Scalar::UInt32 },
    { "uint32_t", Scalar::UInt32 }, { "longlong", Scalar::Int64 }, { "long long", Scalar::Int64 },
    { "long long int", Scalar::Int64 }, { "signed long long", Scalar::Int64 },
    { "signed long long int", Scalar::Int64 }, { "int64", Scalar::Int64 },
    { "int64_t", Scalar::Int64 }, { "ulonglong", Scalar::UInt64 },
    { "unsigned long long", Scalar::UInt64 }, { "unsigned long long int", Scalar::UInt64 },
    { "uint64", Scalar::UInt64 }, { "uint64_t", Scalar::UInt64 }, { "float", Scalar::Float32 },
    { "double", Scalar::Float64 } };
  const auto found = types.find(name);
  if (found == types.end())
  {
    fail(path, name.empty() ? "the header gives no type"
                            : "its voxels are of type \"" + shortened(name) +
          "\", which Brume does not read",
      "convert it to integers or to 32-bit floats");
  }
  return found->second;
}

/// "(x,y,z)" to numbers; empty for "none" and for what is no vector.
std::vector<double> vector_of(std::string text)
{
  std::vector<double> numbers;
  if (text.size() < 2 || text.front() != '(' || text.back() != ')')
  {
    return numbers;
  }
  text = text.substr(1, text.size() - 2);
  for (char& c : text)
  {
    c = c == ',' ? ' ' : c;
  }
  if (!parse_numbers(text, numbers))
  {
    numbers.clear();
  }
  return numbers;
}

/// "(1, 0, 0) none (0,1,0)" to its words, blanks within brackets or not.
std::vector<std::string> bracketed_words(const std::string& text)
{
  std::string tight;
  bool inside = false;
  for (char c : text)
  {
    inside = c == '(' ? true : c == ')' ? false : inside;
    if (!(inside && (c == ' ' || c == '\t')))
    {
      tight.push_back(c);
    }
  }
  return split_words(tight);
}

struct Axes
{
  std::vector<std::size_t> spatial; // file axes that span the volume, up to 3
  bool first_is_components = false;
  std::int64_t series = 1; // volumes of a last axis that does not span it
};

/// Which axes of the array span space: those that have a direction or whose kind says so; with
/// neither, the last three, and a fourth in front of them counts the components.
Axes axes_of(const std::string& path, const std::vector<std::int64_t>& sizes,
  const std::vector<std::string>& kinds, const std::vector<std::string>& directions)
{
  static const std::set<std::string> spatial_kinds{ "domain", "space", "???", "none" };
  const std::size_t rank = sizes.size();
  Axes axes;
  std::vector<bool> spans(rank, true);
  if (!directions.empty())
  {
    for (std::size_t i = 0; i < rank; ++i)
    {
      spans[i] = !vector_of(directions[i]).empty();
    }
  }
  else if (!kinds.empty())
  {
    for (std::size_t i = 0; i < rank; ++i)
    {
      spans[i] = spatial_kinds.count(lowered(kinds[i])) > 0;
    }
  }
  if (directions.empty() && rank == 4 && spans == std::vector<bool>(rank, true))
  {
    // Nothing tells the axes apart: a short one in front holds components, else the last is time.
    spans[sizes[0] <= 4 ? 0 : 3] = false;
  }
  for (std::size_t i = 0; i < rank; ++i)
  {
    if (spans[i])
    {
      axes.spatial.push_back(i);
    }
    else if (i == 0)
    {
      axes.first_is_components = true;
    }
    else if (i + 1 == rank)
    {
      axes.series = sizes[i];
    }
    else
    {
      fail(path, "axis " + std::to_string(i + 1) + " of the array is not one of space",
        "put such axes first (components) or last (a series), as \"unu permute\" does");
    }
  }
  if (axes.spatial.empty() || axes.spatial.size() > 3)
  {
    fail(path, "the array has " + std::to_string(axes.spatial.size()) + " axes of space",
      "Brume reads volumes of up to three");
  }
  return axes;
}

/// What the field "space" says: the signs that turn its axes to RAS+.
bool patient_space(const std::string& name, double sign[3])
{
  sign[0] = sign[1] = sign[2] = 1;
  if (name == "right-anterior-superior" || name == "ras")
  {
    return true;
  }
  if (name == "left-anterior-superior" || name == "las")
  {
    sign[0] = -1;
    return true;
  }
  if (name == "left-posterior-superior" || name == "lps")
  {
    sign[0] = sign[1] = -1;
    return true;
  }
  return false;
}

/// The times of a series along the last axis: "axis mins", "spacings" and "units" tell them.
void set_times(ScanHeader& h, const Fields& fields, std::int64_t count, std::size_t rank)
{
  const auto last = [&](const char* name, double otherwise)
  {
    const std::vector<std::string> words = split_words(field(fields, name));
    std::vector<double> number;
    const bool told = words.size() == rank && parse_numbers(words.back(), number) &&
      std::isfinite(number[0]);
    return told ? number[0] : otherwise;
  };
  // Units are quoted and may hold blanks; one may follow for each axis.
  std::vector<std::string> units;
  std::string text = field(fields, "units");
  for (std::size_t open; (open = text.find('"')) != std::string::npos;)
  {
    const std::size_t close = text.find('"', open + 1);
    if (close == std::string::npos)
    {
      break;
    }
    units.push_back(text.substr(open + 1, close - open - 1));
    text.erase(0, close + 1);
  }
  const std::string unit = units.size() == rank ? shortened(units.back()) : "";
  const double seconds = unit == "ms" ? 1e-3 : unit == "us" ? 1e-6 : 1;
  set_series(h, count, last("axis mins", 0) * seconds, last("spacings", 0) * seconds,
    seconds == 1 ? unit : "s");
}

void orient(ScanHeader& h, const Fields& fields, const Axes& axes,
  const std::vector<std::string>& directions)
{
  const std::string space = lowered(field(fields, "space"));
  double sign[3];
  h.patient = patient_space(space, sign) && !directions.empty();
  if (space.find("time") != std::string::npos)
  {
    fail(h.path, "its space has an axis of time (\"" + shortened(space) + "\")",
      "save one volume of the series");
  }
  const std::vector<std::string> spacings = split_words(field(fields, "spacings"));
  for (std::size_t a = 0; a < axes.spatial.size(); ++a)
  {
    const std::size_t file_axis = axes.spatial[a];
    if (!directions.empty())
    {
      const std::vector<double> direction = vector_of(directions[file_axis]);
      if (direction.size() > 3 || direction.size() < axes.spatial.size())
      {
        fail(h.path, "a vector of \"space directions\" has " + std::to_string(direction.size()) +
            " numbers", Remedy);
      }
      for (std::size_t row = 0; row < 3; ++row)
      {
        h.affine[4 * row + a] = row < direction.size() ? sign[row] * direction[row] : 0;
      }
    }
    else if (file_axis < spacings.size())
    {
      std::vector<double> number;
      if (parse_numbers(spacings[file_axis], number) && std::isfinite(number[0]) && number[0] != 0)
      {
        h.affine[5 * a] = std::abs(number[0]);
      }
    }
  }
  // A picture of two dimensions in a world of three: its missing axis is the perpendicular.
  if (!directions.empty() && axes.spatial.size() == 2)
  {
    std::array<double, 12>& m = h.affine;
    const double x[3] = { m[0], m[4], m[8] };
    const double y[3] = { m[1], m[5], m[9] };
    m[2] = x[1] * y[2] - x[2] * y[1];
    m[6] = x[2] * y[0] - x[0] * y[2];
    m[10] = x[0] * y[1] - x[1] * y[0];
    const double length = std::hypot(m[2], m[6], m[10]);
    for (int row = 0; row < 3 && length > 0; ++row)
    {
      m[4 * row + 2] /= length;
    }
  }
  const std::string origin_text = field(fields, "space origin");
  if (!origin_text.empty())
  {
    const std::vector<std::string> words = bracketed_words(origin_text);
    const std::vector<double> origin = words.empty() ? std::vector<double>() : vector_of(words[0]);
    if (origin.empty() || origin.size() > 3)
    {
      fail(h.path, "\"space origin\" is not \"(x,y,z)\": \"" + shortened(origin_text) + "\"", Remedy);
    }
    for (std::size_t row = 0; row < origin.size(); ++row)
    {
      h.affine[4 * row + 3] = (h.patient ? sign[row] : 1) * origin[row];
    }
  }

  // Units: "space units" go with directions, "units" with spacings; both quoted.
  std::string unit = field(fields, directions.empty() ? "units" : "space units");
  const std::size_t open = unit.find('"');
  const std::size_t close = open == std::string::npos ? open : unit.find('"', open + 1);
  unit = close == std::string::npos ? std::string() : unit.substr(open + 1, close - open - 1);
  if (!unit.empty())
  {
    convert_to_millimetres(h, unit);
  }
  else if (h.patient)
  {
    h.length_unit = "mm"; // the habit of scans; the format leaves it open
  }
}

}

ScanHeader read_nrrd_header(const std::string& path)
{
  ScanHeader h;
  h.path = path;
  LineReader lines(path);
  std::string line;
  if (!lines.next(line) || line.compare(0, 7, "NRRD000") != 0)
  {
    fail(path, "is not NRRD: its first line is not NRRD000 and a version", Remedy);
  }
  Fields fields;
  bool list = false;
  while (lines.next(line) && !line.empty())
  {
    if (line[0] == '#')
    {
      continue;
    }
    const std::size_t colon = line.find(": ");
    const std::size_t key = line.find(":=");
    if (key != std::string::npos && (colon == std::string::npos || key < colon))
    {
      if (lowered(trimmed(line.substr(0, key))) == "modality" && trimmed(line.substr(key + 2)) == "CT")
      {
        h.value_unit = "HU";
      }
      continue;
    }
    if (colon == std::string::npos)
    {
      if (line.back() == ':')
      {
        continue; // a field with nothing in it
      }
      fail(path, "a line of the header is not \"field: value\": \"" + shortened(line) + "\"", Remedy);
    }
    const std::string name = lowered(trimmed(line.substr(0, colon)));
    std::string squeezed; // "data file" and "datafile" are one
    for (char c : name)
    {
      if (c != ' ')
      {
        squeezed.push_back(c);
      }
    }
    static const std::set<std::string> joined{ "datafile", "lineskip", "byteskip", "sampleunits" };
    fields[joined.count(squeezed) ? squeezed : name] = trimmed(line.substr(colon + 2));
    if (squeezed == "datafile" && fields["datafile"].compare(0, 4, "LIST") == 0)
    {
      list = true;
      break; // the names follow to the file's end
    }
  }

  // Sizes and axes.
  std::vector<double> numbers;
  if (!parse_numbers(field(fields, "sizes"), numbers) || numbers.empty() || numbers.size() > 16)
  {
    fail(path, "the header gives no sizes", Remedy);
  }
  std::vector<double> rank_number;
  if (!parse_numbers(field(fields, "dimension"), rank_number) || rank_number.size() != 1 ||
    rank_number[0] != static_cast<double>(numbers.size()))
  {
    fail(path, "the header's dimension (" + shortened(field(fields, "dimension", "none")) +
        ") and its " + std::to_string(numbers.size()) + " sizes disagree", Remedy);
  }
  const std::size_t rank = numbers.size();
  std::vector<std::int64_t> sizes;
  for (double n : numbers)
  {
    sizes.push_back(whole_number(n));
    if (sizes.back() < 1)
    {
      fail(path, "the header's sizes are not counts from 1 on: \"" +
          shortened(field(fields, "sizes")) + "\"", Remedy);
    }
  }
  std::vector<std::string> kinds = split_words(field(fields, "kinds"));
  std::vector<std::string> directions = bracketed_words(field(fields, "space directions"));
  if ((!kinds.empty() && kinds.size() != rank) || (!directions.empty() && directions.size() != rank))
  {
    fail(path, "\"kinds\" or \"space directions\" do not name each of the " + std::to_string(rank) +
        " axes", Remedy);
  }
  const Axes axes = axes_of(path, sizes, kinds, directions);
  h.dimensions = { { 1, 1, 1 } };
  for (std::size_t a = 0; a < axes.spatial.size(); ++a)
  {
    h.dimensions[a] = sizes[axes.spatial[a]];
  }
  h.components = axes.first_is_components ? sizes[0] : 1;
  if (axes.series > 1)
  {
    set_times(h, fields, axes.series, rank);
  }

  // Numbers and where they lie.
  h.scalar = scalar_of(path, lowered(field(fields, "type")));
  const std::string encoding = lowered(field(fields, "encoding"));
  h.format = "NRRD (" + encoding + ")";
  if (encoding == "raw")
  {
    h.encoding = Encoding::Raw;
  }
  else if (encoding == "gzip" || encoding == "gz")
  {
    h.encoding = Encoding::Deflated;
  }
  else if (encoding == "ascii" || encoding == "text" || encoding == "txt")
  {
    h.encoding = Encoding::Text;
  }
  else
  {
    fail(path, encoding.empty() ? "the header gives no encoding"
                                : "its encoding is \"" + shortened(encoding) + "\"",
      "save it with the encoding raw, gzip or ascii");
  }
  const std::string endian = lowered(field(fields, "endian"));
  if (h.encoding != Encoding::Text && scalar_size(h.scalar) > 1)
  {
    if (endian != "little" && endian != "big")
    {
      fail(path, "the header does not say whether its numbers are of little or big endian", Remedy);
    }
    h.swap_bytes = (endian == "big") != machine_is_big_endian();
  }
  std::vector<double> skips;
  if (!parse_numbers(field(fields, "lineskip", "0") + " " + field(fields, "byteskip", "0"), skips) ||
    skips.size() != 2 || skips[0] != 0 || (skips[1] != -1 && whole_number(skips[1]) < 0) ||
    (skips[1] != 0 && h.encoding != Encoding::Raw))
  {
    fail(path, "Brume does not read NRRD with a line skip, nor with a byte skip in data that are not raw",
      "save it anew");
  }
  const std::uint64_t skip = skips[1] > 0 ? static_cast<std::uint64_t>(skips[1]) : 0;
  const std::string data = field(fields, "datafile");
  if (data.empty())
  {
    h.parts.push_back({ path, lines.position() + skip });
  }
  else
  {
    add_data_files(path, lines, data, list, skip, h);
  }
  if (const std::string name = trimmed(field(fields, "content")); !name.empty())
  {
    h.array = shortened(name);
  }
  if (const std::string unit = field(fields, "sampleunits"); !unit.empty())
  {
    h.value_unit = unit.front() == '"' && unit.size() > 1 ? unit.substr(1, unit.size() - 2) : unit;
  }
  orient(h, fields, axes, directions);
  if (skips[1] == -1 && h.parts.size() == 1)
  {
    take_from_end(h);
  }
  return h;
}

}
