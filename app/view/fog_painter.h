// What draws a viewport of a scene without a volume.
#pragma once

#include "painter.h"

namespace brume::app
{

/// Surfaces in fog, in closed form: whole pictures are those of `brume render`. The same for all of
/// Brume's mappers; VTK's draw nothing then, and say so.
std::unique_ptr<Painter> make_fog_painter(MapperKind kind);

}
