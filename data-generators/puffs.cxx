#include "data-generators/puffs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace brume
{

namespace
{

/// As many cells as puffs are small against the box: by its height, which heaps fill.
glm::ivec3 cells_for(const Box& box)
{
  const glm::dvec3 side = box.upper - box.lower;
  glm::ivec3 cells(32);
  for (int axis = 0; axis < 2; ++axis)
  {
    cells[axis] = static_cast<int>(std::clamp(16.0 * side[axis] / side.z, 32.0, 512.0));
  }
  return cells;
}

}

PuffHeap::PuffHeap(const std::vector<Puff>& puffs, const Box& box, double reach)
  : m_box(box)
  , m_cells(cells_for(box))
  , m_scale(glm::dvec3(m_cells) / (box.upper - box.lower))
  , m_reach(reach)
{
  m_puffs.reserve(6 * puffs.size());
  for (const Puff& puff : puffs)
  {
    for (int a = 0; a < 3; ++a)
    {
      m_puffs.push_back(static_cast<float>(puff.centre[a]));
    }
    for (int a = 0; a < 3; ++a)
    {
      m_puffs.push_back(static_cast<float>(1.0 / puff.radii[a]));
    }
  }
  // Counted first, then written: a wide field's lists would not fit beside their vectors.
  m_begin.assign(static_cast<std::size_t>(m_cells.x) * m_cells.y * m_cells.z + 1, 0);
  for (const Puff& puff : puffs)
  {
    this->for_cells_of(puff, [&](std::size_t cell) { ++m_begin[cell + 1]; });
  }
  std::size_t all = 0;
  for (std::uint32_t& begin : m_begin)
  {
    all += begin;
    if (all > std::numeric_limits<std::uint32_t>::max())
    {
      throw std::invalid_argument("cloud: it is a heap of too many puffs: make it less wide");
    }
    begin = static_cast<std::uint32_t>(all);
  }
  m_lists.resize(all);
  std::vector<std::uint32_t> next(m_begin.begin(), m_begin.end() - 1);
  for (std::uint32_t p = 0; p < puffs.size(); ++p)
  {
    this->for_cells_of(puffs[p], [&](std::size_t cell) { m_lists[next[cell]++] = 6 * p; });
  }
}

template <class Function>
void PuffHeap::for_cells_of(const Puff& puff, const Function& function) const
{
  // A little more than the reach, for the rounding of those who ask in single precision.
  const glm::dvec3 margin = glm::dvec3(m_reach) + 1e-5 * (m_box.upper - m_box.lower);
  int low[3], high[3];
  for (int a = 0; a < 3; ++a)
  {
    low[a] = cell_of(puff.centre[a] - puff.radii[a] - margin[a], a);
    high[a] = cell_of(puff.centre[a] + puff.radii[a] + margin[a], a);
  }
  // The cell's nearest place, for ellipsoids fill half their box. The outer cells take in all that
  // lies beyond.
  const auto square_along = [&](int cell, int a)
  {
    const double from = m_box.lower[a] + cell / m_scale[a] - margin[a];
    const double to = m_box.lower[a] + (cell + 1) / m_scale[a] + margin[a];
    const double d = std::max({ cell > 0 ? from - puff.centre[a] : 0.0,
      cell < m_cells[a] - 1 ? puff.centre[a] - to : 0.0,
      0.0 });
    return d * d / (puff.radii[a] * puff.radii[a]);
  };
  for (int k = low[2]; k <= high[2]; ++k)
  {
    const double z = square_along(k, 2);
    for (int j = low[1]; j <= high[1]; ++j)
    {
      const double yz = z + square_along(j, 1);
      for (int i = low[0]; yz < 1.0 && i <= high[0]; ++i)
      {
        if (yz + square_along(i, 0) < 1.0)
        {
          function((static_cast<std::size_t>(k) * m_cells.y + j) * m_cells.x + i);
        }
      }
    }
  }
}

int PuffHeap::cell_of(double x, int axis) const
{
  const double at = (x - m_box.lower[axis]) * m_scale[axis];
  return at > 0.0 ? static_cast<int>(std::min(at, m_cells[axis] - 1.0))
                  : 0; // and 0 for what is no number
}

double PuffHeap::most_in(const Box& box) const
{
  int low[3], high[3];
  glm::dvec3 middle, half;
  double count = 1.0;
  for (int a = 0; a < 3; ++a)
  {
    low[a] = cell_of(box.lower[a] - 1e-5 * (m_box.upper[a] - m_box.lower[a]), a);
    high[a] = cell_of(box.upper[a] + 1e-5 * (m_box.upper[a] - m_box.lower[a]), a);
    middle[a] = 0.5 * (box.lower[a] + box.upper[a]);
    half[a] = 0.5 * (box.upper[a] - box.lower[a]) + m_reach;
    count *= high[a] - low[a] + 1;
  }
  double most = 0.0;
  for (int k = low[2]; k <= high[2]; ++k)
  {
    for (int j = low[1]; j <= high[1]; ++j)
    {
      for (int i = low[0]; i <= high[0]; ++i)
      {
        const int cell = (k * m_cells.y + j) * m_cells.x + i;
        if (m_begin[cell] == m_begin[cell + 1])
        {
          continue;
        }
        if (count > 64.0)
        {
          return 1.0; // a large box: let its parts be asked
        }
        double rest = 1.0;
        for (std::uint32_t at = m_begin[cell]; at < m_begin[cell + 1]; ++at)
        {
          const std::uint32_t n = m_lists[at];
          double square = 0.0;
          for (int a = 0; a < 3; ++a)
          {
            const double d =
              std::max(std::fabs(m_puffs[n + a] - middle[a]) - half[a], 0.0) * m_puffs[n + 3 + a];
            square += d * d;
          }
          if (square < 1.0)
          {
            const double f = 1.0 - square;
            rest *= 1.0 - f * f;
          }
        }
        most = std::max(most, 1.0 - rest);
      }
    }
  }
  return most + 1e-4; // for the kernels' rounding
}

}
