// A render window that can be asked to stop.
#pragma once

#include "vtkSmartPointer.h"

class vtkRenderWindow;

namespace brume::app
{

/// A window that invokes AbortCheckEvent whenever what it renders looks whether to go on: VTK's CPU
/// mapper does so once a row. Other windows of VTK pass that on five times a second at the most, so
/// that whoever ends a render waits for a fifth of a second.
vtkSmartPointer<vtkRenderWindow> make_prompt_window();

}
