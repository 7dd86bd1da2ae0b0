// VTK's image as the writers of files see it. Private to this module.
#pragma once

#include "image_file.h"

#include <string>

class vtkImageData;

namespace brume::io
{

/// The point scalars of an image in its place, without units; they are viewed, not copied. Throws
/// fail() with `path` for an image with no voxels, no scalars or scalars of single bits.
ImageFile view_of(vtkImageData* image, const std::string& path);

/// One of VTK's types of numbers, by its size and sign. Throws std::runtime_error for what is none,
/// such as VTK_BIT.
Scalar scalar_of_vtk(int type);

}
