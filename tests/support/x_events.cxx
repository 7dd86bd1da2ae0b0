// Apart from the tests, as X's headers define words of everybody's.
#include "x_events.h"

#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <stdexcept>

namespace x_events
{

struct Sender::Internals
{
  Display* display = nullptr;
  Window window = 0;
  unsigned held = 0; ///< buttons' masks

  template <class Event>
  void fill(Event& event, int type, int x, int y, unsigned state)
  {
    event.type = type;
    event.display = this->display;
    event.window = this->window;
    event.root = DefaultRootWindow(this->display);
    event.subwindow = 0;
    event.time = CurrentTime;
    event.x = event.x_root = x;
    event.y = event.y_root = y;
    event.state = state;
    event.same_screen = True;
  }
  void send(XEvent& event, long mask)
  {
    XSendEvent(this->display, this->window, False, mask, &event);
    XSync(this->display, False);
  }
  void button(int type, int button, int x, int y)
  {
    XEvent event{};
    this->fill(event.xbutton, type, x, y, this->held);
    event.xbutton.button = static_cast<unsigned>(button);
    this->send(event, type == ButtonPress ? ButtonPressMask : ButtonReleaseMask);
    const unsigned mask = button >= 1 && button <= 3 ? Button1Mask << (button - 1) : 0;
    this->held = type == ButtonPress ? this->held | mask : this->held & ~mask;
  }
};

Sender::Sender(void* window)
  : Internal(new Internals)
{
  this->Internal->display = XOpenDisplay(nullptr);
  this->Internal->window = reinterpret_cast<Window>(window);
  if (!this->Internal->display)
  {
    delete this->Internal;
    throw std::runtime_error("the display cannot be opened");
  }
}

Sender::~Sender()
{
  XCloseDisplay(this->Internal->display);
  delete this->Internal;
}

void Sender::press(int button, int x, int y)
{
  this->Internal->button(ButtonPress, button, x, y);
}

void Sender::release(int button, int x, int y)
{
  this->Internal->button(ButtonRelease, button, x, y);
}

void Sender::move(int x, int y)
{
  // VTK asks the server where the pointer is: it has to be there.
  XWarpPointer(this->Internal->display, 0, this->Internal->window, 0, 0, 0, 0, x, y);
  XSync(this->Internal->display, False);
}

void Sender::key(const std::string& symbol, bool control)
{
  const KeySym sym = XStringToKeysym(symbol.c_str());
  const KeyCode code = sym == NoSymbol ? 0 : XKeysymToKeycode(this->Internal->display, sym);
  if (code == 0)
  {
    throw std::runtime_error(symbol + ": no such key");
  }
  unsigned state = control ? ControlMask : 0;
  // Which of the key's levels has it
  int count = 0;
  KeySym* levels = XGetKeyboardMapping(this->Internal->display, code, 1, &count);
  if (count > 1 && levels[0] != sym && levels[1] == sym)
  {
    state |= ShiftMask;
  }
  XFree(levels);
  for (const int type : { KeyPress, KeyRelease })
  {
    XEvent event{};
    this->Internal->fill(event.xkey, type, 10, 10, state);
    event.xkey.keycode = code;
    this->Internal->send(event, type == KeyPress ? KeyPressMask : KeyReleaseMask);
  }
}

void Sender::resize(int width, int height)
{
  XResizeWindow(this->Internal->display,
    this->Internal->window,
    static_cast<unsigned>(width),
    static_cast<unsigned>(height));
  XSync(this->Internal->display, False);
}

}
