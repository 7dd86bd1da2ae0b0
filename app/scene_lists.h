// What scene files hold beside the options: lists of lights and of lobes.
#pragma once

#include "medium_options.h"

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

/// Their parts of the JSON schema.
nlohmann::ordered_json lights_schema();
nlohmann::ordered_json lobes_schema();

/// A key as a part of a JSON pointer.
std::string escaped(const std::string& key);

}
