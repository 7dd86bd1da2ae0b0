#include "study_clock.h"

#include "interruption.h"

#include <algorithm>
#include <cmath>

namespace brume::app
{

StudyClock::StudyClock(double seconds, bool shown)
  : Start(std::chrono::steady_clock::now())
  , Seconds(seconds)
  , Bar("study", shown)
  , End(seconds)
{
}

double StudyClock::elapsed() const
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Start).count();
}

void StudyClock::allow_at_least(double seconds)
{
  this->Seconds = std::max(this->Seconds, this->elapsed() + seconds);
}

void StudyClock::tell(const std::string& what, double expected)
{
  this->What = what;
  this->End = this->elapsed() + expected;
  this->tick();
}

bool StudyClock::tick()
{
  const double now = this->elapsed();
  const double left = std::max(0.0, this->End - now);
  this->Bar.relabel(
    this->What + ", about " + std::to_string(static_cast<long>(std::ceil(left))) + " s left");
  this->Bar.update(now + left > 0.0 ? now / (now + left) : 0.0);
  return !InterruptionWatch::requested();
}

}
