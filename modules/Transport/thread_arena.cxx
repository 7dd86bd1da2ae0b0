#include "Transport/thread_arena.h"

#include <tbb/info.h>

#include <map>
#include <memory>
#include <mutex>

namespace brume
{

tbb::task_arena& thread_arena(int threads)
{
  // Never destroyed: others may draw while the program ends.
  static auto* const arenas = new std::map<int, std::unique_ptr<tbb::task_arena>>;
  static std::mutex mutex;
  const int count = threads > 0 ? threads : tbb::info::default_concurrency();
  const std::lock_guard<std::mutex> lock(mutex);
  std::unique_ptr<tbb::task_arena>& arena = (*arenas)[count];
  if (!arena)
  {
    arena = std::make_unique<tbb::task_arena>(count);
  }
  return *arena;
}

}
