#include "data-generators/particles.h"

#include "data-generators/portable_math.h"
#include "data-generators/random.h"
#include "data-generators/shaping.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace brume
{

namespace
{

using glm::dvec3;

constexpr double most_particles = 2e7;
constexpr double most_steps = 1e10;

bool finite(const dvec3& v)
{
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void require(bool holds, const char* what)
{
  if (!holds)
  {
    throw std::invalid_argument(std::string("particles: ") + what);
  }
}

/// The numbers n of an emitter that can be alive at a time: first, and how many.
struct Brood
{
  std::size_t first = 0;
  std::size_t count = 0;
};

Brood brood(const Emitter& emitter, double life, double time)
{
  // Born in [start + n/rate, start + (n + 1)/rate), dead after `life` at the latest.
  const double until = std::min(time, emitter.stop) - emitter.start;
  const double since = time - life - emitter.start;
  if (!(until >= 0.0) || !(emitter.rate > 0.0))
  {
    return {};
  }
  const double last = std::floor(until * emitter.rate);
  const double first = std::max(std::floor(since * emitter.rate) - 1.0, 0.0);
  if (!(first <= last) || last > 9e15) // beyond, numbers are no longer told apart
  {
    return {};
  }
  return { static_cast<std::size_t>(first), static_cast<std::size_t>(last - first) + 1 };
}

}

double amount_of(const Particle& particle)
{
  return particle.peak * particle.radius * particle.radius * particle.radius * (32.0 * pi / 105.0);
}

ParticleCloud::ParticleCloud(const ParticleCloudOptions& options)
  : m_options(options)
  , m_flow(options.flow)
{
  const auto positive = [](double x) { return x > 0.0 && std::isfinite(x); };
  require(std::isfinite(options.rise), "the rise must be finite");
  require(positive(options.response), "the response must be above 0");
  require(positive(options.life), "the life must be above 0");
  require(positive(options.radius), "the radius must be above 0");
  require(options.growth >= 0.0 && std::isfinite(options.growth), "the growth must not be below 0");
  require(
    options.density >= 0.0 && std::isfinite(options.density), "the density must not be below 0");
  require(positive(options.step), "the step must be above 0");
  require(options.life / options.step <= 1e6, "the step is too short for so long a life");
  double alive = 0.0;
  for (const Emitter& e : options.emitters)
  {
    require(finite(e.place) && finite(e.velocity) && std::isfinite(e.start) && !std::isnan(e.stop),
      "an emitter's place, velocity and times must be finite");
    require(e.radius >= 0.0 && std::isfinite(e.radius), "an emitter's radius must not be below 0");
    require(e.spread >= 0.0 && std::isfinite(e.spread), "an emitter's spread must not be below 0");
    require(e.rate >= 0.0 && std::isfinite(e.rate), "an emitter's rate must not be below 0");
    alive += e.rate * options.life;
  }
  require(alive <= most_particles, "more than 20 million would be alive at once");
  require(alive * (options.life / options.step) <= most_steps,
    "a moment would take more than 10^10 steps of particles: shorten the life or lower the rate");
}

std::vector<Particle> ParticleCloud::particles(double time, const Progress& progress) const
{
  const ParticleCloudOptions& o = m_options;
  std::vector<Particle> all;
  if (!std::isfinite(time))
  {
    return all;
  }
  std::size_t count = 0, done = 0;
  for (const Emitter& emitter : o.emitters)
  {
    count += brood(emitter, o.life, time).count;
  }
  const std::size_t batch = std::max<std::size_t>(count / 100, 1024);
  for (std::size_t e = 0; e < o.emitters.size(); ++e)
  {
    const Emitter& emitter = o.emitters[e];
    const Brood numbers = brood(emitter, o.life, time);
    std::vector<Particle> born(numbers.count);
    const std::uint32_t key = substream(o.seed, 100 + static_cast<std::uint32_t>(e));
    const auto move = [&](std::size_t index)
    {
      const std::uint64_t n = numbers.first + index;
      const std::uint32_t own = mix_bits(
        mix_bits(static_cast<std::uint32_t>(n) ^ key) + static_cast<std::uint32_t>(n >> 32));
      const auto number = [&](std::uint32_t i) { return double(unit_float(mix_bits(own + i))); };
      // A place of the unit ball: the first of eight tries that lies within it, else its middle.
      const auto ball = [&](std::uint32_t stream)
      {
        for (std::uint32_t i = stream; i < stream + 24; i += 3)
        {
          const dvec3 p(
            2.0 * number(i) - 1.0, 2.0 * number(i + 1) - 1.0, 2.0 * number(i + 2) - 1.0);
          if (glm::dot(p, p) <= 1.0)
          {
            return p;
          }
        }
        return dvec3(0.0);
      };
      const double birth = emitter.start + (static_cast<double>(n) + number(0)) / emitter.rate;
      const double life = o.life * mix(0.6, 1.0, number(1));
      const double age = time - birth;
      if (!(age >= 0.0 && age < life) || birth > emitter.stop)
      {
        return; // radius 0: none
      }
      dvec3 x = emitter.place + emitter.radius * ball(2);
      dvec3 v = emitter.velocity + emitter.spread * ball(26);
      double t = 0.0;
      for (int step = 1; t < age; ++step)
      {
        const double end = std::min(step * o.step, age);
        const double r = (end - t) / o.response;
        const dvec3 w = m_flow.velocity(x, birth + t) + dvec3(0.0, 0.0, o.rise);
        const dvec3 next = (v + r * w) / (1.0 + r);
        x += 0.5 * (end - t) * (v + next);
        v = next;
        t = end;
      }
      const double grown = o.radius + o.growth * age;
      const double thinned = o.radius / grown;
      const double fade =
        smooth_ramp(age, 0.0, 0.1 * life) * (1.0 - smooth_ramp(age, 0.5 * life, life));
      born[index] = { x, grown, o.density * fade * thinned * thinned * thinned };
    };
    for (std::size_t begin = 0; begin < born.size(); begin += batch)
    {
      const std::size_t end = std::min(begin + batch, born.size());
      tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, 64),
        [&](const tbb::blocked_range<std::size_t>& range)
        {
          for (std::size_t index = range.begin(); index != range.end(); ++index)
          {
            move(index);
          }
        });
      done += end - begin;
      if (progress && !progress(static_cast<double>(done) / count))
      {
        return {};
      }
    }
    for (const Particle& p : born)
    {
      if (p.radius > 0.0 && p.peak > 0.0)
      {
        all.push_back(p);
      }
    }
  }
  return all;
}

Particle widened(const Particle& particle, double least_radius)
{
  if (!(particle.radius < least_radius))
  {
    return particle;
  }
  const double thinned = particle.radius / least_radius;
  return { particle.place, least_radius, particle.peak * thinned * thinned * thinned };
}

}
