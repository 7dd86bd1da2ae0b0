// Ctrl-C while something long is under way.
#pragma once

namespace brume::app
{

/// While one of these lives, the first SIGINT or SIGTERM only takes note, so that the work can stop
/// in order and leave nothing half-done behind; a second one, of either kind, ends the program at
/// once. One at a time; the former handlers are put back.
class InterruptionWatch
{
public:
  InterruptionWatch();
  ~InterruptionWatch();
  InterruptionWatch(const InterruptionWatch&) = delete;
  InterruptionWatch& operator=(const InterruptionWatch&) = delete;

  /// Whether the user asked to stop.
  static bool requested();
  /// Throws Failure when the user asked to stop. `place` is what was being worked on.
  static void check(const char* place);

private:
  using Handler = void (*)(int);
  Handler FormerInterrupt;
  Handler FormerTerminate;
};

}
