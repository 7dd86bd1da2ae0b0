// How often renders ask whether to go on, and that what was ended leaves nothing wrong behind.
#include "sunlit_ball.h"

#include "Transport/path_tracer.h"

#include <numeric>

using namespace lit_scenes;

namespace
{

constexpr int edge = 90; // no multiple of a tile

struct Ball : SunlitBall
{
  MarchSettings march;

  Ball()
    : SunlitBall(24)
  {
    this->scene.sky.radiance = glm::dvec3(0.2);
    this->march.step = 0.5;
    this->march.shadows = ShadowMethod::Volume;
    this->march.threads = 1;
  }
};

void expect_same_bits(const Film& a, const Film& b)
{
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_EQ(a.radiance[c], b.radiance[c]);
    EXPECT_EQ(a.transmittance[c], b.transmittance[c]);
  }
  EXPECT_EQ(a.error, b.error);
}

}

// A packet of sixteen rays may take milliseconds: more of them at once would be long.
TEST(Asking, MarchesAskForEverySixteenPixels)
{
  const Ball ball;
  Film film(edge, edge);
  Marcher marcher;
  int calls = 0;
  double before = 0.0;
  ASSERT_TRUE(marcher
                .render(ball.scene,
                  ball.march,
                  film,
                  [&](double done)
                  {
                    EXPECT_GE(done, before);
                    before = done;
                    ++calls;
                    return true;
                  })
                .completed);
  EXPECT_GE(calls, edge * edge / 16);
  EXPECT_EQ(before, 1.0);
}

// Wherever a march is ended, in its light volumes too, the next picture is the one of a fresh
// marcher.
TEST(Asking, MarchesEndAnywhere)
{
  const Ball ball;
  Film whole(edge, edge);
  int calls = 0;
  Marcher().render(ball.scene,
    ball.march,
    whole,
    [&](double)
    {
      ++calls;
      return true;
    });
  for (int last = 1; last < calls; last += std::max(calls / 40, 1))
  {
    Marcher marcher;
    Film film(edge, edge);
    int asked = 0;
    EXPECT_FALSE(
      marcher.render(ball.scene, ball.march, film, [&](double) { return ++asked < last; })
        .completed);
    EXPECT_EQ(asked, last); // and not once more
    ASSERT_TRUE(marcher.render(ball.scene, ball.march, film).completed);
    expect_same_bits(film, whole);
  }
}

// Without a progress of its own the watch is asked, and ends it by an exception.
TEST(Asking, WatchesEndMarchesInTheirLightVolumes)
{
  const Ball ball;
  Film whole(edge, edge);
  Marcher().render(ball.scene, ball.march, whole);
  Marcher marcher;
  Film film(edge, edge);
  bool go = false;
  int asked = 0;
  marcher.set_watch(
    [&]
    {
      ++asked;
      return go;
    });
  EXPECT_THROW(marcher.render(ball.scene, ball.march, film), Marcher::Interrupted);
  EXPECT_EQ(asked, 1); // no pixel was begun
  go = true;
  ASSERT_TRUE(marcher.render(ball.scene, ball.march, film).completed);
  expect_same_bits(film, whole);
}

// Handed out in stretches of some thousand paths, whatever their number a pixel; what the pixels'
// errors are is found band by band.
TEST(Asking, PathsAskOften)
{
  const Ball ball;
  for (const int paths : { 4, 64 })
  {
    PathSettings settings;
    settings.samples_per_pixel = paths;
    settings.tolerance = 1e-9; // so that errors are asked for
    settings.threads = 1;
    Film film(edge, edge);
    int calls = 0;
    PathTracer tracer;
    const PathStatistics statistics = tracer.render(ball.scene,
      settings,
      film,
      [&](double)
      {
        ++calls;
        return true;
      });
    ASSERT_TRUE(statistics.completed);
    EXPECT_GE(calls, static_cast<int>(statistics.paths / 2100)) << paths;
  }
}

// Ended anywhere, it says so, shows what there is, and goes on to the picture it would have made.
TEST(Asking, PathsEndAnywhere)
{
  const Ball ball;
  for (const bool adaptive : { false, true })
  {
    PathSettings settings;
    settings.samples_per_pixel = 24;
    settings.adaptive = adaptive;
    settings.tolerance = adaptive ? 0.05 : 0.0;
    settings.threads = 1;
    constexpr int small = 44;
    Film whole(small, small);
    int calls = 0;
    PathTracer().render(ball.scene,
      settings,
      whole,
      [&](double)
      {
        ++calls;
        return true;
      });
    constexpr int of_errors = 13; // asked after the last path
    for (int last = 1; last < calls;
         last += std::clamp(calls - of_errors - last, 1, std::max(calls / 25, 1)))
    {
      PathTracer tracer;
      Film film(small, small);
      int asked = 0;
      EXPECT_FALSE(tracer.render(ball.scene, settings, film, [&](double) { return ++asked < last; })
                     .completed);
      if (!adaptive && last > calls - of_errors)
      {
        EXPECT_EQ(film.radiance[1], whole.radiance[1]);
      }
      else if (last > calls / 2)
      {
        const auto sum = [](const Film& f)
        { return std::accumulate(f.radiance[1].begin(), f.radiance[1].end(), 0.0); };
        EXPECT_NEAR(sum(film) / sum(whole), 1.0, 0.3);
      }
      ASSERT_TRUE(tracer.render(ball.scene, settings, film).completed);
      expect_same_bits(film, whole);
    }
  }
}

TEST(Asking, ErrorsOfPathsAreTheSameOnAnyNumberOfThreads)
{
  const Ball ball;
  PathSettings settings;
  settings.samples_per_pixel = 1 << 12;
  settings.adaptive = true;
  settings.tolerance = 0.05;
  settings.threads = 1;
  Film one(edge, edge);
  const PathStatistics first = PathTracer().render(ball.scene, settings, one);
  settings.threads = 3;
  Film three(edge, edge);
  const PathStatistics second = PathTracer().render(ball.scene, settings, three);
  EXPECT_GT(first.mean_samples, first.samples_per_pixel + 1.0); // they differ from pixel to pixel
  EXPECT_EQ(first.estimated_error, second.estimated_error);
  EXPECT_EQ(first.paths, second.paths);
  expect_same_bits(one, three);
}
