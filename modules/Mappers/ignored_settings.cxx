#include "ignored_settings.h"

#include "scene_from_vtk.h"

#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

namespace brume
{

std::vector<std::string> ignored_settings(
  vtkVolume* volume, const MaskSettings& mask, int components)
{
  std::vector<std::string> names;
  const auto ignored = [&names](bool is, const char* setting)
  {
    if (is)
    {
      names.emplace_back(setting);
    }
  };
  vtkVolumeProperty* property = volume->GetProperty();
  const bool dependent = components > 1 && !property->GetIndependentComponents();
  ignored(property->GetUseClippedVoxelIntensity() != 0, "UseClippedVoxelIntensity");
  const bool two_dimensional = property->GetTransferFunctionMode() == vtkVolumeProperty::TF_2D;
  ignored(two_dimensional && dependent, "TransferFunctionMode TF_2D of dependent components");
  if (mask.image && mask.label_map)
  {
    ignored(components > 1 && !dependent && property->GetNumberOfLabels() > 0,
      "MaskInput as a label map of independent components");
    ignored(property->GetNumberOfLabels() > 0 && two_dimensional && !dependent,
      "MaskInput as a label map with TransferFunctionMode TF_2D");
    if (dependent && components == 4)
    {
      for (int label : property->GetLabelMapLabels())
      {
        if (property->GetLabelColor(label))
        {
          ignored(true, "LabelColor of four dependent components");
          break;
        }
      }
    }
  }
  return names;
}

}
