// How far opaque geometry is, from a window's depth buffer. Internal to Mappers.
#ifndef surface_depth_h
#define surface_depth_h

#include <vector>

class vtkRenderer;

namespace brume
{

/// Normalised device depths, in [-1, 1], of a rectangle of the renderer's window, as
/// Scene::surface_depth has them; empty where nothing can have written any.
std::vector<float> read_surface_depth(
  vtkRenderer* renderer, int left, int bottom, int width, int height);

}

#endif
