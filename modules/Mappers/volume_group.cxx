#include "volume_group.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkMath.h"
#include "vtkPropCollection.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>

namespace brume
{

namespace
{

bool meet(const double a[6], const double b[6])
{
  return a[0] < b[1] && b[0] < a[1] && a[2] < b[3] && b[2] < a[3] && a[4] < b[5] && b[4] < a[5];
}

struct Candidate
{
  vtkVolume* volume = nullptr;
  double bounds[6] = { 0, 0, 0, 0, 0, 0 };
  bool joined = false;
};

}

std::vector<vtkVolume*> volumes_to_join(vtkRenderer* renderer,
  vtkVolume* first,
  bool (*may_join)(vtkVolume*, vtkVolume*),
  bool apart)
{
  std::vector<vtkVolume*> others;
  std::vector<Candidate> candidates;
  vtkPropCollection* props = renderer->GetViewProps();
  vtkCollectionSimpleIterator it;
  props->InitTraversal(it);
  while (vtkProp* prop = props->GetNextProp(it))
  {
    vtkVolume* volume = vtkVolume::SafeDownCast(prop);
    if (!volume || (volume != first && (!volume->GetVisibility() || !may_join(first, volume))))
    {
      continue;
    }
    const double* bounds = volume->GetBounds();
    if (bounds && vtkMath::AreBoundsInitialized(bounds))
    {
      candidates.emplace_back();
      candidates.back().volume = volume;
      std::copy(bounds, bounds + 6, candidates.back().bounds);
      candidates.back().joined = apart || volume == first;
    }
  }
  for (bool more = true; more;)
  {
    more = false;
    for (const Candidate& in : candidates)
    {
      for (Candidate& out : candidates)
      {
        if (in.joined && !out.joined && meet(in.bounds, out.bounds))
        {
          out.joined = true;
          more = true;
        }
      }
    }
  }
  for (const Candidate& c : candidates)
  {
    if (c.joined && c.volume != first)
    {
      others.push_back(c.volume);
    }
  }
  return others;
}

DrawnWithOthers::DrawnWithOthers()
{
  this->FrameOver->SetClientData(this);
  this->FrameOver->SetCallback([](vtkObject*, unsigned long, void* self, void*)
    { static_cast<DrawnWithOthers*>(self)->Forget(); });
}

DrawnWithOthers::~DrawnWithOthers()
{
  this->Forget();
}

void DrawnWithOthers::Remember(vtkRenderer* renderer, vtkProp* prop)
{
  if (this->Renderer != renderer)
  {
    this->Forget();
    this->Renderer = renderer;
    renderer->AddObserver(vtkCommand::StartEvent, this->FrameOver);
    renderer->AddObserver(vtkCommand::EndEvent, this->FrameOver);
  }
  this->Props.insert(prop);
}

bool DrawnWithOthers::Includes(vtkRenderer* renderer, vtkProp* prop) const
{
  return this->Renderer == renderer && this->Props.count(prop) > 0;
}

void DrawnWithOthers::Forget()
{
  if (this->Renderer)
  {
    this->Renderer->RemoveObserver(this->FrameOver);
  }
  this->Renderer = nullptr;
  this->Props.clear();
}

}
