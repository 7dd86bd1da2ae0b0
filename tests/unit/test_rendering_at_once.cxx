// Renders in several threads of a program at once: each is told of its progress in its own thread,
// can be ended, and is the picture that it is alone.
#include "sunlit_ball.h"

#include "Transport/fog_film.h"
#include "Transport/path_tracer.h"
#include "Transport/reference.h"
#include "Transport/thread_arena.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

using namespace lit_scenes;

namespace
{

constexpr int edge = 60;
constexpr int at_once = 4;

/// Draws with that many threads; whether it was drawn to its end.
struct Render
{
  const char* name;
  std::function<bool(const Scene&, int threads, Film&, const Progress&)> draw;
};

const std::vector<Render>& renders()
{
  static const std::vector<Render> all = {
    { "march",
      [](const Scene& scene, int threads, Film& film, const Progress& progress)
      {
        MarchSettings settings;
        settings.step = 0.5;
        settings.shadows = ShadowMethod::Volume;
        settings.threads = threads;
        Marcher marcher;
        return marcher.render(scene, settings, film, progress).completed;
      } },
    { "paths",
      [](const Scene& scene, int threads, Film& film, const Progress& progress)
      {
        PathSettings settings;
        settings.samples_per_pixel = 4;
        settings.threads = threads;
        PathTracer paths;
        return paths.render(scene, settings, film, progress).completed;
      } },
    { "fog",
      [](const Scene& scene, int threads, Film& film, const Progress& progress)
      {
        Scene foggy = scene;
        foggy.volumes.clear();
        foggy.fog.enabled = true;
        foggy.fog.extinction[0] = foggy.fog.extinction[1] = foggy.fog.extinction[2] = 0.01;
        return render_fog(foggy, film, threads, progress);
      } },
    { "reference",
      [](const Scene& scene, int threads, Film& film, const Progress& progress)
      {
        Scene glowing = scene;
        glowing.lights.clear();
        glowing.volumes[0].medium.emission = glm::dvec3(1.0);
        return render_fixed_step(
          glowing, 0.5, SamplePlacement::Middle, 0.0, threads, film, progress);
      } },
  };
  return all;
}

/// Runs it in threads of the program that begin together.
void together(const std::function<void(int)>& work)
{
  std::atomic<int> ready{ 0 };
  std::vector<std::thread> threads;
  for (int i = 0; i < at_once; ++i)
  {
    threads.emplace_back(
      [&, i]
      {
        ++ready;
        while (ready < at_once)
        {
          std::this_thread::yield();
        }
        work(i);
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
}

}

TEST(RenderingAtOnce, IsToldInItsOwnThreadAndIsThePictureThatItIsAlone)
{
  const SunlitBall ball(16);
  for (const Render& render : renders())
  {
    for (const int threads : { 1, 2 })
    {
      SCOPED_TRACE(render.name + std::string(", threads ") + std::to_string(threads));
      Film alone(edge, edge);
      ASSERT_TRUE(render.draw(ball.scene, threads, alone, {}));
      ASSERT_GT(*std::max_element(alone.radiance[0].begin(), alone.radiance[0].end()), 0.0f);
      for (int repeat = 0; repeat < 5; ++repeat)
      {
        std::array<int, at_once> asked{};
        std::array<int, at_once> elsewhere{};
        std::array<bool, at_once> same{};
        together(
          [&](int i)
          {
            const auto n = static_cast<std::size_t>(i);
            const std::thread::id caller = std::this_thread::get_id();
            Film film(edge, edge);
            const bool drawn = render.draw(ball.scene,
              threads,
              film,
              [&](double)
              {
                ++asked[n];
                elsewhere[n] += std::this_thread::get_id() != caller;
                return true;
              });
            same[n] = drawn && std::equal(film.radiance, film.radiance + 3, alone.radiance);
          });
        for (std::size_t i = 0; i < at_once; ++i)
        {
          EXPECT_GT(asked[i], 1); // once is at the end, whatever happens
          EXPECT_EQ(elsewhere[i], 0);
          EXPECT_TRUE(same[i]);
        }
      }
    }
  }
}

TEST(RenderingAtOnce, CanBeEndedEachByItself)
{
  const SunlitBall ball(16);
  for (const Render& render : renders())
  {
    for (const int threads : { 1, 2 })
    {
      SCOPED_TRACE(render.name + std::string(", threads ") + std::to_string(threads));
      for (int repeat = 0; repeat < 20; ++repeat)
      {
        std::array<bool, at_once> drawn{};
        together(
          [&](int i)
          {
            Film film(edge, edge);
            // Every other one is ended before it is through.
            drawn[static_cast<std::size_t>(i)] = render.draw(
              ball.scene, threads, film, [&](double done) { return i % 2 == 0 || done >= 1.0; });
          });
        for (std::size_t i = 0; i < at_once; ++i)
        {
          EXPECT_EQ(drawn[i], i % 2 == 0);
        }
      }
    }
  }
}

TEST(ThreadArena, IsNobodyElsesAndMayBeNested)
{
  together(
    [](int)
    {
      const std::thread::id caller = std::this_thread::get_id();
      for (int repeat = 0; repeat < 200; ++repeat)
      {
        bool here = false;
        std::atomic<int> count{ 0 };
        ThreadArena outer(2);
        outer.execute(
          [&]
          {
            here = std::this_thread::get_id() == caller;
            tbb::parallel_for(0,
              8,
              [&](int)
              {
                ThreadArena inner(2);
                inner.execute([&] { tbb::parallel_for(0, 8, [&](int) { ++count; }); });
              });
          });
        ASSERT_TRUE(here);
        ASSERT_EQ(count, 64);
      }
    });
}
