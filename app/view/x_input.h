// What waits in an X window's queue. Apart, as X's headers define words of everybody's.
#pragma once

namespace brume::app
{

/// Whether the user has done something that a window on this X display (vtkRenderWindow::
/// GetGenericDisplayId) has not been told yet: keys, buttons, the pointer's moves, another size.
/// Takes nothing from the queue. False for a null display.
bool input_waits(void* display);

/// Takes presses of Escape out of the queue, so that no window is told of them; whether there were
/// any.
bool take_escape(void* display);

/// Whether the display that DISPLAY names can be opened.
bool display_opens();

/// Dots an inch over 96 of the display that DISPLAY names, by what its settings say (the resource
/// Xft.dpi); 1 where they say nothing.
double scale_of_display();

}
