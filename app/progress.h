// A bar on the terminal for work that takes more than a moment.
#pragma once

#include <chrono>
#include <string>

namespace brume::app
{

/// Draws "label [####    ] 40 %" on standard error, from one second after it was made, and wipes it
/// when it goes. Silent when standard error is no terminal or `wanted` is false (--quiet).
class ProgressBar
{
public:
  explicit ProgressBar(const std::string& label, bool wanted = true);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// The part of the work that is done, in [0, 1]; what is outside is clamped. Draws at most ten
  /// times a second, so that it may be called often.
  void update(double done);
  /// Another label from the next update() on.
  void relabel(const std::string& label) { label_ = label; }
  /// Wipes the bar, before something else is written to the terminal.
  void clear();

private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool on_;
  bool drawn_ = false;
  Clock::time_point next_;
};

}
