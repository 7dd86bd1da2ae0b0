#include "Transport/thread_arena.h"

#include <tbb/info.h>

#include <map>
#include <mutex>
#include <vector>

namespace brume
{

namespace
{

/// Arenas of one number of threads.
struct Arenas
{
  std::vector<std::unique_ptr<tbb::task_arena>> idle; ///< with room for all that were made
  std::size_t made = 0;
};

struct AllArenas
{
  std::mutex mutex;
  std::map<int, Arenas> of_threads;
};

AllArenas& all_arenas()
{
  // Never destroyed: others may draw while the program ends.
  static auto* const all = new AllArenas;
  return *all;
}

}

ThreadArena::ThreadArena(int threads)
  : Threads(threads > 0 ? threads : tbb::info::default_concurrency())
{
  {
    AllArenas& all = all_arenas();
    const std::lock_guard<std::mutex> lock(all.mutex);
    Arenas& arenas = all.of_threads[this->Threads];
    if (!arenas.idle.empty())
    {
      this->Arena = std::move(arenas.idle.back());
      arenas.idle.pop_back();
      return;
    }
    arenas.idle.reserve(++arenas.made); // to be given back without asking for memory
  }
  this->Arena = std::make_unique<tbb::task_arena>(this->Threads);
}

ThreadArena::~ThreadArena()
{
  AllArenas& all = all_arenas();
  const std::lock_guard<std::mutex> lock(all.mutex);
  all.of_threads[this->Threads].idle.push_back(std::move(this->Arena));
}

}
