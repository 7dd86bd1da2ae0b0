#include "regions_from_vtk.h"

#include "grid_from_vtk.h"

#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkVolumeMapper.h"

#include <algorithm>
#include <cmath>

namespace brume
{

namespace
{

/// For each axis of the image the axis of the data that it runs along, and whether backwards.
struct Axes
{
  int data[3] = { 0, 1, 2 };
  bool backwards[3] = { false, false, false };
};

Axes nearest_axes(const double direction[9])
{
  Axes axes;
  bool image_taken[3] = { false, false, false };
  bool data_taken[3] = { false, false, false };
  for (int pair = 0; pair < 3; ++pair)
  {
    double best = -1.0;
    int image = 0;
    int data = 0;
    for (int d = 0; d < 3; ++d)
    {
      for (int i = 0; i < 3; ++i)
      {
        const double alike = std::abs(direction[3 * d + i]);
        if (!image_taken[i] && !data_taken[d] && alike > best)
        {
          best = alike;
          image = i;
          data = d;
        }
      }
    }
    image_taken[image] = data_taken[data] = true;
    axes.data[image] = data;
    axes.backwards[image] = direction[3 * data + image] < 0.0;
  }
  return axes;
}

}

Cropping cropping_from_vtk(vtkVolumeMapper* mapper, const GridFromVTK& grid)
{
  Cropping cropping;
  cropping.enabled = mapper->GetCropping() != 0;
  if (!cropping.enabled)
  {
    return cropping;
  }
  const double* planes = mapper->GetCroppingRegionPlanes();
  const Axes axes = nearest_axes(grid.Direction);
  for (int image = 0; image < 3; ++image)
  {
    const int data = axes.data[image];
    const double sign = axes.backwards[image] ? -1.0 : 1.0;
    double at[2];
    for (int side = 0; side < 2; ++side)
    {
      at[side] = sign * (planes[2 * data + side] - grid.Origin[data]) / grid.Spacing[image] -
                 grid.First[image];
    }
    cropping.lower[image] = std::min(at[0], at[1]);
    cropping.upper[image] = std::max(at[0], at[1]);
  }
  const auto flags = static_cast<std::uint32_t>(mapper->GetCroppingRegionFlags());
  cropping.regions = 0;
  for (int region = 0; region < 27; ++region)
  {
    const int along_image[3] = { region % 3, region / 3 % 3, region / 9 };
    int along_data[3];
    for (int image = 0; image < 3; ++image)
    {
      along_data[axes.data[image]] =
        axes.backwards[image] ? 2 - along_image[image] : along_image[image];
    }
    const int bit = along_data[0] + 3 * along_data[1] + 9 * along_data[2];
    cropping.regions |= (flags >> bit & 1u) << region;
  }
  return cropping;
}

glm::dvec4 plane_from_vtk(vtkPlane* plane)
{
  const double* n = plane->GetNormal();
  const double* o = plane->GetOrigin();
  return { n[0], n[1], n[2], -(n[0] * o[0] + n[1] * o[1] + n[2] * o[2]) };
}

std::vector<glm::dvec4> clipping_planes_from_vtk(vtkVolumeMapper* mapper)
{
  std::vector<glm::dvec4> result;
  vtkPlaneCollection* planes = mapper->GetClippingPlanes();
  if (!planes)
  {
    return result;
  }
  vtkCollectionSimpleIterator it;
  planes->InitTraversal(it);
  while (vtkPlane* plane = planes->GetNextPlane(it))
  {
    result.push_back(plane_from_vtk(plane));
  }
  return result;
}

}
