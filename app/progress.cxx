#include "progress.h"

#include <algorithm>
#include <cstdio>

#include <unistd.h>

namespace brume::app
{

ProgressBar::ProgressBar(const std::string& label, bool wanted)
  : label_(label)
  , on_(wanted && isatty(STDERR_FILENO) == 1)
  , next_(Clock::now() + std::chrono::seconds(1))
{
}

ProgressBar::~ProgressBar()
{
  clear();
}

void ProgressBar::update(double done)
{
  if (!on_ || Clock::now() < next_)
  {
    return;
  }
  next_ = Clock::now() + std::chrono::milliseconds(100);
  const double part = done > 0 ? std::min(done, 1.0) : 0.0;
  constexpr int Width = 30;
  const int filled = static_cast<int>(part * Width);
  std::fprintf(stderr, "\r%s [%s%s] %3d %%\033[K", label_.c_str(),
    std::string(filled, '#').c_str(), std::string(Width - filled, ' ').c_str(),
    static_cast<int>(part * 100));
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressBar::clear()
{
  if (drawn_)
  {
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
    drawn_ = false;
  }
}

}
