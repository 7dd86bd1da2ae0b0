// Transfer functions as tables. Internal to Mappers.
#ifndef classification_from_vtk_h
#define classification_from_vtk_h

#include "Transport/scene.h"

#include <string>

class vtkVolumeProperty;

namespace brume
{
class GridFromVTK;

/// The functions of one component. The tables cover the values between the functions' end nodes, or
/// the `whole` of the data's, as tables that are to match those of labels must. Returns an empty
/// string, or what is wrong and what to do.
std::string classification_from_vtk(vtkVolumeProperty* property,
  const GridFromVTK& grid,
  int volume,
  bool whole,
  Classification& result);

/// The functions of one label of a mask, over the volume's own where it has none, and mixed with
/// them: `factor` 1 for the label's alone. `nodes`: of its tables, which cover the whole data.
Classification label_classification_from_vtk(vtkVolumeProperty* property,
  const GridFromVTK& grid,
  int label,
  double factor,
  int nodes);

/// The latest change of the functions of labels, which vtkVolumeProperty::GetMTime does not tell.
unsigned long label_functions_time(vtkVolumeProperty* property);

}

#endif
