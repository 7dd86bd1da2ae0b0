// How much time a study has taken, has left, and shows.
#pragma once

#include "progress.h"

#include <chrono>
#include <string>

namespace brume::app
{

/// Counts from when it is made.
class StudyClock
{
public:
  /// `seconds` that the study may take; `shown`: whether there is a bar.
  StudyClock(double seconds, bool shown);

  double elapsed() const;
  /// Of what the study may take; negative beyond.
  double left() const { return this->Seconds - this->elapsed(); }
  /// Gives what follows at least this many seconds from now on.
  void allow_at_least(double seconds);

  /// What is being done, and how long all that follows is expected to take: "truth, about 80 s left".
  void tell(const std::string& what, double expected);
  /// Draws the bar anew, now and then. Returns false when the user asked to stop.
  bool tick();
  /// Wipes the bar.
  void clear() { this->Bar.clear(); }

private:
  std::chrono::steady_clock::time_point Start;
  double Seconds;
  ProgressBar Bar;
  std::string What;
  double End = 0.0; ///< when all is expected to be done
};

}
