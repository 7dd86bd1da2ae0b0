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

/// Tells such a window of rows that are cast next, so many by this thread and so many by others; 0, 0: of no
/// more. VTK's CPU mapper gives each thread its rows beforehand, and its caller, through with its own,
/// looked at nothing until the others were: a quarter of a second now and then. So this thread's last row
/// waits until theirs are all begun, and AbortCheckEvents go on. Threads that begin none for 2 s are not
/// waited for.
void share_rows(vtkRenderWindow* prompt_window, int own, int others);

}
