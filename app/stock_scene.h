// What of a scene VTK's own mappers know.
#pragma once

#include "volume_scene.h"

#include <string>
#include <vector>

namespace brume::app
{

/// Why VTK's own mappers cannot draw even a part of the scene; empty where they can.
std::string not_drawn_by_stock(const SceneOptions& options, const Input& input);

/// What of the scene VTK's own mappers do not know, in a few words each: light that is scattered in
/// the medium and its shadows, light that the medium emits, sky and ground, an environment map, fog.
std::vector<std::string> left_out_by_stock(const SceneOptions& options);

/// The rest of the scene, as near as VTK's own mappers come to it. Classified values: the same
/// transfer functions and lights. A density: an opacity that makes the same extinction, black where it
/// only absorbs; where it scatters its albedo is the colour, shaded by the gradient as a diffuse
/// surface in the scene's lights (ambient 0, diffuse 1, specular 0). Its volume has no mapper.
VolumeScene stock_scene(const VolumeScene& scene);

}
