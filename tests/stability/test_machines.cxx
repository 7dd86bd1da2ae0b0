// Hard cases of machines: threads, instruction sets, two pictures at once, pictures that are
// cancelled.
#include "artists.h"
#include "hard_case.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <thread>

using namespace stability;
using brume_tests::HardCase;

namespace
{

constexpr int width = 37; // some tiles, and packets that are cut
constexpr int height = 35;

Film drawn(const Artist& artist, int threads = 1, int w = width, int h = height)
{
  Film film(w, h);
  EXPECT_TRUE(artist.draw(film, threads, {})) << artist.name;
  return film;
}

}

TEST(Machines, AnyNumberOfThreads)
{
  HardCase threads("Machines",
    "1 to 64 threads",
    "sums that run across tiles, or random numbers by thread, depend on who comes first",
    "the same bits");
  const tbb::global_control many(tbb::global_control::max_allowed_parallelism, 64);
  for (const Artist& artist : artists())
  {
    const Film one = drawn(artist);
    for (const int count : { 2, 7, 64 })
    {
      threads.holds(same_bits(one, drawn(artist, count)), "the same bits", artist.name);
    }
  }
}

TEST(Machines, EveryInstructionSet)
{
  HardCase sets("Machines",
    "every SIMD target that the machine has, from one lane to sixteen",
    "fused multiply-adds, other approximations of 1/x and other sums round differently",
    "within 1e-5 of white of one another (1e-4 where powers, cosines and 16 bits magnify it, 2e-3 "
    "where an "
    "estimate decides), and all as near to double precision; paths within their noise");
  for (const Artist& artist : artists())
  {
    if (artist.apart < 0.0)
    {
      continue;
    }
    Film first;
    Film truth(23, 18);
    if (artist.truth)
    {
      artist.truth(truth);
    }
    for (const std::string& target : targets())
    {
      ASSERT_TRUE(force_simd_target(target));
      const Film film = drawn(artist, 0, 23, 18);
      if (first.width == 0)
      {
        first = film;
      }
      if (artist.apart > 0.0)
      {
        sets.measure(
          difference(first, film) / artist.apart, 1.0, "of what they may be apart", artist.name);
        sets.measure(difference(film, truth) / artist.error,
          1.0,
          "of the error against double precision that the step allows",
          artist.name);
        continue;
      }
      double apart = 0.0;
      double noise = 0.0;
      for (std::size_t i = 0; i < film.size(); ++i)
      {
        apart += film.radiance[1][i] - first.radiance[1][i];
        noise +=
          (double(film.error[i]) * film.error[i] + double(first.error[i]) * first.error[i]) / 9.0;
      }
      sets.measure(
        std::abs(apart) / std::sqrt(noise), 4.5, "standard errors of the mean", artist.name);
    }
    force_simd_target("");
  }
}

namespace
{

/// How far the means of two pictures by paths are apart, in standard errors.
double apart_in_noise(const Film& film, const std::vector<float>& radiance)
{
  double apart = 0.0;
  double noise = 0.0;
  for (std::size_t i = 0; i < film.size(); ++i)
  {
    apart += film.radiance[1][i] - radiance[i];
    noise += 2.0 * film.error[i] * film.error[i] / 9.0;
  }
  return std::abs(apart) / std::sqrt(noise);
}

double difference(const std::vector<float>& a, const std::vector<float>& b)
{
  double most = a.size() == b.size() ? 0.0 : NAN;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i)
  {
    const double off = std::abs(double(a[i]) - b[i]);
    most = off <= most ? most : off; // a NaN wins
  }
  return most;
}

}

// The pictures of a release build are kept; whichever build this is, it draws them again.
// BRUME_UPDATE_BASELINES=1 in a release build writes them anew.
TEST(Machines, EveryBuild)
{
  const std::string path = BRUME_TEST_BASELINES "/every-build.json";
  constexpr int w = 9;
  constexpr int h = 7;
  if (std::getenv("BRUME_UPDATE_BASELINES"))
  {
    nlohmann::ordered_json kept;
    for (const Artist& artist : artists())
    {
      const Film film = drawn(artist, 0, w, h);
      kept[artist.name] = { { "radiance", film.radiance[1] },
        { "transmittance", film.transmittance[1] } };
    }
    std::ofstream(path) << kept.dump(1) << '\n';
  }
  HardCase builds("Machines",
    "release, debug and sanitized builds",
    "other optimisations round differently, fuse other products and order sums otherwise",
    "within 1e-5 of white of the pictures that a release build has left (1e-4 where powers, "
    "cosines "
    "and 16 bits magnify it, 2e-3 where an estimate decides); paths within their noise");
  std::ifstream file(path);
  const nlohmann::json kept = nlohmann::json::parse(file);
  EXPECT_EQ(kept.size(), artists().size());
  for (const Artist& artist : artists())
  {
    const Film film = drawn(artist, 0, w, h);
    const std::vector<float> radiance = kept.at(artist.name).at("radiance");
    const std::vector<float> transmittance = kept.at(artist.name).at("transmittance");
    const double off = difference(film.radiance[1], radiance);
    const double passes = difference(film.transmittance[1], transmittance);
    const double bound = artist.apart > 0.0 ? artist.apart : 1e-5;
    builds.measure(passes / bound, 1.0, "of what they may be apart", artist.name);
    if (artist.apart == 0.0)
    {
      builds.measure(
        apart_in_noise(film, radiance), 4.5, "standard errors of the mean", artist.name);
      continue;
    }
    builds.measure(off / bound, 1.0, "of what they may be apart", artist.name);
  }
}

TEST(Machines, PicturesAtOnce)
{
  HardCase at_once("Machines",
    "rendering while other threads render other scenes",
    "anything static or shared would be written by all",
    "the same bits as alone");
  std::vector<Film> alone;
  for (const Artist& artist : artists())
  {
    alone.push_back(drawn(artist));
  }
  constexpr int turns = 1;
  const std::size_t count = alone.size();
  std::vector<std::atomic<int>> same(count);
  std::vector<std::thread> workers;
  for (int worker = 0; worker < 4; ++worker)
  {
    workers.emplace_back(
      [&, worker]
      {
        const std::vector<Artist> own = artists();
        for (int turn = 0; turn < turns; ++turn)
        {
          for (std::size_t i = 0; i < count; ++i)
          {
            const std::size_t n = (i + 5 * worker) % count;
            Film film(width, height);
            own[n].draw(film, 1 + worker % 2, {});
            same[n] += same_bits(film, alone[n]);
          }
        }
      });
  }
  for (std::thread& worker : workers)
  {
    worker.join();
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    at_once.holds(same[i] == 4 * turns, "the same bits in all threads", artists()[i].name);
  }
}

TEST(Machines, CancelledPictures)
{
  HardCase cancelled("Machines",
    "a picture that is cancelled at any moment",
    "caches are half made, sums half summed",
    "the next picture by the same object is the same bits as a new object's");
  const std::vector<Artist> fresh = artists();
  const std::vector<Artist> again = artists(); // cancelled again and again
  for (std::size_t i = 0; i < fresh.size(); ++i)
  {
    const Film film = drawn(fresh[i]);
    int times = 0;
    for (int moment = 1; moment < 4096; moment += 1 + moment)
    {
      int calls = 0;
      Film left(width, height);
      if (again[i].draw(left, moment % 3 + 1, [&](double) { return ++calls < moment; }))
      {
        break;
      }
      ++times;
      cancelled.holds(same_bits(film, drawn(again[i])), "the same bits after", again[i].name);
    }
    EXPECT_GT(times, 0) << again[i].name;
  }
}
