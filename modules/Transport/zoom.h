// Views that are filled by what there is to be seen. Internal to Transport.
#pragma once

#include "Transport/scene.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace brume
{

/// The corners of the boxes of a scene's first `volumes` volumes, in the world; eight each.
std::vector<glm::dvec3> corners_of_volumes(const Scene& scene, std::size_t volumes);

/// The scene's view, clip from world, cut to the rectangle that the boxes of its first `volumes`
/// volumes fill. The box of a camera inside it has none: the whole view then.
glm::dmat4 zoomed_to_volumes(const Scene& scene, std::size_t volumes);

/// The same of what can be seen of all volumes: the boxes around their visible bricks, where the
/// brick ranges are known (Volume::ranges) and no mask says otherwise; else as above.
glm::dmat4 zoomed_to_matter(const Scene& scene);

}
