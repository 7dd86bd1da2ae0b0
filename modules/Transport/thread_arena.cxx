#include "Transport/thread_arena.h"

#include <tbb/info.h>

#include <map>
#include <mutex>
#include <vector>

namespace brume
{

namespace
{

/// The arenas that nobody works in, by their threads.
struct IdleArenas
{
  std::mutex mutex;
  std::map<int, std::vector<std::unique_ptr<tbb::task_arena>>> of_threads;
};

IdleArenas& idle_arenas()
{
  // Never destroyed: others may draw while the program ends.
  static auto* const idle = new IdleArenas;
  return *idle;
}

}

ThreadArena::ThreadArena(int threads)
  : Threads(threads > 0 ? threads : tbb::info::default_concurrency())
{
  IdleArenas& idle = idle_arenas();
  {
    const std::lock_guard<std::mutex> lock(idle.mutex);
    std::vector<std::unique_ptr<tbb::task_arena>>& arenas = idle.of_threads[this->Threads];
    if (!arenas.empty())
    {
      this->Arena = std::move(arenas.back());
      arenas.pop_back();
      return;
    }
  }
  this->Arena = std::make_unique<tbb::task_arena>(this->Threads);
}

ThreadArena::~ThreadArena()
{
  IdleArenas& idle = idle_arenas();
  const std::lock_guard<std::mutex> lock(idle.mutex);
  idle.of_threads[this->Threads].push_back(std::move(this->Arena));
}

}
