#include "view_times.h"

#include <algorithm>

namespace brume::app
{

namespace
{

using Clock = std::chrono::steady_clock;

nlohmann::ordered_json summary_of(std::vector<double> seconds)
{
  nlohmann::ordered_json summary;
  summary["count"] = seconds.size();
  if (!seconds.empty())
  {
    std::sort(seconds.begin(), seconds.end());
    summary["median_ms"] = 1e3 * seconds[seconds.size() / 2];
    summary["percentile_95_ms"] = 1e3 * seconds[seconds.size() * 95 / 100];
    summary["largest_ms"] = 1e3 * seconds.back();
  }
  return summary;
}

}

double seconds_since(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

nlohmann::ordered_json summary_of(const ViewTimes& times)
{
  nlohmann::ordered_json summary;
  summary["first_picture_seconds"] = times.first_picture;
  summary["event_to_picture"] = summary_of(times.responses);
  summary["interruption"] = summary_of(times.interruptions);
  summary["refinement_without_a_look_at_input"] = summary_of(times.longest_deaf);
  return summary;
}

void UnansweredEvent::came()
{
  if (!this->Came)
  {
    this->Came = Clock::now();
  }
}

double UnansweredEvent::age() const
{
  return this->Came ? seconds_since(*this->Came) : 0.0;
}

void RefinementWatch::look(bool must_end)
{
  this->Deaf = std::max(this->Deaf, seconds_since(this->Looked));
  this->Looked = Clock::now();
  if (must_end && !this->Asked)
  {
    this->Asked = this->Looked;
  }
}

double RefinementWatch::since_look() const
{
  return seconds_since(this->Looked);
}

double RefinementWatch::age() const
{
  return seconds_since(this->Start);
}

void RefinementWatch::ended(ViewTimes& times) const
{
  times.longest_deaf.push_back(std::max(this->Deaf, seconds_since(this->Looked)));
  if (this->Asked)
  {
    times.interruptions.push_back(seconds_since(*this->Asked));
  }
}

}
