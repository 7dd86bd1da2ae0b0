// How long the window of `brume view` takes to answer.
#pragma once

#include <nlohmann/json.hpp>

#include <chrono>
#include <optional>
#include <vector>

namespace brume::app
{

/// In seconds.
struct ViewTimes
{
  double first_picture = 0.0;        ///< from the start to the first picture on the window
  std::vector<double> responses;     ///< from an event to its picture on the window, one a picture
  std::vector<double> interruptions; ///< from asking a refinement to end to its end
  /// Of each refinement, the longest time in which it did not look for what the user does.
  std::vector<double> longest_deaf;
};

/// Count, median, 95th percentile and largest, in milliseconds, of each of these; the first picture
/// in seconds. What `brume view --times` writes.
nlohmann::ordered_json summary_of(const ViewTimes& times);

/// The first event that is not on the window yet.
class UnansweredEvent
{
public:
  /// An event came; those after it count as one with it.
  void came();
  bool waits() const { return this->Came.has_value(); }
  /// Seconds since it came; 0 where there is none.
  double age() const;
  /// It is on the window.
  void answered() { this->Came.reset(); }

private:
  std::optional<std::chrono::steady_clock::time_point> Came;
};

/// Of one refinement: how often it looks for input, and how soon it ends when it is asked to.
class RefinementWatch
{
public:
  /// It looks for input now, and `must_end` is what it finds.
  void look(bool must_end);
  /// Seconds since it looked last.
  double since_look() const;
  bool asked_to_end() const { return this->Asked.has_value(); }
  /// Seconds since it began.
  double age() const;
  /// It has ended; adds its times to the others.
  void ended(ViewTimes& times) const;

private:
  std::chrono::steady_clock::time_point Start = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point Looked = Start;
  std::optional<std::chrono::steady_clock::time_point> Asked;
  double Deaf = 0.0;
};

/// Seconds since then.
double seconds_since(std::chrono::steady_clock::time_point start);

}
