// cost.png: error against seconds.
#pragma once

#include "study.h"

namespace brume
{

/// The study as a chart (vtkChartXY): RMS error over seconds, both logarithmic, a mark a setting, a colour and
/// a shape a knob, VTK's own mappers as crosses, the front as a line with its settings named where there is
/// room. Where the truth limits a point its error is the most that it can be. Points without error or
/// seconds, and skipped ones, are left out.
///
/// Drawn through OpenGL in a window that nobody sees: needs a display. Throws std::runtime_error when VTK
/// cannot draw, std::invalid_argument for a width below 400 or a height below 300.
VTKBRUMEANALYSIS_EXPORT Bitmap study_chart(const Study& study, int width = 1100, int height = 740);

}
