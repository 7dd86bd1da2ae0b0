// Figures as text, the same in the report, the panel and the terminal.
#pragma once

#include "vtkBrumeAnalysisModule.h" // the export macro alone

#include <string>
#include <string_view>

namespace brume
{

/// Three significant digits: "0.0812", "1.9", "317", "12400"; scientific ("3.2e-07") below 1e-4 and
/// from 1e7; "0" for zero, "infinite" and "not a number" for what is not finite. Trailing zeros
/// after the point are dropped. The locale plays no part.
VTKBRUMEANALYSIS_EXPORT std::string figure(double value, int significant_digits = 3);

/// A fraction of white in steps of an 8-bit display, without a unit: figure(255 * fraction).
std::string in_255ths(double fraction);

/// The same with its unit: "0.21/255"; "0" and "infinite" stand alone.
std::string over_255(double fraction);

/// "0.081 s".
std::string seconds_text(double seconds);

/// "256 × 256 × 128 voxels of 0.5 × 0.5 × 1 mm" and "0.25 mm (0.5 voxels)"; empty where unknown.
std::string voxels_text(const int dimensions[3], const double spacing[3], const std::string& unit);
std::string step_text(double step, double step_voxels, const std::string& unit);

/// The text with every byte that is not part of well-formed UTF-8 replaced by U+FFFD, and every
/// control character but tab and line feed by a space.
std::string valid_utf8(std::string_view text);

/// Its length in code points; the text is well-formed UTF-8.
std::size_t code_points(std::string_view text);

}
