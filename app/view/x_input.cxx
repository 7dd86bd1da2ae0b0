#include "x_input.h"

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/keysym.h>

#include <cstdlib>

namespace brume::app
{

namespace
{

int note_input(Display*, XEvent* event, XPointer found)
{
  switch (event->type)
  {
    case KeyPress:
    case ButtonPress:
    case ButtonRelease:
    case MotionNotify:
    case ConfigureNotify:
    case ClientMessage:
      *reinterpret_cast<bool*>(found) = true;
      break;
    default:
      break;
  }
  return False; // none is taken
}

int is_escape(Display*, XEvent* event, XPointer)
{
  return event->type == KeyPress && XLookupKeysym(&event->xkey, 0) == XK_Escape;
}

}

bool input_waits(void* display)
{
  if (!display)
  {
    return false;
  }
  bool found = false;
  XEvent event;
  XCheckIfEvent(
    static_cast<Display*>(display), &event, note_input, reinterpret_cast<XPointer>(&found));
  return found;
}

bool take_escape(void* display)
{
  bool found = false;
  XEvent event;
  while (
    display && XCheckIfEvent(static_cast<Display*>(display), &event, is_escape, nullptr) == True)
  {
    found = true;
  }
  return found;
}

bool display_opens()
{
  Display* display = XOpenDisplay(nullptr);
  if (display)
  {
    XCloseDisplay(display);
  }
  return display != nullptr;
}

double scale_of_display()
{
  Display* display = XOpenDisplay(nullptr);
  if (!display)
  {
    return 1.0;
  }
  const char* text = XGetDefault(display, "Xft", "dpi");
  const double dots = text ? std::atof(text) : 0.0;
  XCloseDisplay(display);
  return dots >= 48.0 && dots <= 960.0 ? dots / 96.0 : 1.0;
}

}
