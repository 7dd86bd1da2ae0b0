// Where parallel work is done with so many threads.
#pragma once

#include <tbb/task_arena.h>

#include <memory>
#include <utility>

namespace brume
{

/// An arena of that many threads, which nobody else works in while this lives: execute() does its
/// part of the work in the calling thread, and waits for nobody else's. Threads that render at once
/// have one each.
///
/// Arenas are lent, and taken back when this ends: oneTBB 2021.8 does not give back some 7 KB of
/// each arena that is made, and a window makes hundreds of pictures a minute. As many are made as
/// are in use at once.
class ThreadArena
{
public:
  /// 0 or less: as many threads as processors.
  explicit ThreadArena(int threads);
  ~ThreadArena();
  ThreadArena(const ThreadArena&) = delete;
  ThreadArena& operator=(const ThreadArena&) = delete;

  /// Runs `work` in the calling thread; what it splits (tbb::parallel_for) the arena's other
  /// threads help with.
  template <class Work>
  void execute(Work&& work)
  {
    this->Arena->execute(std::forward<Work>(work));
  }

private:
  int Threads;
  std::unique_ptr<tbb::task_arena> Arena;
};

}
