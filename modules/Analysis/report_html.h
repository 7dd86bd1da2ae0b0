// report.html: a comparison for people.
#pragma once

#include "comparison.h"

#include <string>

namespace brume
{

/// The comparison as one HTML file (UTF-8) that needs nothing else: style, script and pictures (PNG,
/// as data URIs) are inside, it asks for nothing from any network, and it is whole without its
/// script, which only adds the wipe between two pictures. It follows the reader's light or dark
/// scheme, fits a narrow screen, and prints.
///
/// In order: the headline, bars of seconds and errors, the pictures, the amplified differences at
/// one shared gain (and the faint ones again at their own), the table of figures, the contributions
/// to each mapper's error, the effects that its statistics name, skipped mappers with their reasons,
/// what was made equal, the truth with its remaining error, the machine, the command line. A part
/// with nothing to say is left out. Every text is escaped.
///
/// Throws std::invalid_argument when an entry's statistics are not a JSON object, or when pictures
/// differ in size.
VTKBRUMEANALYSIS_EXPORT std::string to_html(const Comparison& comparison);

}
