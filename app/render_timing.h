// Seconds of repeated renders.
#pragma once

#include "interruption.h"

#include "Analysis/comparison.h"

#include <vector>

namespace brume::app
{

/// Fills in median, min, max and repetitions from the seconds of single renders, at least one.
void summarise(std::vector<double> seconds, Timing& timing);

/// Runs render(), which returns its seconds, once to warm up and `repetitions` times for the clock.
/// `command` is who was interrupted.
template <class Render>
Timing time_renders(int repetitions, const char* command, const Render& render)
{
  Timing timing;
  timing.warm_up = render();
  std::vector<double> seconds;
  for (int i = 0; i < repetitions; ++i)
  {
    InterruptionWatch::check(command);
    seconds.push_back(render());
  }
  summarise(seconds, timing);
  return timing;
}

}
