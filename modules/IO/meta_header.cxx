// MetaImage (.mha, .mhd) headers: lines of "Key = Value". The keys: https://itk.org/Wiki/MetaIO.
#include "scan_header.h"

#include "file_access.h"
#include "header_text.h"
#include "image_file.h"

#include <cmath>
#include <cstdio>
#include <map>

namespace brume::io
{

namespace
{

const char* const Remedy = "check that the file is whole, or export the volume again";

using Keys = std::map<std::string, std::string>;

/// The value of the first of several names of one thing; empty when none is there.
std::string value(const Keys& keys, std::initializer_list<const char*> names)
{
  for (const char* name : names)
  {
    const auto found = keys.find(name);
    if (found != keys.end())
    {
      return found->second;
    }
  }
  return {};
}

bool truth(const std::string& word)
{
  return !word.empty() && (word[0] == 'T' || word[0] == 't' || word[0] == '1');
}

/// `count` numbers, or `otherwise` where the key is missing.
std::vector<double> numbers(const std::string& path, const Keys& keys,
  std::initializer_list<const char*> names, std::size_t count, std::vector<double> otherwise)
{
  const std::string text = value(keys, names);
  if (text.empty())
  {
    return otherwise;
  }
  std::vector<double> result;
  if (!parse_numbers(text, result) || result.size() < count)
  {
    fail(path, std::string("the header's ") + *names.begin() + " is not " + std::to_string(count) +
        " numbers: \"" + text + "\"", Remedy);
  }
  result.resize(count);
  return result;
}

Scalar scalar_of(const std::string& path, std::string name)
{
  static const std::map<std::string, Scalar> types{ { "MET_CHAR", Scalar::Int8 },
    { "MET_UCHAR", Scalar::UInt8 }, { "MET_SHORT", Scalar::Int16 }, { "MET_USHORT", Scalar::UInt16 },
    { "MET_INT", Scalar::Int32 }, { "MET_UINT", Scalar::UInt32 }, { "MET_LONG", Scalar::Int32 },
    { "MET_ULONG", Scalar::UInt32 }, { "MET_LONG_LONG", Scalar::Int64 },
    { "MET_ULONG_LONG", Scalar::UInt64 }, { "MET_FLOAT", Scalar::Float32 },
    { "MET_DOUBLE", Scalar::Float64 } };
  const std::string suffix = "_ARRAY";
  if (name.size() > suffix.size() &&
    name.compare(name.size() - suffix.size(), suffix.size(), suffix) == 0)
  {
    name.resize(name.size() - suffix.size());
  }
  const auto found = types.find(name);
  if (found == types.end())
  {
    fail(path, name.empty() ? "the header gives no ElementType"
                            : "its voxels are of type " + name + ", which Brume does not read",
      "convert it to integers or to 32-bit floats");
  }
  return found->second;
}

void orient(ScanHeader& h, const Keys& keys, std::size_t rank)
{
  std::vector<double> ones(rank, 1.0);
  std::vector<double> zeros(rank, 0.0);
  std::vector<double> identity(rank * rank, 0.0);
  for (std::size_t i = 0; i < rank; ++i)
  {
    identity[i * rank + i] = 1;
  }
  // ElementSize is the extent of a voxel; where the distance between voxels is not given, both agree.
  const std::vector<double> spacing = numbers(h.path, keys, { "ElementSpacing", "ElementSize" }, rank, ones);
  const std::vector<double> origin = numbers(h.path, keys, { "Offset", "Position", "Origin" }, rank, zeros);
  const std::vector<double> turn =
    numbers(h.path, keys, { "TransformMatrix", "Rotation", "Orientation" }, rank * rank, identity);
  for (std::size_t axis = 0; axis < std::min<std::size_t>(rank, 3); ++axis)
  {
    for (std::size_t row = 0; row < std::min<std::size_t>(rank, 3); ++row)
    {
      // The file lists the direction of one index axis after another, as ITK reads it.
      h.affine[4 * row + axis] = turn[axis * rank + row] * std::abs(spacing[axis]);
      h.affine[4 * row + 3] = origin[row];
    }
  }
  const std::string anatomy = value(keys, { "AnatomicalOrientation" });
  h.patient = turn != identity || (!anatomy.empty() && anatomy.find('?') == std::string::npos);
  bool world_axes = false; // not a patient's: Brume's own writer says so in a comment
  read_mark(value(keys, { "Comment" }), world_axes, h.length_unit, h.value_unit);
  h.patient = h.patient && !world_axes;
  if (h.patient)
  {
    // ITK's world is LPS+; Brume's is RAS+.
    for (int i = 0; i < 8; ++i)
    {
      h.affine[i] = -h.affine[i];
    }
  }
  const std::string unit = value(keys, { "DistanceUnits" });
  if (unit == "mm" || unit == "cm" || unit == "um")
  {
    convert_to_millimetres(h, unit);
  }
  else if (h.patient)
  {
    // ITK's convention is mm; Brume's own writer names another unit in the comment.
    convert_to_millimetres(h, h.length_unit.empty() ? "mm" : h.length_unit);
  }
}

}

ScanHeader read_meta_header(const std::string& path)
{
  ScanHeader h;
  h.path = path;
  h.format = "MetaImage";
  LineReader lines(path);
  Keys keys;
  std::string line;
  std::vector<std::string> list;
  bool complete = false;
  while (lines.next(line))
  {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos)
    {
      if (trimmed(line).empty())
      {
        continue;
      }
      fail(path, "a line of the header is not \"Key = Value\": \"" + shortened(line) + "\"", Remedy);
    }
    const std::string key = trimmed(line.substr(0, equals));
    keys[key] = trimmed(line.substr(equals + 1));
    if (key == "ElementDataFile")
    {
      complete = true; // the last key, by the format's rule
      break;
    }
  }
  if (!complete)
  {
    fail(path, "the header does not say where the voxels are (ElementDataFile)", Remedy);
  }

