// Real events of the X server to a window, from a connection of their own: any thread may send
// them.
#pragma once

#include <string>

namespace x_events
{

class Sender
{
public:
  /// `window`: vtkRenderWindow::GetGenericWindowId(), on the display that DISPLAY names. Throws
  /// std::runtime_error where that cannot be opened.
  explicit Sender(void* window);
  ~Sender();
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  // Pixels from the window's upper left corner; each has reached the server when the call returns.
  void press(int button, int x, int y);
  void release(int button, int x, int y);
  /// The pointer itself goes there.
  void move(int x, int y);
  /// Press and release of a key by X's name; throws std::runtime_error for one that is not on the
  /// keyboard.
  void key(const std::string& symbol, bool control = false);
  /// As a user draws at the window's corner.
  void resize(int width, int height);

private:
  struct Internals;
  Internals* Internal;
};

}
