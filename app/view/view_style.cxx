#include "view_style.h"

#include "vtkObjectFactory.h"
#include "vtkRenderWindowInteractor.h"

namespace brume::app
{

vtkStandardNewMacro(ViewStyle);

namespace
{

struct Place
{
  int x;
  int y;
};
Place place_of(vtkRenderWindowInteractor* interactor)
{
  const int* position = interactor->GetEventPosition();
  return { position[0], interactor->GetSize()[1] - 1 - position[1] };
}

}

bool ViewStyle::TakesPress(bool right_button)
{
  if (this->GetState() != VTKIS_NONE)
  {
    return true; // a button more does not change what the first one holds
  }
  const Place place = place_of(this->Interactor);
  return this->Press &&
    this->Press(place.x, place.y, right_button, this->Interactor->GetRepeatCount() > 0);
}

bool ViewStyle::TakesRelease()
{
  const bool taken = this->Release && this->Release();
  return taken && this->GetState() == VTKIS_NONE; // else the camera must be told, too
}

bool ViewStyle::TakesWheel(int steps)
{
  const Place place = place_of(this->Interactor);
  return this->Wheel && this->Wheel(place.x, place.y, steps);
}

void ViewStyle::OnLeftButtonDown()
{
  if (!this->TakesPress(false))
  {
    this->Superclass::OnLeftButtonDown();
  }
  this->Done();
}

void ViewStyle::OnLeftButtonUp()
{
  if (!this->TakesRelease())
  {
    this->Superclass::OnLeftButtonUp();
  }
  this->Done();
}

void ViewStyle::OnMiddleButtonDown()
{
  this->Superclass::OnMiddleButtonDown();
  this->Done();
}

void ViewStyle::OnRightButtonDown()
{
  if (!this->TakesPress(true))
  {
    this->Superclass::OnRightButtonDown();
  }
  this->Done();
}

void ViewStyle::OnRightButtonUp()
{
  if (!this->TakesRelease())
  {
    this->Superclass::OnRightButtonUp();
  }
  this->Done();
}

void ViewStyle::OnMouseMove()
{
  const Place place = place_of(this->Interactor);
  if (!this->Drag || !this->Drag(place.x, place.y))
  {
    this->Superclass::OnMouseMove();
  }
  this->Done();
}

void ViewStyle::OnMouseWheelForward()
{
  if (!this->TakesWheel(1))
  {
    this->Superclass::OnMouseWheelForward();
  }
  this->Done();
}

void ViewStyle::OnMouseWheelBackward()
{
  if (!this->TakesWheel(-1))
  {
    this->Superclass::OnMouseWheelBackward();
  }
  this->Done();
}

void ViewStyle::OnKeyPress()
{
  const char* symbol = this->Interactor->GetKeySym();
  if (symbol && this->Key)
  {
    this->Key(symbol, this->Interactor->GetControlKey() != 0);
  }
  this->Done();
}

}
