// Volumes of one renderer that are drawn as one. Internal to Mappers.
#ifndef volume_group_h
#define volume_group_h

#include "vtkNew.h"
#include "vtkWeakPointer.h"

#include <set>
#include <vector>

class vtkCallbackCommand;
class vtkProp;
class vtkRenderer;
class vtkVolume;

namespace brume
{

/// The visible volumes of the renderer that `may_join` and whose bounds meet those of `first`, or
/// of one that does, and so on; `apart`: and those that do not. Without `first`, in the renderer's
/// order.
std::vector<vtkVolume*> volumes_to_join(vtkRenderer* renderer,
  vtkVolume* first,
  bool (*may_join)(vtkVolume* first, vtkVolume* other),
  bool apart);

/// Remembers, for the rest of a renderer's frame, that a prop was drawn together with another.
class DrawnWithOthers
{
public:
  DrawnWithOthers();
  ~DrawnWithOthers();
  DrawnWithOthers(const DrawnWithOthers&) = delete;
  void operator=(const DrawnWithOthers&) = delete;

  void Remember(vtkRenderer* renderer, vtkProp* prop);
  bool Includes(vtkRenderer* renderer, vtkProp* prop) const;

private:
  void Forget();

  vtkWeakPointer<vtkRenderer> Renderer;
  std::set<vtkProp*> Props;
  vtkNew<vtkCallbackCommand> FrameOver;
};

}

#endif
