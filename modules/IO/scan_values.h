// From a header's stored numbers to the values that they mean, in VTK's types. Private to this module.
#pragma once

#include "scan_header.h"

#include "vtkSmartPointer.h"

class vtkDataArray;

namespace brume::io
{

/// VTK's name of a stored number's type.
int vtk_type(Scalar scalar);
/// Whether values are other than the stored numbers.
bool rescales(const ScanHeader& header);
/// VTK's name of the type that values have once slope and intercept are applied.
int value_type(const ScanHeader& header);
/// What reading the volume takes at the most, in bytes: stored numbers and values, and a second copy
/// of numbers whose components are to be interleaved.
double memory_need(const ScanHeader& header);
/// The values of stored numbers, in an array of value_type(). A rounding to whole numbers never
/// leaves 16 bits.
vtkSmartPointer<vtkDataArray> rescaled(vtkDataArray* stored, const ScanHeader& header);

}
