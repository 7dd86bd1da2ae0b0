// Work in a process of its own: how it may end.
#include "guarded_process.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <new>

using namespace brume::io;

TEST(GuardedProcess, HandsOutWhatItWrites)
{
  const SharedMemory memory(sizeof(int));
  int& shared = *new (memory.data()) int(1);
  const GuardResult result = run_guarded(
    [&]
    {
      shared = 42;
      return 7;
    },
    1, 1 << 26);
  EXPECT_EQ(result.end, GuardEnd::Finished);
  EXPECT_EQ(result.status, 7);
  EXPECT_EQ(shared, 42);
}

TEST(GuardedProcess, TellsCrashesAndEndlessWork)
{
  EXPECT_EQ(run_guarded([]() -> int { _exit(3); }, 1, 1 << 26).status, 3);
  EXPECT_EQ(run_guarded([]() -> int { raise(SIGKILL); return 0; }, 1, 1 << 26).end, GuardEnd::Crashed);
  const GuardResult endless = run_guarded(
    []
    {
      for (volatile unsigned turn = 0;; turn = turn + 1)
      {
      }
      return 0;
    },
    1, 1 << 26);
  EXPECT_EQ(endless.end, GuardEnd::TooLate);
  EXPECT_EQ(run_guarded([] { return pause(); }, 1, 1 << 26, [](double) { return false; }).end,
    GuardEnd::Stopped);
}

// As where a lock was held while the process was copied: once more, and then no longer.
TEST(GuardedProcess, TriesOnceMoreWhatOnlySleeps)
{
  const SharedMemory memory(sizeof(int));
  int& tries = *new (memory.data()) int(0);
  const auto start = std::chrono::steady_clock::now();
  GuardResult result = run_guarded(
    [&]
    {
      ++tries;
      pause();
      return 0;
    },
    1, 1 << 26);
  EXPECT_EQ(result.end, GuardEnd::TooLate);
  EXPECT_EQ(tries, 2);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  tries = 0;
  result = run_guarded(
    [&]
    {
      if (++tries == 1)
      {
        pause();
      }
      return 5;
    },
    1, 1 << 26);
  EXPECT_EQ(result.end, GuardEnd::Finished);
  EXPECT_EQ(result.status, 5);
}
