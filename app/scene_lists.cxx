#include "scene_lists.h"

#include "command.h"
#include "option_checks.h"

#include <algorithm>
#include <array>

namespace brume::app
{

namespace
{

using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* remedy = "see docs/user/scene-files.md";

/// What the value of a field must be.
struct Range
{
  const char* what;
  bool (*good)(double);
};
const Range any{ "a number", [](double) { return true; } };
const Range not_negative{ "a number of 0 or more", [](double v) { return v >= 0.0; } };
const Range positive{ "a number greater than 0", [](double v) { return v > 0.0; } };
const Range inside_one{ "a number between -1 and 1", [](double v) { return v > -1.0 && v < 1.0; } };
const Range cone{ "an angle from 0 to 180 degrees", [](double v) { return v >= 0.0 && v <= 180.0; } };

/// One object of a list: reads its fields, and refuses those that nobody asked for.
class Fields
{
public:
  Fields(const json& object, const std::string& place)
    : Object(object)
    , Place(place)
  {
    if (!object.is_object())
    {
      throw Failure(place, shortened(object) + " is not an object", remedy, BadCall);
    }
  }

  bool has(const char* name) const { return this->Object.contains(name); }
  void require(const char* name, const std::string& of) const
  {
    if (!this->has(name))
    {
      throw Failure(this->Place, "a " + of + " needs \"" + name + "\"", remedy, BadCall);
    }
  }
  void number(const char* name, double& value, const Range& range)
  {
    this->Known.push_back(name);
    if (this->has(name))
    {
      value = this->number_of(this->Object[name], "/" + std::string(name), range);
    }
  }
  void triple(const char* name, Triple& value, const Range& range)
  {
    this->Known.push_back(name);
    if (!this->has(name))
    {
      return;
    }
    const json& list = this->Object[name];
    const std::string at = "/" + std::string(name);
    if (!list.is_array() || list.size() != 3)
    {
      throw Failure(
        this->Place + at, shortened(list) + " is not a list of 3 numbers", remedy, BadCall);
    }
    for (std::size_t i = 0; i < 3; ++i)
    {
      value[i] = this->number_of(list[i], at + "/" + std::to_string(i), range);
    }
  }
  void direction(const char* name, Triple& value)
  {
    this->triple(name, value, any);
    if (value == Triple{ 0.0, 0.0, 0.0 })
    {
      throw Failure(this->Place + "/" + name, "0, 0, 0 is no direction", remedy, BadCall);
    }
  }
  /// The index of a word among `words`; it must be there.
  std::size_t word(const char* name, const std::vector<std::string>& words)
  {
    this->Known.push_back(name);
    if (!this->has(name))
    {
      throw Failure(this->Place, std::string("\"") + name + "\" is missing, one of " + listed(words),
        remedy, BadCall);
    }
    const json& value = this->Object[name];
    const auto found = value.is_string()
      ? std::find(words.begin(), words.end(), value.get<std::string>())
      : words.end();
    if (found == words.end())
    {
      throw Failure(this->Place + "/" + name, shortened(value) + " is not one of " + listed(words),
        remedy, BadCall);
    }
    return static_cast<std::size_t>(found - words.begin());
  }
  /// To be called when all fields were read; `of` is what the object is.
  void finish(const std::string& of) const
  {
    for (const auto& [name, value] : this->Object.items())
    {
      if (std::find(this->Known.begin(), this->Known.end(), name) == this->Known.end())
      {
        const std::string nearest = nearest_name(name, this->Known);
        throw Failure(this->Place + "/" + escaped(name), "a " + of + " has no such key",
          nearest.empty() ? "choose among " + listed(this->Known) : "did you mean \"" + nearest + "\"?",
          BadCall);
      }
    }
  }

private:
  static std::string shortened(const json& value)
  {
    const std::string text = value.dump();
    return text.size() > 60 ? text.substr(0, 60) + "…" : text;
  }
  double number_of(const json& value, const std::string& at, const Range& range) const
  {
    if (!value.is_number() || !range.good(value.get<double>()))
    {
      throw Failure(
        this->Place + at, shortened(value) + " is not " + range.what, remedy, BadCall);
    }
    return value.get<double>();
  }

