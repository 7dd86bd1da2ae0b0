// What a mapper cuts away. Internal to Mappers.
#ifndef regions_from_vtk_h
#define regions_from_vtk_h

#include "Transport/scene.h"

#include <vector>

class vtkPlane;
class vtkVolumeMapper;

namespace brume
{
class GridFromVTK;

/// The mapper's cropping planes, from the data's coordinates to index space.
///
/// They lie across the axes of the data's coordinates; index space has them across its own. Where
/// the image's direction only swaps and turns axes the two are the same planes, and the regions are
/// renamed. Any other direction is taken as the nearest such one, about the image's origin.
Cropping cropping_from_vtk(vtkVolumeMapper* mapper, const GridFromVTK& grid);

/// (a, b, c, d) of a x + b y + c z + d, positive on the side that the normal points to.
glm::dvec4 plane_from_vtk(vtkPlane* plane);

/// The mapper's clipping planes: what lies on the side that a plane's normal points to stays.
std::vector<glm::dvec4> clipping_planes_from_vtk(vtkVolumeMapper* mapper);

}

#endif
