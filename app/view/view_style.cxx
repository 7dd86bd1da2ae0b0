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

bool ViewStyle::TakesPress(Button button)
{
  const bool another = this->Holder != Button::None && this->Holder != button;
  if (another || this->GetState() != VTKIS_NONE)
  {
    return true; // a button more does not change what the first one holds
  }
  const Place place = place_of(this->Interactor);
  const bool taken = this->Press && this->Press(place.x,
                                      place.y,
                                      button == Button::Right,
                                      this->Interactor->GetRepeatCount() > 0);
  this->Holder = taken ? button : Button::None;
  return taken;
}

bool ViewStyle::TakesRelease(Button button)
{
  if (this->Holder == Button::None)
  {
    return false;
  }
  if (this->Holder == button)
  {
    this->LetGo();
  }
  return true;
}

void ViewStyle::LetGo()
{
  if (this->Holder != Button::None)
  {
    this->Holder = Button::None;
    if (this->Release)
    {
      this->Release();
    }
  }
}

bool ViewStyle::TakesWheel(int steps)
{
  const Place place = place_of(this->Interactor);
  return this->Wheel && this->Wheel(place.x, place.y, steps);
}

void ViewStyle::OnLeftButtonDown()
{
  if (!this->TakesPress(Button::Left))
  {
    this->Superclass::OnLeftButtonDown();
  }
  this->Done();
}

void ViewStyle::OnLeftButtonUp()
{
  if (!this->TakesRelease(Button::Left))
  {
    this->Superclass::OnLeftButtonUp();
  }
  this->Done();
}

void ViewStyle::OnMiddleButtonDown()
{
  if (this->Holder == Button::None)
  {
    this->Superclass::OnMiddleButtonDown();
  }
  this->Done();
}

void ViewStyle::OnRightButtonDown()
{
  if (!this->TakesPress(Button::Right))
  {
    this->Superclass::OnRightButtonDown();
  }
  this->Done();
}

void ViewStyle::OnRightButtonUp()
{
  if (!this->TakesRelease(Button::Right))
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
