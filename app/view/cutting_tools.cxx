#include "cutting_tools.h"

#include "vtkBoxRepresentation.h"
#include "vtkBoxWidget2.h"
#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkImplicitPlaneRepresentation.h"
#include "vtkImplicitPlaneWidget2.h"
#include "vtkNew.h"
#include "vtkProperty.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"

#include <algorithm>
#include <cmath>

namespace brume::app
{

namespace
{

/// No thinner than this part of the volume's edge.
constexpr double thinnest = 1e-3;

}

struct CuttingTools::Internals
{
  vtkNew<vtkBoxWidget2> Box;
  vtkNew<vtkBoxRepresentation> BoxShape;
  vtkNew<vtkImplicitPlaneWidget2> Plane;
  vtkNew<vtkImplicitPlaneRepresentation> PlaneShape;
  vtkNew<vtkCallbackCommand> Ear;
  CuttingTools* Owner = nullptr;
  Bounds BoxVolume{};
  Bounds BoxNow{}; ///< what the box was told, or told itself
  Bounds PlaneVolume{};
  bool PlanePlaced = false; ///< in that volume

  void place_box(const Bounds& volume, const Bounds& now)
  {
    this->BoxVolume = volume;
    this->BoxNow = now;
    Bounds place = now;
    this->BoxShape->PlaceWidget(place.data());
  }

  /// The plane's frame around a volume, with the plane where it was as far as it meets that.
  void move_plane(const Bounds& volume)
  {
    CuttingTools::Plane plane = this->plane();
    Bounds place = volume;
    this->PlaneVolume = volume;
    this->PlaneShape->PlaceWidget(place.data());
    double origin[3];
    double off = plane[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      origin[axis] = 0.5 * (volume[2 * axis] + volume[2 * axis + 1]);
      off += plane[axis] * origin[axis];
    }
    bool meets = true;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double foot = origin[axis] - off * plane[axis]; // the normal's length is 1
      origin[axis] = std::clamp(foot, volume[2 * axis], volume[2 * axis + 1]);
      meets = meets && origin[axis] == foot;
    }
    this->PlaneShape->SetNormal(plane.data());
    this->PlaneShape->SetOrigin(origin);
    if (!meets)
    {
      this->told(this->Plane);
    }
  }

  CuttingTools::Plane plane()
  {
    double normal[3], origin[3];
    this->PlaneShape->GetNormal(normal);
    this->PlaneShape->GetOrigin(origin);
    return { normal[0],
      normal[1],
      normal[2],
      -(normal[0] * origin[0] + normal[1] * origin[1] + normal[2] * origin[2]) };
  }

  void told(vtkObject* caller, unsigned long event = vtkCommand::InteractionEvent)
  {
    if (event == vtkCommand::StartInteractionEvent)
    {
      if (this->Owner->Taken)
      {
        this->Owner->Taken();
      }
    }
    else if (caller == this->Box.Get() && this->Owner->Boxed)
    {
      const double* b = this->BoxShape->GetBounds();
      Bounds bounds;
      for (int axis = 0; axis < 3; ++axis)
      {
        const double low = this->BoxVolume[2 * axis];
        const double high = this->BoxVolume[2 * axis + 1];
        const double least = thinnest * (high - low);
        bounds[2 * axis] = std::clamp(b[2 * axis], low, high - least);
        bounds[2 * axis + 1] = std::clamp(b[2 * axis + 1], bounds[2 * axis] + least, high);
      }
      this->BoxNow = bounds;
      this->Owner->Boxed(bounds);
    }
    else if (caller == this->Plane.Get() && this->Owner->Planed)
    {
      this->Owner->Planed(this->plane());
    }
  }
};

