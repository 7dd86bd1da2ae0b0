// A display for the mappers that draw through OpenGL, on a machine that may have none.
#pragma once

#include <string>
#include <sys/types.h>

namespace brume::app
{

/// A display to render on: the user's own if DISPLAY names one that can be opened, else a private
/// virtual one, a server (Xvfb) that lives as long as this object and that only this process can
/// connect to.
///
/// VTK's X window ends the whole process when it cannot connect, so make one of these, and look at
/// available(), before the first render window. The constructor never throws for want of a display
/// and takes up to the time limit; DISPLAY is set for this process while a private server runs and
/// is put back by the destructor.
///
/// The server ends with the object, and also when the thread that made it or the process ends in
/// any other way (Linux: PR_SET_PDEATHSIG). It does not hear a terminal's Ctrl-C. Make it on the
/// main thread; it changes the environment, so make it before other threads start.
class PrivateDisplay
{
public:
  /// `seconds`: how long the server may take to start.
  explicit PrivateDisplay(double seconds = 30.0);
  ~PrivateDisplay();
  PrivateDisplay(const PrivateDisplay&) = delete;
  PrivateDisplay& operator=(const PrivateDisplay&) = delete;

  /// Whether render windows can be made.
  bool available() const { return this->Available; }
  /// Whether the display is a server of this object's own.
  bool is_private() const { return this->Server > 0; }
  /// The display's name, such as ":1"; empty when there is none.
  const std::string& name() const { return this->Name; }
  /// Why there is no display and what to install, one sentence; empty when there is one.
  const std::string& reason() const { return this->Reason; }

private:
  void start(double seconds);
  void stop();

  bool Available = false;
  std::string Name;
  std::string Reason;
  pid_t Server = -1;
  bool HadDisplay = false;
  std::string FormerDisplay;
};

}
