#include "interruption.h"

#include "command.h"

#include <csignal>

namespace brume::app
{

namespace
{

volatile std::sig_atomic_t interrupted = 0;

extern "C" void note_interruption(int signal)
{
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

}

InterruptionWatch::InterruptionWatch()
{
  interrupted = 0;
  std::signal(SIGINT, note_interruption);
  std::signal(SIGTERM, note_interruption);
}

InterruptionWatch::~InterruptionWatch()
{
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool InterruptionWatch::requested()
{
  return interrupted != 0;
}

void InterruptionWatch::check(const char* place)
{
  if (requested())
  {
    throw Failure(place, "interrupted, nothing was written", "run it again to the end");
  }
}

}