  std::vector<double> rank_value = numbers(path, keys, { "NDims" }, 1, { 0 });
  const double rank_number = rank_value[0];
  if (!(rank_number >= 1 && rank_number <= 4))
  {
    fail(path, "the header gives no NDims from 1 to 4", Remedy);
  }
  const std::size_t rank = static_cast<std::size_t>(rank_number);
  const std::vector<double> sizes = numbers(path, keys, { "DimSize" }, rank, {});
  if (sizes.size() != rank)
  {
    fail(path, "the header gives no DimSize", Remedy);
  }
  h.dimensions = { { 1, 1, 1 } };
  for (std::size_t i = 0; i < rank; ++i)
  {
    const std::int64_t n = whole_number(sizes[i]);
    if (n < 1)
    {
      fail(path, "the header's DimSize is not made of counts from 1 on: \"" +
          value(keys, { "DimSize" }) + "\"", Remedy);
    }
    if (i < 3)
    {
      h.dimensions[i] = n;
    }
    else if (n > 1)
    {
      const std::vector<double> steps =
        numbers(path, keys, { "ElementSpacing", "ElementSize" }, rank, std::vector<double>(rank, 1.0));
      const std::vector<double> starts = numbers(
        path, keys, { "Offset", "Position", "Origin" }, rank, std::vector<double>(rank, 0.0));
      set_series(h, n, starts[i], steps[i], "");
    }
  }
  h.scalar = scalar_of(path, value(keys, { "ElementType" }));
  h.components = whole_number(numbers(path, keys, { "ElementNumberOfChannels" }, 1, { 1 })[0]);
  const bool file_is_big = truth(value(keys, { "BinaryDataByteOrderMSB", "ElementByteOrderMSB" }));
  h.swap_bytes = file_is_big != machine_is_big_endian();
  const std::string binary = value(keys, { "BinaryData" });
  if (truth(value(keys, { "CompressedData" })))
  {
    h.encoding = Encoding::Deflated;
    h.format += " (deflated)";
  }
  else if (!binary.empty() && !truth(binary))
  {
    h.encoding = Encoding::Text;
    h.format += " (text)";
  }

  const std::string data = value(keys, { "ElementDataFile" });
  const std::string lower = lowered(data);
  const double header_size = numbers(path, keys, { "HeaderSize" }, 1, { 0 })[0];
  if (header_size != -1 && whole_number(header_size) < 0)
  {
    fail(path, "the header's HeaderSize makes no sense", Remedy);
  }
  const std::uint64_t skip =
    header_size > 0 ? static_cast<std::uint64_t>(whole_number(header_size)) : 0;
  const std::vector<std::string> words = split_words(data);
  if (data.empty())
  {
    fail(path, "the header does not say where the voxels are (ElementDataFile)", Remedy);
  }
  if (lower == "local")
  {
    h.parts.push_back({ path, lines.position() });
  }
  else
  {
    add_data_files(path, lines, data, words[0] == "LIST", skip, h);
  }
  h.slope = numbers(path, keys, { "ElementToIntensityFunctionSlope" }, 1, { 1 })[0];
  h.intercept = numbers(path, keys, { "ElementToIntensityFunctionOffset" }, 1, { 0 })[0];
  if (!std::isfinite(h.slope) || !std::isfinite(h.intercept) || h.slope == 0)
  {
    h.slope = 1;
    h.intercept = 0;
  }
  if (value(keys, { "Modality" }) == "MET_MOD_CT")
  {
    h.value_unit = "HU";
  }
  orient(h, keys, rank);
  if (header_size == -1 && h.encoding == Encoding::Raw && h.parts.size() == 1)
  {
    take_from_end(h); // HeaderSize = -1: the data are the file's last bytes
  }
  return h;
}

}
