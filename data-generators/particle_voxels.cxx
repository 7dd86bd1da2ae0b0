// From particles to voxels: dense, gathered brick by brick, and as a field.
#include "data-generators/particles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace brume
{

namespace
{

using glm::dvec3;

bool finite(const dvec3& v)
{
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}

namespace
{

bool is_one(const Particle& p)
{
  return std::isfinite(p.place.x) && std::isfinite(p.place.y) && std::isfinite(p.place.z) &&
         p.radius > 0.0 && std::isfinite(p.radius) && std::isfinite(p.peak);
}

/// A particle's density, in one form for all who add it up.
struct Ball
{
  explicit Ball(const Particle& p)
    : centre(p.place)
    , inverse_square(1.0 / (p.radius * p.radius))
    , peak(p.peak)
  {
  }
  double density(const dvec3& place) const
  {
    const dvec3 d = place - centre;
    const double t = std::max(1.0 - ((d.x * d.x + d.y * d.y) + d.z * d.z) * inverse_square, 0.0);
    return peak * t * t;
  }
  dvec3 centre;
  double inverse_square;
  double peak;
};

constexpr int side = 8; ///< of a brick

/// A particle as the grid sees it, with the voxels it may reach.
struct Deposit
{
  Particle particle;
  glm::ivec3 first, last;
};

/// Those in a block; false if there are none.
bool reach_of(const Particle& particle, const Lattice& grid, const Extent& extent, Deposit& out)
{
  if (!is_one(particle))
  {
    return false;
  }
  out.particle = widened(particle, 1.5 * grid.spacing.x);
  const dvec3 centre = (particle.place - grid.origin) / grid.spacing;
  const double wide = out.particle.radius / grid.spacing.x * (1.0 + 1e-9);
  for (int a = 0; a < 3; ++a)
  {
    // In double precision until they are within the block: no place is too far out.
    const double low = std::max(std::ceil(centre[a] - wide), double(extent.first[a]));
    const double high = std::min(std::floor(centre[a] + wide), double(extent.last[a]));
    if (!(low <= high))
    {
      return false;
    }
    out.first[a] = static_cast<int>(low);
    out.last[a] = static_cast<int>(high);
  }
  return true;
}

}

bool deposit(const std::vector<Particle>& particles,
  const Lattice& grid,
  const Extent& extent,
  float* values,
  const Progress& progress)
{
  if (extent.last.x < extent.first.x || extent.last.y < extent.first.y ||
      extent.last.z < extent.first.z)
  {
    return true;
  }
  if (grid.spacing.x != grid.spacing.y || grid.spacing.x != grid.spacing.z)
  {
    throw std::invalid_argument("particles: voxels must be cubes");
  }
  std::vector<Deposit> deposits;
  deposits.reserve(particles.size());
  for (const Particle& p : particles)
  {
    Deposit d;
    if (reach_of(p, grid, extent, d))
    {
      deposits.push_back(d);
    }
  }

  const glm::ivec3 size = extent.last - extent.first + 1;
  const glm::ivec3 bricks = (size + side - 1) / side;
  const std::size_t in_layer = static_cast<std::size_t>(bricks.x) * bricks.y;
  // Layer by layer of bricks, which bounds what the lists take. `begin[b]` is where brick b's list
  // starts in `list`; lists are in the order of the particles.
  std::vector<std::vector<std::uint32_t>> layers(bricks.z);
  for (std::size_t n = 0; n < deposits.size(); ++n)
  {
    const int from = (deposits[n].first.z - extent.first.z) / side;
    const int to = (deposits[n].last.z - extent.first.z) / side;
    for (int k = from; k <= to; ++k)
    {
      layers[k].push_back(static_cast<std::uint32_t>(n));
    }
  }
  std::vector<std::size_t> begin(in_layer + 1);
  std::vector<std::uint32_t> list;
  for (int k = 0; k < bricks.z; ++k)
  {
    const auto each_brick = [&](std::uint32_t n, auto&& use)
    {
      const glm::ivec3 from = (deposits[n].first - extent.first) / side;
      const glm::ivec3 to = (deposits[n].last - extent.first) / side;
      for (int j = from.y; j <= to.y; ++j)
        for (int i = from.x; i <= to.x; ++i)
        {
          use(static_cast<std::size_t>(j) * bricks.x + i);
        }
    };
    std::fill(begin.begin(), begin.end(), 0);
    for (const std::uint32_t n : layers[k])
    {
      each_brick(n, [&](std::size_t b) { ++begin[b + 1]; });
    }
    for (std::size_t b = 0; b < in_layer; ++b)
    {
      begin[b + 1] += begin[b];
    }
    list.resize(begin[in_layer]);
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (const std::uint32_t n : layers[k])
    {
      each_brick(n, [&](std::size_t b) { list[next[b]++] = n; });
    }
    layers[k] = {};

    tbb::parallel_for(std::size_t(0),
      in_layer,
      [&](std::size_t b)
      {
        const glm::ivec3 first =
          extent.first +
          side * glm::ivec3(static_cast<int>(b) % bricks.x, static_cast<int>(b) / bricks.x, k);
        const glm::ivec3 last = glm::min(first + side - 1, extent.last);
        std::array<double, side * side * side> sums{};
        for (std::size_t at = begin[b]; at < begin[b + 1]; ++at)
        {
          const Deposit& d = deposits[list[at]];
          const glm::ivec3 low = glm::max(first, d.first);
          const glm::ivec3 high = glm::min(last, d.last);
          const Ball ball(d.particle);
          for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
            {
              double* row =
                &sums[(static_cast<std::size_t>(z - first.z) * side + y - first.y) * side];
              for (int x = low.x; x <= high.x; ++x)
              {
                row[x - first.x] += ball.density(grid.place(x, y, z));
              }
            }
        }
        for (int z = first.z; z <= last.z; ++z)
          for (int y = first.y; y <= last.y; ++y)
          {
            const double* row =
              &sums[(static_cast<std::size_t>(z - first.z) * side + y - first.y) * side];
            float* out =
              values +
              (static_cast<std::size_t>(z - extent.first.z) * size.y + (y - extent.first.y)) *
                size.x +
              (first.x - extent.first.x);
            for (int x = first.x; x <= last.x; ++x)
            {
              *out++ = static_cast<float>(row[x - first.x]);
            }
          }
      });
    if (progress && !progress((k + 1.0) / bricks.z))
    {
      return false;
    }
  }
  return true;
}

/// The particles of one moment in cells, so many along each axis of the box.
struct ParticleField::Moment
{
  double time = 0.0;
  glm::ivec3 cells{ 1 };
  dvec3 cell{ 1.0 };
  std::shared_ptr<const std::vector<Particle>> particles;
  std::vector<std::size_t> begin;   ///< where each cell's list starts
  std::vector<std::uint32_t> lists; ///< particles that may reach into it, in their order

  /// The cells that a box touches; those at the sides also stand for what lies beyond.
  void cells_of(const Box& whole, const Box& box, glm::ivec3& first, glm::ivec3& last) const
  {
    for (int a = 0; a < 3; ++a)
    {
      const double most = cells[a] - 1.0;
      first[a] = static_cast<int>(
        std::clamp(std::floor((box.lower[a] - whole.lower[a]) / cell[a]), 0.0, most));
      last[a] = static_cast<int>(
        std::clamp(std::floor((box.upper[a] - whole.lower[a]) / cell[a]), 0.0, most));
    }
  }

  /// Calls use(cell) for each of those.
  template <typename Use>
  void each_cell(const Box& whole, const Box& box, Use use) const
  {
    glm::ivec3 first, last;
    this->cells_of(whole, box, first, last);
    for (int k = first.z; k <= last.z; ++k)
      for (int j = first.y; j <= last.y; ++j)
        for (int i = first.x; i <= last.x; ++i)
        {
          use((static_cast<std::size_t>(k) * cells.y + j) * cells.x + i);
        }
  }
};

namespace
{

/// The box that a particle reaches, a little wider for what is rounded.
Box reach_of(const Particle& p)
{
  const double r = p.radius * (1.0 + 1e-9);
  return { p.place - r, p.place + r };
}

bool touch(const Box& a, const Box& b)
{
  const dvec3 apart = glm::max(a.lower - b.upper, b.lower - a.upper);
  return std::max({ apart.x, apart.y, apart.z }) <= 0.0;
}

}

ParticleField::ParticleField(const ParticleCloudOptions& options,
  const Box& box,
  double least_radius)
  : m_cloud(options)
  , m_box(box)
  , m_least_radius(least_radius)
{
  const dvec3 wide = box.upper - box.lower;
  if (!(std::min({ wide.x, wide.y, wide.z }) > 0.0) || !std::isfinite(wide.x + wide.y + wide.z))
  {
    throw std::invalid_argument("particles: the box has no volume");
  }
  if (!(least_radius >= 0.0) || !std::isfinite(least_radius))
  {
    throw std::invalid_argument("particles: the least radius must not be below 0");
  }
}

ParticleField::~ParticleField() = default;

std::shared_ptr<const ParticleField::Moment> ParticleField::moment(double time,
  const Progress& progress) const
{
  const std::lock_guard<std::mutex> lock(m_mutex);
  if (m_moment && m_moment->time == time)
  {
    return m_moment;
  }
  auto moment = std::make_shared<Moment>();
  moment->time = time;
  auto kept = std::make_shared<std::vector<Particle>>();
  // In an arena of its own: a thread that waits here must not take up work that waits for the lock.
  std::vector<Particle> all;
  bool stopped = false;
  const Progress told = [&](double done)
  {
    stopped = progress && !progress(done);
    return !stopped;
  };
  tbb::this_task_arena::isolate([&] { all = m_cloud.particles(time, told); });
  if (stopped)
  {
    return nullptr;
  }
  for (const Particle& p : all)
  {
    const Particle wide = widened(p, m_least_radius);
    if (is_one(wide) && touch(reach_of(wide), m_box))
    {
      kept->push_back(wide);
    }
  }
  moment->particles = kept;

  // Cells about as wide as the median particle, at most 64 along an axis.
  std::vector<double> radii;
  for (const Particle& p : *kept)
  {
    radii.push_back(p.radius);
  }
  std::nth_element(radii.begin(), radii.begin() + radii.size() / 2, radii.end());
  const double radius = radii.empty() ? 0.0 : radii[radii.size() / 2];
  for (int a = 0; a < 3; ++a)
  {
    const double wide = m_box.upper[a] - m_box.lower[a];
    moment->cells[a] =
      radius > 0.0 ? static_cast<int>(std::clamp(wide / (2.0 * radius), 1.0, 64.0)) : 1;
    moment->cell[a] = wide / moment->cells[a];
  }
  moment->begin.assign(
    static_cast<std::size_t>(moment->cells.x) * moment->cells.y * moment->cells.z + 1, 0);
  for (const Particle& p : *kept)
  {
    moment->each_cell(m_box, reach_of(p), [&](std::size_t c) { ++moment->begin[c + 1]; });
  }
  for (std::size_t c = 1; c < moment->begin.size(); ++c)
  {
    moment->begin[c] += moment->begin[c - 1];
  }
  moment->lists.resize(moment->begin.back());
  std::vector<std::size_t> next(moment->begin.begin(), moment->begin.end() - 1);
  for (std::size_t n = 0; n < kept->size(); ++n)
  {
    moment->each_cell(m_box,
      reach_of((*kept)[n]),
      [&](std::size_t c) { moment->lists[next[c]++] = static_cast<std::uint32_t>(n); });
  }
  m_moment = moment;
  return m_moment;
}

bool ParticleField::prepare(double time, const Progress& progress) const
{
  return this->moment(time, progress) != nullptr;
}

std::shared_ptr<const std::vector<Particle>> ParticleField::particles(double time) const
{
  return this->moment(time)->particles;
}

float ParticleField::value(const dvec3& place, double time) const
{
  float out;
  this->values({ place, dvec3(1.0), glm::ivec3(0), glm::ivec3(1) }, time, &out);
  return out;
}

void ParticleField::values(const PlaceBlock& places, double time, float* out) const
{
  const std::shared_ptr<const Moment> moment = this->moment(time);
  std::vector<double> sums(places.size(), 0.0);
  const dvec3 a = places.place(0, 0, 0);
  const dvec3 b = places.place(places.count.x - 1, places.count.y - 1, places.count.z - 1);
  const Box box{ glm::min(a, b), glm::max(a, b) };
  if (finite(box.lower) && finite(box.upper))
  {
    std::vector<std::uint32_t> near;
    moment->each_cell(m_box,
      box,
      [&](std::size_t c)
      {
        near.insert(near.end(),
          moment->lists.begin() + static_cast<std::ptrdiff_t>(moment->begin[c]),
          moment->lists.begin() + static_cast<std::ptrdiff_t>(moment->begin[c + 1]));
      });
    std::sort(near.begin(), near.end()); // each once, in the order in which all add them
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const std::uint32_t n : near)
    {
      const Particle& p = (*moment->particles)[n];
      if (!touch(reach_of(p), box))
      {
        continue;
      }
      const Ball ball(p);
      std::size_t at = 0;
      for (int k = 0; k < places.count.z; ++k)
        for (int j = 0; j < places.count.y; ++j)
          for (int i = 0; i < places.count.x; ++i)
          {
            sums[at++] += ball.density(places.place(i, j, k));
          }
    }
  }
  std::transform(sums.begin(), sums.end(), out, [](double sum) { return static_cast<float>(sum); });
}

FieldRange ParticleField::range_in(const Box& box, double time) const
{
  const std::shared_ptr<const Moment> moment = this->moment(time);
  // At most what all that reach it have in their middles.
  double most = 0.0;
  bool reached = false;
  moment->each_cell(m_box,
    box,
    [&](std::size_t c)
    {
      for (std::size_t n = moment->begin[c]; n < moment->begin[c + 1]; ++n)
      {
        const Particle& p = (*moment->particles)[moment->lists[n]];
        if (touch(reach_of(p), box))
        {
          reached = true;
          most += p.peak;
        }
      }
    });
  return { 0.0f, reached ? std::max(static_cast<float>(most * (1.0 + 1e-6)), 1e-30f) : 0.0f };
}

}
