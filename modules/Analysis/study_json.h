// cost.json and cost.csv: a study for programs.
#pragma once

#include "study.h"

#include <string>

namespace brume
{

/// The study as a JSON object (UTF-8, indented); docs/user/cost.md names every key. Numbers are finite;
/// what is not known or not finite is null. Throws std::invalid_argument when a point's settings or
/// statistics are not a JSON object.
VTKBRUMEANALYSIS_EXPORT std::string to_json(const Study& study);

/// One line a point, those that were skipped among them, below a line of names; fields that hold a comma,
/// a quote or a line end are quoted (RFC 4180, lines ended by LF). Errors are fractions of white. What is
/// not known is empty; what is infinite is "inf".
VTKBRUMEANALYSIS_EXPORT std::string to_csv(const Study& study);

}