CuttingTools::CuttingTools()
  : Internal(std::make_unique<Internals>())
{
  Internals& in = *this->Internal;
  in.Owner = this;
  in.Ear->SetClientData(&in);
  in.Ear->SetCallback([](vtkObject* caller, unsigned long event, void* data, void*)
    { static_cast<Internals*>(data)->told(caller, event); });
  in.Box->SetRepresentation(in.BoxShape);
  in.Box->RotationEnabledOff();
  in.Box->KeyPressActivationOff(); // keys are the window's
  in.Box->AddObserver(vtkCommand::StartInteractionEvent, in.Ear);
  in.Box->AddObserver(vtkCommand::InteractionEvent, in.Ear);
  in.BoxShape->SetPlaceFactor(1.0);
  in.BoxShape->GetOutlineProperty()->SetColor(0.46, 0.75, 1.0);
  in.BoxShape->GetSelectedOutlineProperty()->SetColor(1.0, 0.77, 0.43);
  in.Plane->SetRepresentation(in.PlaneShape);
  in.Plane->KeyPressActivationOff();
  in.Plane->AddObserver(vtkCommand::StartInteractionEvent, in.Ear);
  in.Plane->AddObserver(vtkCommand::InteractionEvent, in.Ear);
  in.PlaneShape->SetPlaceFactor(1.0);
  in.PlaneShape->DrawPlaneOff(); // it would hide the picture
  in.PlaneShape->OutlineTranslationOff();
  in.PlaneShape->ScaleEnabledOff();
}

CuttingTools::~CuttingTools()
{
  this->hide();
}

void CuttingTools::switch_box(vtkRenderWindowInteractor* interactor,
  vtkRenderer* renderer,
  const Bounds& volume,
  const Bounds& now)
{
  Internals& in = *this->Internal;
  if (in.Box->GetEnabled())
  {
    in.Box->Off();
    return;
  }
  in.Box->SetInteractor(interactor);
  in.Box->SetDefaultRenderer(renderer);
  in.place_box(volume, now);
  in.Box->On();
}

void CuttingTools::switch_plane(vtkRenderWindowInteractor* interactor,
  vtkRenderer* renderer,
  const Bounds& volume)
{
  Internals& in = *this->Internal;
  if (in.Plane->GetEnabled())
  {
    in.Plane->Off();
    return;
  }
  in.Plane->SetInteractor(interactor);
  in.Plane->SetDefaultRenderer(renderer);
  if (in.PlanePlaced && in.PlaneVolume == volume)
  {
    in.Plane->On(); // where it was
    in.told(in.Plane);
    return;
  }
  in.PlaneVolume = volume;
  in.PlanePlaced = true;
  Bounds place = volume;
  in.PlaneShape->PlaceWidget(place.data());
  in.PlaneShape->SetOrigin(
    0.5 * (volume[0] + volume[1]), 0.5 * (volume[2] + volume[3]), 0.5 * (volume[4] + volume[5]));
  // The half toward the eye goes, along the axis that is nearest to the line of sight.
  double sight[3];
  renderer->GetActiveCamera()->GetDirectionOfProjection(sight);
  int axis = 0;
  for (int i = 1; i < 3; ++i)
  {
    axis = std::abs(sight[i]) > std::abs(sight[axis]) ? i : axis;
  }
  double normal[3] = { 0.0, 0.0, 0.0 };
  normal[axis] = sight[axis] > 0.0 ? 1.0 : -1.0;
  in.PlaneShape->SetNormal(normal);
  in.Plane->On();
  in.told(in.Plane);
}

void CuttingTools::hide()
{
  this->Internal->Box->Off();
  this->Internal->Plane->Off();
  this->Internal->PlanePlaced = false;
}

void CuttingTools::follow(const Bounds& volume, const Bounds& now, bool plane_cuts)
{
  Internals& in = *this->Internal;
  if (in.Box->GetEnabled() && (volume != in.BoxVolume || now != in.BoxNow))
  {
    in.place_box(volume, now);
  }
  if (in.Plane->GetEnabled() && !plane_cuts)
  {
    in.Plane->Off();
  }
  if (in.Plane->GetEnabled() && volume != in.PlaneVolume)
  {
    in.move_plane(volume);
  }
}

std::optional<CuttingTools::Bounds> CuttingTools::box() const
{
  Internals& in = *this->Internal;
  if (!in.Box->GetEnabled())
  {
    return std::nullopt;
  }
  Bounds bounds;
  std::copy_n(in.BoxShape->GetBounds(), 6, bounds.begin());
  return bounds;
}

std::optional<CuttingTools::Plane> CuttingTools::plane() const
{
  return this->Internal->Plane->GetEnabled() ? std::optional<Plane>(this->Internal->plane())
                                             : std::nullopt;
}

}
