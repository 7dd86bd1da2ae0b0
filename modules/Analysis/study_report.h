// report.html of a study: for people.
#pragma once

#include "study.h"

#include <string>

namespace brume
{

/// The study as one HTML file (UTF-8) that needs nothing else, as the page of a comparison
/// (report_html.h). In order: the chart, what was found in words, the front, pictures and signed differences at
/// chosen points (the front's ends and middle, single scattering, the quickest of VTK's mappers), where
/// their errors lie, all settings, what was not drawn, truth and scene, the machine. `chart` may be null: then
/// there is none. Every text is escaped.
VTKBRUMEANALYSIS_EXPORT std::string to_html(const Study& study, const Bitmap* chart);

}
