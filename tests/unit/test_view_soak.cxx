// Random input to `brume view` without its window: nothing throws, hangs, or grows.
// BRUME_SOAK_SECONDS takes longer than the default; BRUME_SEED other input.
#include "scene_file.h"

#include "view/viewer.h"

#include "vtkCamera.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <malloc.h>
#include <memory>
#include <optional>
#include <random>
#include <unistd.h>

using namespace brume::app;

namespace
{

double number_of(const char* variable, double otherwise)
{
  const char* text = std::getenv(variable);
  return text ? std::atof(text) : otherwise;
}

/// What the process holds, in megabytes.
struct Held
{
  double heap = 0.0; ///< in use: to the byte
  double memory =
    0.0; ///< in all, when what is free is given back: with code, stacks, other allocators' heaps
};

Held held_now()
{
  malloc_trim(0);
  const struct mallinfo2 heap = mallinfo2();
  std::ifstream file("/proc/self/statm");
  double total = 0.0;
  double resident = 0.0;
  file >> total >> resident;
  return { static_cast<double>(heap.uordblks + heap.hblkhd) / 1e6,
    resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6 };
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool sanitized = true; // freed memory is kept back, to be watched
#else
constexpr bool sanitized = false;
#endif

/// Uneven matter of 20³ voxels in a file.
std::string matter_file()
{
  const std::string path = BRUME_TEST_OUTPUT "/view-soak.nrrd";
  std::ofstream file(path, std::ios::binary);
  file
    << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 20 20 20\nspacings: 1 1 2\nencoding: raw\n\n";
  std::mt19937 random(3);
  for (int i = 0; i < 8000; ++i)
  {
    file.put(static_cast<char>(random() % 251));
  }
  return path;
}

}

TEST(ViewSoak, RandomInputLeavesAllInOrder)
{
  const double seconds = number_of("BRUME_SOAK_SECONDS", sanitized ? 20.0 : 5.0);
  std::mt19937 random(static_cast<unsigned>(number_of("BRUME_SEED", 20261123)));
  const auto up_to = [&](int most) { return static_cast<int>(random() % (most + 1u)); };
  const nlohmann::ordered_json classified{
    { "input", matter_file() }, { "quiet", true }, { "preset", "grey" }, { "tolerance", 0.05 }
  };
  nlohmann::ordered_json density = classified;
  density.erase("preset");
  density["extinction"] = 0.002;
  Viewer::Settings settings;
  // VTK's own mappers need a display, and are asked for by keys that are left out here.
  settings.mappers = { MapperKind::RayMarch, MapperKind::PathTrace };
  auto viewer = std::make_unique<Viewer>(classified, settings);
  std::vector<std::string> keys{ "question",
    "s",
    "w",
    "f",
    "x",
    "p",
    "space",
    "l",
    "Tab",
    "n",
    "b",
    "r",
    "Prior",
    "Next",
    "BackSpace",
    "F99",
    "" };
  for (const Control& control : controls())
  {
    keys.insert(keys.end(), { control.less, control.more });
  }

  int width = 900;
  int height = 600;
  viewer->resize(width, height);
  const auto start = std::chrono::steady_clock::now();
  const auto passed = [&]
  { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  // Between two viewers nothing is held that pictures, undrawn scenes or a large window could
  // explain.
  std::optional<Held> settled; // when all has been touched
  int actions = 0;
  for (; passed() < seconds; ++actions)
  {
    const int what = up_to(99);
    const int x = up_to(width);
    const int y = up_to(height);
    if (what < 45)
    {
      viewer->key(keys[random() % keys.size()]);
    }
    else if (what < 70)
    {
      if (!viewer->press(x, y, up_to(3) == 0, up_to(3) == 0))
      {
        viewer->camera()->Azimuth(up_to(60) - 30.0);
        viewer->camera()->Elevation(up_to(20) - 10.0);
        viewer->camera()->OrthogonalizeViewUp();
        viewer->camera_moved();
      }
      for (int i = up_to(4); i > 0; --i)
      {
        viewer->drag(x + up_to(80) - 40, y + up_to(80) - 40);
      }
      viewer->release();
    }
    else if (what < 75)
    {
      width = 100 + up_to(1100);
      height = 60 + up_to(700);
      viewer->resize(width, height);
    }
    else if (what < 77)
    {
      viewer->open(up_to(1) ? classified : density);
    }
    else if (what < 80)
    {
      viewer->flick();
    }
    // Pictures, of which some are ended early.
    int looks = up_to(12) * up_to(12);
    const KeepGoing go = [&looks](double) { return --looks > 0; };
    if (viewer->stale() && up_to(1))
    {
      viewer->draft(go);
    }
    else if (!viewer->finished())
    {
      viewer->refine(go);
    }
    const std::vector<Tile>& tiles = viewer->tiles();
    ASSERT_FALSE(tiles.empty());
    for (const Tile& tile : tiles)
    {
      ASSERT_EQ(tile.bitmap.rgb.size(), std::size_t{ 3 } * tile.bitmap.width * tile.bitmap.height);
      ASSERT_GE(tile.box.x, 0);
      ASSERT_LE(tile.box.x + tile.box.width, width);
    }
    if (!settled && passed() > 0.5 * seconds)
    {
      viewer.reset();
      settled = held_now();
      viewer = std::make_unique<Viewer>(classified, settings);
      viewer->resize(width, height);
    }
  }
  // What was set by all that can be saved, and read again.
  EXPECT_NO_THROW(const ParsedScene parsed(viewer->scene()));
  EXPECT_GT(actions, 20);
  viewer.reset();
  const Held last = held_now();
  ASSERT_TRUE(settled);
  std::cout << actions << " actions; in the second half the heap grew by "
            << last.heap - settled->heap << " MB, all memory by " << last.memory - settled->memory
            << " MB\n";
  if (!sanitized)
  {
    EXPECT_LT(last.heap - settled->heap, 3.0);
    EXPECT_LT(last.memory - settled->memory, 25.0); // what is free lies between what is not
  }
}

// What the heap does not count, such as what oneTBB keeps of each arena that is made.
TEST(ViewSoak, ManyPicturesTakeNoMoreThanSome)
{
  if (sanitized)
  {
    GTEST_SKIP() << "sanitizers keep freed memory back";
  }
  const nlohmann::ordered_json scene{ { "input", matter_file() },
    { "quiet", true },
    { "preset", "grey" },
    { "tolerance", 0.05 },
    { "sun-direction", { 1.0, -1.0, 1.0 } } };
  Viewer::Settings settings;
  settings.panel = false;
  Viewer viewer(scene, settings);
  viewer.resize(40, 40);
  const auto draw = [&](int pictures)
  {
    for (int i = 0; i < pictures; ++i)
    {
      viewer.camera()->Azimuth(1.0);
      viewer.camera_moved();
      viewer.draft([](double) { return true; });
    }
    return held_now();
  };
  const Held some = draw(300);
  const Held many = draw(1200);
  std::cout << "1200 pictures: heap " << many.heap - some.heap << " MB, all memory "
            << many.memory - some.memory << " MB\n";
  EXPECT_LT(many.heap - some.heap, 1.0);
  EXPECT_LT(many.memory - some.memory, 4.0);
}
