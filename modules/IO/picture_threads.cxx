#include "picture_threads.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>
#include <string>
#include <thread>

namespace brume::io
{

namespace
{

/// Names of this process's threads, as the system has them; empty where it does not tell.
std::set<std::string> threads_now()
{
  std::set<std::string> names;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", none))
  {
    names.insert(entry.path().filename().string());
  }
  return names;
}

void ask_for_none()
{
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", -1); // 1 would be a pool of one
}

/// OpenImageIO 2.4 starts a thread before it can be told to start none, and that one holds a lock when it
/// comes and when it goes: a copy of the process that is made just then would spin on it for ever. Waits
/// until it has gone, a second at the most.
bool ask_first()
{
  const std::set<std::string> before = threads_now();
  ask_for_none();
  const auto new_ones = [&before]
  {
    const std::set<std::string> now = threads_now();
    return !std::includes(before.begin(), before.end(), now.begin(), now.end());
  };
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  while (new_ones() && std::chrono::steady_clock::now() < end)
  {
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  return true;
}

}

void keep_picture_threads_out()
{
  static const bool asked = ask_first();
  if (asked)
  {
    ask_for_none(); // the program may have asked for some
  }
}

}
