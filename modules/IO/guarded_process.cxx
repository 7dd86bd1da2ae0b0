#include "guarded_process.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <new>
#include <thread>

namespace brume::io
{

SharedMemory::SharedMemory(std::size_t bytes)
  : bytes_(bytes)
  , data_(mmap(
      nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0))
{
  if (data_ == MAP_FAILED)
  {
    throw std::bad_alloc();
  }
}

SharedMemory::~SharedMemory()
{
  munmap(data_, bytes_);
}

namespace
{

/// Bytes of memory that a process holds by itself (not shared with files or others); 0 where unknown.
double held_bytes(pid_t process)
{
  char path[64];
  std::snprintf(path, sizeof(path), "/proc/%d/statm", static_cast<int>(process));
  std::FILE* file = std::fopen(path, "r");
  if (!file)
  {
    return 0;
  }
  unsigned long total = 0, resident = 0, shared = 0;
  const int read = std::fscanf(file, "%lu %lu %lu", &total, &resident, &shared);
  std::fclose(file);
  return read == 3 ? static_cast<double>(resident - std::min(shared, resident)) *
      static_cast<double>(sysconf(_SC_PAGESIZE))
                   : 0;
}

/// Tells when a process has only slept for some seconds. The work waits for nobody: then it waits for a lock
/// that a thread of this process held while the copy was made, and which nobody will open.
class SleepWatch
{
public:
  bool sleeps_for_ever(pid_t process)
  {
    const Clock::time_point now = Clock::now();
    if (now < this->Next)
    {
      return false;
    }
    this->Next = now + std::chrono::milliseconds(250);
    char path[64];
    std::snprintf(path, sizeof(path), "/proc/%d/stat", static_cast<int>(process));
    std::FILE* file = std::fopen(path, "r");
    char state = 0;
    unsigned long user = 0, system = 0;
    // The name, in brackets, is this program's own and has none in it.
    const int read = file ? std::fscanf(file,
                              "%*d (%*[^)]) %c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu", &state,
                              &user, &system)
                          : 0;
    if (file)
    {
      std::fclose(file);
    }
    if (read != 3 || state != 'S' || user + system != this->Ticks)
    {
      this->Ticks = user + system;
      this->Since = now;
    }
    return now - this->Since > std::chrono::seconds(3);
  }

private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point Next{};
  Clock::time_point Since = Clock::now();
  unsigned long Ticks = ~0ul;
};

GuardResult run_once(const std::function<int()>& work, double seconds, double bytes,
  const Progress& progress, const double* done, bool& slept)
{
  using Clock = std::chrono::steady_clock;
  const double most = held_bytes(getpid()) + bytes;
  GuardResult result;
  std::fflush(nullptr); // what is buffered must not be written twice
  // A parent that ignores the ends of its children would never learn how this one ended.
  struct sigaction former{};
  const bool ignored = sigaction(SIGCHLD, nullptr, &former) == 0 && former.sa_handler == SIG_IGN;
  if (ignored)
  {
    std::signal(SIGCHLD, SIG_DFL);
  }
  const auto restore = [&]
  {
    if (ignored)
    {
      sigaction(SIGCHLD, &former, nullptr);
    }
  };
  const pid_t child = fork();
  if (child == 0)
  {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, 1);
    dup2(nowhere, 2);
    const rlimit none{ 0, 0 };
    setrlimit(RLIMIT_CORE, &none);
    const rlim_t quick = static_cast<rlim_t>(std::ceil(std::max(seconds, 1.0)));
    const rlimit processor{ quick, quick + 1 };
    setrlimit(RLIMIT_CPU, &processor);
    std::signal(SIGALRM, SIG_DFL);
    int status = 255;
    try
    {
      status = work();
    }
    catch (...)
    {
    }
    _exit(status);
  }
  if (child < 0)
  {
    restore();
    return result;
  }
  const Clock::time_point end = Clock::now() +
    std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(20 + 2 * seconds)); // a busy machine
  auto pause = std::chrono::microseconds(100);
  SleepWatch sleep;
  int status = 0;
  result.end = GuardEnd::Finished;
  pid_t ended = 0;
  while ((ended = waitpid(child, &status, WNOHANG)) == 0 || (ended < 0 && errno == EINTR))
  {
    const GuardEnd before = result.end;
    if (before == GuardEnd::Finished)
    {
      slept = sleep.sleeps_for_ever(child);
      result.end = slept || Clock::now() > end              ? GuardEnd::TooLate
        : held_bytes(child) > most                          ? GuardEnd::TooLarge
        : progress && !progress(done ? *done : 0) ? GuardEnd::Stopped
                                                            : GuardEnd::Finished;
      if (result.end != GuardEnd::Finished)
      {
        kill(child, SIGKILL);
      }
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::microseconds(5000));
  }
  restore();
  if (ended < 0) // somebody else has taken its end
  {
    result.end = GuardEnd::Crashed;
    return result;
  }
  if (result.end == GuardEnd::Finished)
  {
    result.end = WIFEXITED(status)                            ? GuardEnd::Finished
      : WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU ? GuardEnd::TooLate
                                                              : GuardEnd::Crashed;
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  }
  return result;
}

}

GuardResult run_guarded(const std::function<int()>& work, double seconds, double bytes,
  const Progress& progress, const double* done)
{
  bool slept = false;
  const GuardResult result = run_once(work, seconds, bytes, progress, done, slept);
  return slept ? run_once(work, seconds, bytes, progress, done, slept) : result;
}

const char* spoken_end(GuardEnd end)
{
  switch (end)
  {
    case GuardEnd::TooLate:
      return "takes too long to read";
    case GuardEnd::TooLarge:
      return "takes more memory to read than the limit";
    case GuardEnd::NotStarted:
      return "cannot be read: no process can be started for it";
    case GuardEnd::Stopped:
      return "was not read to its end";
    default:
      return "is damaged so that its reader fails";
  }
}

}
