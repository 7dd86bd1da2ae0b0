// The mouse in the window of `brume view`: VTK's trackball camera, where nothing else takes it.
#pragma once

#include "vtkInteractorStyleTrackballCamera.h"

#include <functional>
#include <string>

namespace brume::app
{

/// Left turns, middle or Shift + left shifts, right or the wheel comes nearer, as in VTK. Places are
/// pixels from the window's upper left corner.
class ViewStyle : public vtkInteractorStyleTrackballCamera
{
public:
  static ViewStyle* New();
  vtkTypeMacro(ViewStyle, vtkInteractorStyleTrackballCamera);

  /// Whether it takes the mouse; else the camera does. Until the button is released no other one does anything.
  std::function<bool(int x, int y, bool right_button, bool twice)> Press;
  std::function<bool(int x, int y)> Drag;
  std::function<void()> Release; ///< of the button whose press it took
  std::function<bool(int x, int y, int steps)> Wheel; ///< steps away from the hand above 0
  /// A key by X's name, with whether Control is held.
  std::function<void(const std::string& symbol, bool control)> Key;
  /// After any event that the camera or one of these took.
  std::function<void()> Done;

  /// Forgets the button that holds something: somebody else hears its release.
  void LetGo();

  void OnLeftButtonDown() override;
  void OnLeftButtonUp() override;
  void OnMiddleButtonDown() override;
  void OnRightButtonDown() override;
  void OnRightButtonUp() override;
  void OnMouseMove() override;
  void OnMouseWheelForward() override;
  void OnMouseWheelBackward() override;
  void OnKeyPress() override;
  void OnChar() override {}  // VTK's own keys are other things here
  void OnTimer() override {} // the window's timer is not the camera's

protected:
  ViewStyle() = default;
  ~ViewStyle() override = default;

private:
  enum class Button
  {
    None,
    Left,
    Right,
  };
  bool TakesPress(Button button);
  bool TakesRelease(Button button);
  bool TakesWheel(int steps);

  Button Holder = Button::None; ///< whose press was taken, until its release
};

}
