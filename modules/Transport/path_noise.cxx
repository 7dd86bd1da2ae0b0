#include "Transport/path_noise.h"

#include "Transport/thread_arena.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <utility>

namespace brume
{

namespace
{

/// Rows that one thread does at once.
constexpr int band = 16;

/// How many times the paths of a pixel one pass may multiply, where pixels have their own number:
/// what they are by is an estimate that the pass betters. Their numbers differ by whole steps of a
/// part of what they have, so that many go together in packets.
constexpr double most_growth = 3.0;
constexpr int parts_of_growth = 8;

}

void PathNoise::in_bands(const std::function<void(int, int)>& work) const
{
  const int height = this->Behind.height;
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> ended{ this->Ended };
  ThreadArena(this->Threads).execute(
    [&]
    {
      tbb::parallel_for(0,
        (height + band - 1) / band,
        [&](int i)
        {
          if (ended)
          {
            return;
          }
          work(i * band, std::min((i + 1) * band, height));
          if (this->Go && std::this_thread::get_id() == caller && !this->Go())
          {
            ended = true;
          }
        });
    });
  this->Ended = ended;
}

PathNoise::PathNoise(const PathSums& paths,
  const Film& behind,
  int threads,
  std::function<bool()> go)
  : Paths(paths)
  , Behind(behind)
  , Threads(threads)
  , Go(std::move(go))
  , Found(paths, behind.width, behind.height)
{
}

const std::vector<double>& PathNoise::variances() const
{
  if (!this->Variances.empty())
  {
    return this->Variances;
  }
  const int width = this->Behind.width;
  const int height = this->Behind.height;
  std::vector<double> own(3 * this->Behind.size());
  this->in_bands(
    [&](int first, int last)
    {
      for (std::size_t i = static_cast<std::size_t>(first) * width;
           i < static_cast<std::size_t>(last) * width;
           ++i)
      {
        for (int c = 0; c < 3; ++c)
        {
          own[3 * i + c] = this->Paths.variance(i, c);
        }
      }
    });
  this->Variances.resize(own.size());
  this->in_bands(
    [&](int first, int last)
    {
      for (int y = first; y < last; ++y)
      {
        for (int x = 0; x < width; ++x)
        {
          const int left = std::max(x - 1, 0);
          const int right = std::min(x + 1, width - 1);
          const int top = std::max(y - 1, 0);
          const int bottom = std::min(y + 1, height - 1);
          const int count = (right - left + 1) * (bottom - top + 1);
          for (int c = 0; c < 3; ++c)
          {
            double around = 0.0;
            for (int j = top; j <= bottom; ++j)
            {
              for (int i = left; i <= right; ++i)
              {
                around += own[3 * (static_cast<std::size_t>(j) * width + i) + c];
              }
            }
            const std::size_t here = 3 * (static_cast<std::size_t>(y) * width + x) + c;
            this->Variances[here] =
              std::isnan(own[here])
                ? own[here]
                : std::max({ own[here], around / count, this->unfound_variance(x, y, c) });
          }
        }
      }
    });
  return this->Variances;
}

/// At least this much, where all of a pixel's paths are black. What its ray meets does not dim:
/// nothing is there that light could be found in.
double PathNoise::unfound_variance(int x, int y, int channel) const
{
  const std::size_t pixel = static_cast<std::size_t>(y) * this->Behind.width + x;
  const int n = this->Paths.samples[pixel];
  if (n < 1 || this->Paths.sums[3 * pixel + channel] != 0.0 ||
      this->Behind.transmittance[channel][pixel] == 1.0f)
  {
    return 0.0;
  }
  const double brought = this->Found.brought(x, y, channel);
  return brought * brought / n;
}

PathError PathNoise::error() const
{
  PathError error;
  const std::vector<double>& careful = this->variances();
  const std::size_t in_band = static_cast<std::size_t>(band) * this->Behind.width;
  for (std::size_t pixel = 0; pixel < this->Behind.size() && !this->Ended; ++pixel)
  {
    if (pixel % in_band == 0 && this->Go && !this->Go())
    {
      this->Ended = true;
    }
    const int n = this->Paths.samples[pixel];
    double v[3];
    for (int c = 0; c < 3; ++c)
    {
      v[c] = careful[3 * pixel + c] / std::max(n, 1);
    }
    error.add(v, n);
  }
  return error;
}

void PathNoise::find_targets(double cap, int most, bool at_least, std::vector<int>& targets) const
{
  const std::vector<double>& careful = this->variances();
  targets.resize(this->Paths.samples.size());
  for (std::size_t pixel = 0; pixel < targets.size(); ++pixel)
  {
    const double n = this->Paths.samples[pixel];
    const double* const v = &careful[3 * pixel];
    const double largest = std::max({ v[0], v[1], v[2] });
    const double highest = std::max<double>(n, std::min<double>(most, most_growth * n));
    const double wanted = largest == 0.0                        ? n
                          : cap > 0.0 && std::isfinite(largest) ? largest / (cap * cap)
                                                                : highest;
    const double part = std::max(std::floor(n / parts_of_growth), 1.0);
    const double parts = (std::clamp(wanted, n, highest) - n) / part;
    const double target = n + part * (at_least ? std::ceil(parts) : std::round(parts));
    targets[pixel] = static_cast<int>(std::min<double>(target, most));
  }
}

void PathNoise::show(Film& film) const
{
  film.transmittance[0] = this->Behind.transmittance[0];
  film.transmittance[1] = this->Behind.transmittance[1];
  film.transmittance[2] = this->Behind.transmittance[2];
  film.depth = this->Behind.depth;
  this->in_bands(
    [&](int first, int last)
    {
      for (int y = first; y < last; ++y)
      {
        for (int x = 0; x < film.width; ++x)
        {
          const std::size_t pixel = static_cast<std::size_t>(y) * film.width + x;
          const int n = std::max(this->Paths.samples[pixel], 1);
          double largest = 0.0;
          for (int c = 0; c < 3; ++c)
          {
            film.radiance[c][pixel] = static_cast<float>(this->Paths.sums[3 * pixel + c] / n);
            largest = std::max(
              { largest, this->Paths.variance(pixel, c) / n, this->unfound_variance(x, y, c) / n });
          }
          film.error[pixel] = static_cast<float>(3.0 * std::sqrt(largest));
        }
      }
    });
}

}
