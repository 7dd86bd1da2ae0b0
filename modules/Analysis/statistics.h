// A mapper's own statistics, which travel as JSON text.
#pragma once

#include "comparison.h"

#include <nlohmann/json.hpp>

namespace brume
{

/// The entry's statistics as JSON, in their own order; an empty object where there are none.
/// Throws std::invalid_argument, naming the mapper, when they are not a JSON object.
nlohmann::ordered_json parse_statistics(const ComparisonEntry& entry);

/// The same of any text; `name` is what the message names.
nlohmann::ordered_json parse_object(const std::string& text, const std::string& name);

}
