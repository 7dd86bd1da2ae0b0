// compare.json: a comparison for programs.
#pragma once

#include "comparison.h"

#include <string>

namespace brume
{

/// The comparison as JSON (UTF-8, indented by two blanks, one final line feed), without the
/// pictures. docs/user/compare.md lists its keys.
///
/// Numbers are always finite: a figure that is not becomes null, and its object then holds
/// `not_finite`, the reason in words. Errors are fractions of white in linear RGB, times are
/// seconds, lengths are world units.
///
/// Throws std::invalid_argument when an entry's statistics are not a JSON object.
VTKBRUMEANALYSIS_EXPORT std::string to_json(const Comparison& comparison);

}
