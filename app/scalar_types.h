// Types of numbers by name, and volumes from one to another.
#pragma once

#include <string>
#include <vector>

class vtkImageData;

namespace brume::app
{

/// uint8, int8, uint16, int16, uint32, int32, float, double.
const std::vector<std::string>& scalar_types();

/// Turns the image's scalars into a type of that name: whole numbers are rounded to the nearest
/// (ties away from 0) and held to the type's range, what is not a number becomes 0 in them. Returns
/// what that changed, a line each. Does nothing where they are of that type.
std::vector<std::string> convert_scalars(vtkImageData* image, const std::string& type);

}
