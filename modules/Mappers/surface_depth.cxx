#include "surface_depth.h"

#include "vtkBrumeFog.h"

#include "vtkPropCollection.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <cstddef>

namespace brume
{

std::vector<float> read_surface_depth(
  vtkRenderer* renderer, int left, int bottom, int width, int height)
{
  // Only where something else is shown that may have written depth.
  std::vector<float> result;
  vtkPropCollection* props = renderer->GetViewProps();
  vtkCollectionSimpleIterator it;
  bool others = renderer->GetPreserveDepthBuffer() || renderer->GetLayer() > 0;
  props->InitTraversal(it);
  while (vtkProp* prop = props->GetNextProp(it))
  {
    others = others || (prop->GetVisibility() && !vtkVolume::SafeDownCast(prop) &&
                         !vtkBrumeFog::SafeDownCast(prop));
  }
  if (!others)
  {
    return result;
  }
  result.resize(static_cast<std::size_t>(width) * height);
  renderer->GetRenderWindow()->GetZbufferData(
    left, bottom, left + width - 1, bottom + height - 1, result.data());
  for (float& depth : result)
  {
    depth = 2.0f * depth - 1.0f; // the depth buffer's [0, 1] to the clip cube's [-1, 1]
  }
  return result;
}

}
