// The parts that the JSON of a comparison and that of a study have in common.
#pragma once

#include "comparison.h"

#include <nlohmann/json.hpp>

#include <string>

namespace brume
{

/// A number, or null for what is not finite.
nlohmann::ordered_json number(double value);

/// A text that is valid UTF-8, or null for an empty one.
nlohmann::ordered_json text_or_null(const std::string& text);

/// The figures, with null and a reason for what is not finite; null where nothing was measured.
nlohmann::ordered_json errors_json(const ImageErrors& errors);

nlohmann::ordered_json seconds_json(const Timing& timing);
nlohmann::ordered_json scene_json(const SceneDescription& scene);
nlohmann::ordered_json truth_json(const Truth& truth);
nlohmann::ordered_json machine_json(const Machine& machine);

}
