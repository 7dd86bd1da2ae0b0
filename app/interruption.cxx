#include "interruption.h"

#include "command.h"

#include "atomic_file.h"

#include <csignal>

namespace brume::app
{

namespace
{

volatile std::sig_atomic_t interrupted = 0;

extern "C" void note_interruption(int signal)
{
  if (interrupted)
  {
    remove_temporary_files();
    std::signal(signal, SIG_DFL);
    std::raise(signal);
    return;
  }
  interrupted = 1;
}

}

InterruptionWatch::InterruptionWatch()
{
  interrupted = 0;
  this->FormerInterrupt = std::signal(SIGINT, note_interruption);
  this->FormerTerminate = std::signal(SIGTERM, note_interruption);
}

InterruptionWatch::~InterruptionWatch()
{
  std::signal(SIGINT, this->FormerInterrupt);
  std::signal(SIGTERM, this->FormerTerminate);
  interrupted = 0;
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
