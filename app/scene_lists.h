// What scene files hold beside the options: lists of lights and of lobes.
#pragma once

#include "medium_options.h"
#include "presets.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace brume::app
{

/// The lights of a list. Throws Failure (BadCall), its place `place` and the JSON pointer from
/// there, for what is no light.
std::vector<LightChoice> read_lights(const nlohmann::json& list, const std::string& place);

/// The lobes of a list, likewise.
std::vector<LobeChoice> read_lobes(const nlohmann::json& list, const std::string& place);

/// The points of transfer functions, likewise: [value, R, G, B] and [value, opacity] each, by rising
/// values.
std::vector<ColourPoint> read_colour(const nlohmann::json& list, const std::string& place);
std::vector<OpacityPoint> read_opacity(const nlohmann::json& list, const std::string& place);

/// The same as lists, for scene files that are written.
nlohmann::ordered_json list_of(const std::vector<ColourPoint>& points);
nlohmann::ordered_json list_of(const std::vector<OpacityPoint>& points);

/// Their parts of the JSON schema.
nlohmann::ordered_json lights_schema();
nlohmann::ordered_json lobes_schema();
nlohmann::ordered_json colour_schema();
nlohmann::ordered_json opacity_schema();

/// A key as a part of a JSON pointer.
std::string escaped(const std::string& key);

}
