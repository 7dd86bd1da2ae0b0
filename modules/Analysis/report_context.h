// What fills the gaps of report/report.html.
#pragma once

#include "comparison.h"

#include <nlohmann/json.hpp>

namespace brume
{

/// Every name that the template uses, but for `style` and `script`. Texts are not escaped yet.
/// Throws std::invalid_argument as to_html() does.
nlohmann::ordered_json report_context(const Comparison& comparison);

/// The parts of it that hold pictures: `pictures`, `differences`, `own_gains`, their legend and
/// their switches (report_pictures.cxx).
void add_pictures(nlohmann::ordered_json& context, const Comparison& comparison);

/// The title for people, or the mapper's name.
std::string title_of(const ComparisonEntry& entry);

}
