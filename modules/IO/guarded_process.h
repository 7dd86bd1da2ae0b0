// Work that may crash, hang or take all memory on a damaged file, in a process of its own: the last
// resort for readers of other libraries that trust what they read. Private to this module.
#pragma once

#include "voxel_reader.h" // for Progress

#include <cstddef>
#include <functional>

namespace brume::io
{

/// Memory of zeroes that this process shares with those that run_guarded() starts while it lives. Throws
/// std::bad_alloc where there is none. Pages that nobody writes take none.
class SharedMemory
{
public:
  explicit SharedMemory(std::size_t bytes);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  void* data() const { return data_; }

private:
  std::size_t bytes_;
  void* data_;
};

/// How such a process ended.
enum class GuardEnd
{
  Finished, ///< by itself, with a status
  Crashed,
  TooLate,
  TooLarge,
  NotStarted,
  Stopped ///< `progress` said so
};

struct GuardResult
{
  GuardEnd end = GuardEnd::NotStarted;
  int status = 0; ///< what the work returned, 0 to 255
};

/// Runs `work` in a copy of this process, with standard output and error closed to it. The copy has the
/// calling thread alone: `work` must not wait for others (TBB's, say). It is ended after `seconds` of processor
/// time (at least one), after 20 s and twice as long by the clock, or
/// once it holds `bytes` more than this process. One that only sleeps for three seconds is ended, too, and
/// tried once more: a thread of this process may have held a lock while it was copied. It hands out results through shared memory or an
/// open file; `progress`, which may be empty, is asked now and then with `*done`, which `work` may
/// raise through memory that both share.
GuardResult run_guarded(const std::function<int()>& work, double seconds, double bytes,
  const Progress& progress = {}, const double* done = nullptr);

/// What is to be said of an end other than Finished, as a clause.
const char* spoken_end(GuardEnd end);

}
