#include "Transport/path_pixels.h"

#include <algorithm>
#include <map>

namespace brume
{

bool PathSums::clear(std::size_t pixels, const std::function<bool()>& go)
{
  for (std::vector<double>* values : { &this->sums, &this->squares, &this->groups, &this->open })
  {
    values->assign(3 * pixels, 0.0);
    if (!go())
    {
      return false;
    }
  }
  this->samples.assign(pixels, 0);
  return true;
}

void PathSums::add(std::size_t pixel, const glm::dvec3& radiance)
{
  constexpr int strata = RandomStream::strata;
  const bool whole = ++this->samples[pixel] % strata == 0;
  for (int c = 0; c < 3; ++c)
  {
    const std::size_t i = 3 * pixel + c;
    this->sums[i] += radiance[c];
    this->squares[i] += radiance[c] * radiance[c];
    this->open[i] += radiance[c];
    if (whole)
    {
      this->groups[i] += this->open[i] * this->open[i] / strata;
      this->open[i] = 0.0;
    }
  }
}

double PathSums::variance(std::size_t pixel, int channel) const
{
  constexpr int strata = RandomStream::strata;
  constexpr int enough = 16;
  const std::size_t i = 3 * pixel + channel;
  const int n = this->samples[pixel];
  const int m = n / strata;
  const double sum = m < enough ? this->sums[i] : this->sums[i] - this->open[i];
  const double squares = m < enough ? this->squares[i] : this->groups[i];
  const int paths = m < enough ? n : m * strata;
  const int independent = m < enough ? n : m;
  return independent < 2 ? 0.0 : std::max(squares - sum * (sum / paths), 0.0) / (independent - 1);
}

std::uint64_t trace_pixels(const PathScene& scene,
  const PathSights& sights,
  int width,
  int y,
  int from,
  int to,
  const PathTargets& targets,
  std::uint32_t seed,
  PathSums& result,
  PathCounts& counts)
{
  std::uint64_t traced = 0;
  std::map<int, std::vector<PathStart>> together; // by the paths that they have to go
  std::vector<float> radiance;
  const auto flush = [&](int samples, const std::vector<PathStart>& starts)
  {
    radiance.resize(starts.size() * samples * 3);
    trace_paths(
      *scene.packets(), starts, samples, scene.most_scatterings(), seed, radiance.data(), counts);
    const float* next = radiance.data();
    for (const PathStart& start : starts)
    {
      for (int n = 0; n < samples; ++n, next += 3)
      {
        result.add(start.pixel, glm::dvec3(next[0], next[1], next[2]));
      }
    }
  };
  for (int x = from; x < to; ++x)
  {
    const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
    const int first = result.samples[pixel];
    const int target = targets.of(pixel);
    if (first >= target)
    {
      continue;
    }
    Sight sight;
    if (!sights.find(x, y, sight))
    {
      result.samples[pixel] = target;
      continue;
    }
    traced += static_cast<std::uint64_t>(target - first);
    if (scene.packets())
    {
      PathStart start;
      start.pixel = static_cast<std::uint32_t>(pixel);
      start.first = static_cast<std::uint32_t>(first);
      if (scene.find_start(sight, start))
      {
        together[target - first].push_back(start);
      }
      else
      {
        result.samples[pixel] = target;
      }
      continue;
    }
    for (int n = first; n < target; ++n)
    {
      RandomStream random(seed, pixel, static_cast<std::uint32_t>(n));
      random.stratify();
      result.add(pixel, scene.radiance(sight, random, counts));
    }
  }
  for (const auto& [samples, starts] : together)
  {
    flush(samples, starts);
  }
  return traced;
}

}
