// Raw voxels with a sidecar: a JSON file that says what they are (docs/user/input.md).
#include "scan_header.h"

#include "file_access.h"
#include "header_text.h"
#include "raw_header.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

namespace brume::io
{

namespace fs = std::filesystem;

namespace
{

using nlohmann::json;

const char* const Remedy = "see \"Raw voxels\" in docs/user/input.md";

class Sidecar
{
public:
  Sidecar(const std::string& path, const json& object)
    : path_(path)
    , object_(object)
  {
  }
  bool has(const char* key) const { return object_.contains(key); }
  [[noreturn]] void refuse(const char* key, const std::string& wanted) const
  {
    fail(path_, std::string("its \"") + key + "\" is not " + wanted, Remedy);
  }
  std::string text(const char* key, const std::string& otherwise) const
  {
    if (!has(key))
    {
      return otherwise;
    }
    if (!object_[key].is_string())
    {
      refuse(key, "a text");
    }
    return object_[key].get<std::string>();
  }
  double number(const char* key, double otherwise) const
  {
    if (!has(key))
    {
      return otherwise;
    }
    if (!object_[key].is_number() || !std::isfinite(object_[key].get<double>()))
    {
      refuse(key, "a number");
    }
    return object_[key].get<double>();
  }
  /// Numbers of a list, or of a list of lists.
  std::vector<double> numbers(const char* key) const
  {
    std::vector<double> result;
    if (has(key))
    {
      collect(key, object_[key], result, 0);
    }
    return result;
  }

private:
  void collect(const char* key, const json& value, std::vector<double>& result, int depth) const
  {
    if (value.is_number())
    {
      result.push_back(value.get<double>());
    }
    else if (value.is_array() && depth < 2 && value.size() <= 16)
    {
      for (const json& element : value)
      {
        collect(key, element, result, depth + 1);
      }
    }
    else
    {
      refuse(key, "a list of numbers");
    }
  }
  std::string path_;
  const json& object_;
};

json parse(const std::string& path)
{
  if (file_length(path, path) > (1u << 20))
  {
    fail(path, "is too long for the description of raw voxels", Remedy);
  }
  std::string text(1u << 20, '\0');
  ByteStream stream(path, path, 0, ByteStream::Plain);
  text.resize(stream.read(&text[0], text.size()));
  // A parser that goes down into a damaged file must not go deeper than the stack is.
  const auto shallow = [](int depth, json::parse_event_t, json&)
  {
    if (depth > 8)
    {
      throw std::length_error("it is nested too deeply");
    }
    return true;
  };
  json object;
  try
  {
    object = json::parse(text, shallow);
  }
  catch (const std::exception& error)
  {
    fail(path, "is no JSON (" + std::string(error.what()).substr(0, 120) + ")", Remedy);
  }
  if (!object.is_object())
  {
    fail(path, "holds no JSON object", Remedy);
  }
  static const std::set<std::string> known{ "file", "dimensions", "type", "byte_order", "components",
    "offset", "spacing", "origin", "direction", "unit", "value_unit", "patient_axes", "array", "slope",
    "intercept", "time_start", "time_step", "time_unit" };
  for (const auto& [key, value] : object.items())
  {
    if (known.count(key) == 0)
    {
      fail(path, "has a key \"" + shortened(key) + "\", which means nothing here", Remedy);
    }
  }
  return object;
}

}

std::string sidecar_of(const std::string& path)
{
  std::error_code error;
  const std::string sidecar = path + ".json";
  if (!fs::is_regular_file(sidecar, error))
  {
    return {};
  }
  // What `brume info FILE --json FILE.json` writes is no description of raw voxels.
  std::string text(4096, '\0');
  std::ifstream file(sidecar, std::ios::binary);
  file.read(&text[0], static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text.find("\"scalar_type\"") == std::string::npos ? sidecar : std::string();
}

std::string raw_advice(const std::string& path)
{
  return "write " + fs::path(path).filename().string() +
    ".json beside it: {\"dimensions\": [256, 256, 128], \"type\": \"uint16\", \"byte_order\": "
    "\"little\", \"spacing\": [1, 1, 1]}";
}

ScanHeader read_raw_header(const std::string& path)
{
  const bool named = lowered(path).size() > 5 && lowered(path).compare(path.size() - 5, 5, ".json") == 0;
  const std::string sidecar_path = named ? path : sidecar_of(path);
  const json object = parse(sidecar_path);
  const Sidecar sidecar(sidecar_path, object);
  ScanHeader h;
  h.path = path;
  h.format = "raw";

  std::string known;
  bool found = false;
  for (const Scalar type : Scalars)
  {
    known += (known.empty() ? "" : ", ") + std::string(scalar_name(type));
    if (sidecar.text("type", "") == scalar_name(type))
    {
      h.scalar = type;
      found = true;
    }
  }
  if (!found)
  {
    sidecar.refuse("type", "one of " + known);
  }
  const std::string order = sidecar.text("byte_order", scalar_size(h.scalar) == 1 ? "little" : "");
  if (order != "little" && order != "big")
  {
    sidecar.refuse("byte_order", "little or big");
  }
  h.swap_bytes = (order == "big") != machine_is_big_endian();

  const std::vector<double> dimensions = sidecar.numbers("dimensions");
  if (dimensions.size() != 3 && dimensions.size() != 4)
  {
    sidecar.refuse("dimensions", "three counts, or four of a series");
  }
  for (std::size_t i = 0; i < dimensions.size(); ++i)
  {
    const std::int64_t count = whole_number(dimensions[i]);
    if (count < 1)
    {
      sidecar.refuse("dimensions", "made of counts from 1 on");
    }
    if (i < 3)
    {
      h.dimensions[i] = count;
    }
    else if (count > 1)
    {
      set_series(h, count, sidecar.number("time_start", 0), sidecar.number("time_step", 0),
        sidecar.text("time_unit", ""));
    }
  }
  h.components = whole_number(sidecar.number("components", 1));
  const std::int64_t offset = whole_number(sidecar.number("offset", 0));
  if (offset < 0)
  {
    sidecar.refuse("offset", "a count of bytes");
  }

  std::vector<double> spacing = sidecar.numbers("spacing");
  std::vector<double> origin = sidecar.numbers("origin");
  std::vector<double> direction = sidecar.numbers("direction");
  spacing = spacing.empty() ? std::vector<double>{ 1, 1, 1 } : spacing;
  origin = origin.empty() ? std::vector<double>{ 0, 0, 0 } : origin;
  direction = direction.empty() ? std::vector<double>{ 1, 0, 0, 0, 1, 0, 0, 0, 1 } : direction;
  if (spacing.size() != 3)
  {
    sidecar.refuse("spacing", "three numbers");
  }
  if (origin.size() != 3)
  {
    sidecar.refuse("origin", "three numbers");
  }
  if (direction.size() != 9)
  {
    sidecar.refuse("direction", "nine numbers, three rows");
  }
  for (std::size_t row = 0; row < 3; ++row)
  {
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      h.affine[4 * row + axis] = direction[3 * row + axis] * spacing[axis];
    }
    h.affine[4 * row + 3] = origin[row];
  }
  if (sidecar.has("patient_axes"))
  {
    if (!object["patient_axes"].is_boolean())
    {
      sidecar.refuse("patient_axes", "true or false");
    }
    h.patient = object["patient_axes"].get<bool>();
  }
  const std::string unit = shortened(sidecar.text("unit", h.patient ? "mm" : ""));
  if (!unit.empty())
  {
    convert_to_millimetres(h, unit);
  }
  h.value_unit = shortened(sidecar.text("value_unit", ""));
  std::string array = sidecar.text("array", "");
  for (char& c : array)
  {
    c = static_cast<unsigned char>(c) < 32 || c == 127 ? ' ' : c;
  }
  array = shortened(trimmed(array));
  h.array = array.empty() ? h.array : array;
  h.slope = sidecar.number("slope", 1);
  h.intercept = sidecar.number("intercept", 0);
  if (h.slope == 0)
  {
    sidecar.refuse("slope", "other than 0");
  }

  DataPart part;
  const std::string stem = sidecar_path.substr(0, sidecar_path.size() - 5);
  part.path = sidecar.has("file") ? beside(sidecar_path, sidecar.text("file", "")) : stem;
  part.offset = static_cast<std::uint64_t>(offset);
  h.parts.push_back(part);
  return h;
}

}