  const json& Object;
  std::string Place;
  std::vector<std::string> Known;
};

const std::vector<std::string>& light_types()
{
  static const std::vector<std::string> types{ "directional", "point", "spot", "headlight" };
  return types;
}

std::vector<std::string> function_names()
{
  std::vector<std::string> names;
  for (const auto& entry : lobe_functions())
  {
    names.emplace_back(entry.first);
  }
  return names;
}

LightChoice read_light(const json& object, const std::string& place)
{
  Fields fields(object, place);
  LightChoice light;
  const std::size_t type = fields.word("type", light_types());
  const std::string of = light_types()[type] + " light";
  light.type = static_cast<LightChoice::Type>(type);
  const bool spot = light.type == LightChoice::Type::Spot;
  const bool placed = spot || light.type == LightChoice::Type::Point;
  if (spot || light.type == LightChoice::Type::Directional)
  {
    fields.require("direction", of);
    fields.direction("direction", light.direction);
  }
  if (placed)
  {
    fields.require("position", of);
    fields.triple("position", light.position, any);
    fields.triple("attenuation", light.attenuation, not_negative);
    if (light.attenuation == Triple{ 0.0, 0.0, 0.0 })
    {
      throw Failure(place + "/attenuation", "0, 0, 0 would divide the light by 0", remedy, BadCall);
    }
  }
  if (spot)
  {
    fields.number("cone-angle", light.cone_angle, cone);
    fields.number("exponent", light.exponent, not_negative);
  }
  fields.triple("colour", light.colour, not_negative);
  fields.number("intensity", light.intensity, not_negative);
  fields.finish(of);
  return light;
}

LobeChoice read_lobe(const json& object, const std::string& place)
{
  Fields fields(object, place);
  LobeChoice lobe;
  const std::size_t function = fields.word("function", function_names());
  const std::string of = function_names()[function] + " lobe";
  lobe.function = lobe_functions()[function].second;
  if (lobe.function == LobeChoice::Function::HenyeyGreenstein ||
    lobe.function == LobeChoice::Function::Schlick)
  {
    fields.require("anisotropy", of);
    fields.number("anisotropy", lobe.anisotropy, inside_one);
  }
  fields.number("weight", lobe.weight, positive);
  fields.finish(of);
  return lobe;
}

template <class Item>
std::vector<Item> read_list(const json& list, const std::string& place, const char* what,
  Item (*read)(const json&, const std::string&))
{
  if (!list.is_array())
  {
    throw Failure(place, std::string("it is not a list of ") + what, remedy, BadCall);
  }
  std::vector<Item> items;
  for (std::size_t i = 0; i < list.size(); ++i)
  {
    items.push_back(read(list[i], place + "/" + std::to_string(i)));
  }
  return items;
}

/// A point of a transfer function: a value of the data, and what it becomes, from 0 to 1.
template <std::size_t Count>
std::array<double, Count> read_point(const json& list, const std::string& place)
{
  std::array<double, Count> point{};
  const bool right = list.is_array() && list.size() == Count &&
    std::all_of(list.begin(), list.end(), [](const json& v) { return v.is_number(); });
  if (!right)
  {
    throw Failure(place, "it is not a list of " + std::to_string(Count) + " numbers", remedy, BadCall);
  }
  for (std::size_t i = 0; i < Count; ++i)
  {
    point[i] = list[i].get<double>();
    if (i > 0 && !(point[i] >= 0.0 && point[i] <= 1.0))
    {
      throw Failure(place + "/" + std::to_string(i), list[i].dump() + " is not a number from 0 to 1",
        remedy, BadCall);
    }
  }
  return point;
}

ColourPoint read_colour_point(const json& list, const std::string& place)
{
  const auto p = read_point<4>(list, place);
  return { p[0], p[1], p[2], p[3] };
}

OpacityPoint read_opacity_point(const json& list, const std::string& place)
{
  const auto p = read_point<2>(list, place);
  return { p[0], p[1] };
}

/// Points in the order of their values.
template <class Point>
std::vector<Point> checked(std::vector<Point> points, const std::string& place)
{
  if (points.empty())
  {
    throw Failure(place, "it has no points", remedy, BadCall);
  }
  for (std::size_t i = 1; i < points.size(); ++i)
  {
    if (!(points[i].value > points[i - 1].value))
    {
      throw Failure(place + "/" + std::to_string(i), "its value is not above the one before it",
        "put the points in order, each value once", BadCall);
    }
  }
  return points;
}

ordered_json described(ordered_json schema, const char* text)
{
  schema["description"] = text;
  return schema;
}

ordered_json triple_schema(const char* text)
{
  return described({ { "type", "array" }, { "items", { { "type", "number" } } }, { "minItems", 3 },
                     { "maxItems", 3 } },
    text);
}

ordered_json points_schema(int count, const char* text)
{
  const ordered_json point{ { "type", "array" }, { "items", { { "type", "number" } } },
    { "minItems", count }, { "maxItems", count } };
  return described({ { "type", "array" }, { "items", point }, { "minItems", 1 } }, text);
}

ordered_json number_schema(const char* text)
{
  return described({ { "type", "number" } }, text);
}

}

std::vector<LightChoice> read_lights(const json& list, const std::string& place)
{
  return read_list<LightChoice>(list, place, "lights", read_light);
}

std::vector<LobeChoice> read_lobes(const json& list, const std::string& place)
{
  return read_list<LobeChoice>(list, place, "lobes", read_lobe);
}

std::vector<ColourPoint> read_colour(const json& list, const std::string& place)
{
  return checked(read_list<ColourPoint>(list, place, "points", read_colour_point), place);
}

std::vector<OpacityPoint> read_opacity(const json& list, const std::string& place)
{
  return checked(read_list<OpacityPoint>(list, place, "points", read_opacity_point), place);
}

ordered_json list_of(const std::vector<ColourPoint>& points)
{
  ordered_json list = ordered_json::array();
  for (const ColourPoint& p : points)
  {
    list.push_back({ p.value, p.red, p.green, p.blue });
  }
  return list;
}

ordered_json list_of(const std::vector<OpacityPoint>& points)
{
  ordered_json list = ordered_json::array();
  for (const OpacityPoint& p : points)
  {
    list.push_back({ p.value, p.opacity });
  }
  return list;
}

ordered_json colour_schema()
{
  return points_schema(4,
    "Colours of values, in place of the preset's: [value, R, G, B] each, the value the data's own, R, G "
    "and B from 0 to 1; linear between, constant beyond, by rising values");
}

ordered_json opacity_schema()
{
  return points_schema(2,
    "Opacities of values, in place of the preset's: [value, opacity] each, the value the data's own, "
    "opacity from 0 to 1 for a way of the opacity unit distance; linear between, constant beyond, by "
    "rising values");
}

ordered_json lights_schema()
{
  const ordered_json properties{
    { "type", { { "enum", light_types() } } },
    { "position", triple_schema("Of point and spot lights, world units (required)") },
    { "direction",
      triple_schema("In which the light travels, any length; of directional and spot lights "
                    "(required)") },
    { "colour", triple_schema("R, G, B, 0 or more [1, 1, 1]") },
    { "intensity",
      number_schema("0 or more: the irradiance on a facing surface is pi times intensity times "
                    "colour [1]") },
    { "attenuation",
      triple_schema("[a, b, c]: divided by a + b d + c d^2 at the distance d; of point and spot "
                    "lights [1, 0, 0]") },
    { "cone-angle", number_schema("Degrees from the axis, 0 to 180; of spot lights [30]") },
    { "exponent", number_schema("Of the cosine from the axis, 0 or more; of spot lights [1]") },
  };
  const ordered_json item{ { "type", "object" }, { "properties", properties },
    { "required", { "type" } }, { "additionalProperties", false } };
  return described(
    { { "type", "array" }, { "items", item } }, "Lights, in the words of vtkLight");
}

ordered_json lobes_schema()
{
  const ordered_json properties{
    { "function", { { "enum", function_names() } } },
    { "anisotropy",
      number_schema("Mean cosine, between -1 and 1; of hg, henyey-greenstein and schlick "
                    "(required)") },
    { "weight", number_schema("Greater than 0; weights are divided by their sum [1]") },
  };
  const ordered_json item{ { "type", "object" }, { "properties", properties },
    { "required", { "function" } }, { "additionalProperties", false } };
  return described({ { "type", "array" }, { "items", item } },
    "The phase function as a sum of lobes; in place of \"phase\" and \"anisotropy\"");
}

std::string escaped(const std::string& key)
{
  std::string text;
  for (char c : key)
  {
    text += c == '~' ? std::string("~0") : c == '/' ? std::string("~1") : std::string(1, c);
  }
  return text;
}

}
