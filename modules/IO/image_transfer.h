// Images from one process to another through a file without a name. Private to this module.
#pragma once

#include "vtkSmartPointer.h"

class vtkImageData;

namespace brume::io
{

/// Writes the lattice, the arrays of numbers on points and cells, and the texts of the field data, at
/// the file's place. False where the file cannot be written.
bool write_image(int file, vtkImageData* image);

/// Reads what write_image() wrote, from the file's place on; null where it is not whole. Throws
/// std::bad_alloc where memory runs out.
vtkSmartPointer<vtkImageData> read_image(int file);

}
