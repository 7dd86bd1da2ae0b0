#include "data-generators/puffs.h"

#include <algorithm>
#include <cmath>

namespace brume
{

PuffHeap::PuffHeap(const std::vector<Puff>& puffs, const Box& box, double reach)
  : m_box(box)
  , m_scale(double(cells) / (box.upper - box.lower))
  , m_reach(reach)
{
  // A little more than the reach, for the rounding of those who ask in single precision.
  const glm::dvec3 margin = glm::dvec3(reach) + 1e-5 * (box.upper - box.lower);
  std::vector<std::vector<std::uint32_t>> lists(cells * cells * cells);
  for (std::uint32_t p = 0; p < puffs.size(); ++p)
  {
    int low[3], high[3];
    for (int a = 0; a < 3; ++a)
    {
      low[a] = cell_of(puffs[p].centre[a] - puffs[p].radii[a] - margin[a], a);
      high[a] = cell_of(puffs[p].centre[a] + puffs[p].radii[a] + margin[a], a);
    }
    for (int k = low[2]; k <= high[2]; ++k)
    {
      for (int j = low[1]; j <= high[1]; ++j)
      {
        for (int i = low[0]; i <= high[0]; ++i)
        {
          // The cell's nearest place, for ellipsoids fill half their box.
          const int cell[3] = { i, j, k };
          double square = 0.0;
          for (int a = 0; a < 3; ++a)
          {
            const double from = m_box.lower[a] + cell[a] / m_scale[a] - margin[a];
            const double to = m_box.lower[a] + (cell[a] + 1) / m_scale[a] + margin[a];
            // The outer cells take in all that lies beyond.
            const double d = std::max({ cell[a] > 0 ? from - puffs[p].centre[a] : 0.0,
              cell[a] < cells - 1 ? puffs[p].centre[a] - to : 0.0,
              0.0 });
            square += d * d / (puffs[p].radii[a] * puffs[p].radii[a]);
          }
          if (square < 1.0)
          {
            lists[(k * cells + j) * cells + i].push_back(p);
          }
        }
      }
    }
  }
  m_begin.push_back(0);
  for (const std::vector<std::uint32_t>& list : lists)
  {
    for (const std::uint32_t p : list)
    {
      for (int a = 0; a < 3; ++a)
      {
        m_puffs.push_back(static_cast<float>(puffs[p].centre[a]));
      }
      for (int a = 0; a < 3; ++a)
      {
        m_puffs.push_back(static_cast<float>(1.0 / puffs[p].radii[a]));
      }
    }
    m_begin.push_back(static_cast<std::uint32_t>(m_puffs.size()));
  }
}

int PuffHeap::cell_of(double x, int axis) const
{
  const double at = (x - m_box.lower[axis]) * m_scale[axis];
  return at > 0.0 ? static_cast<int>(std::min(at, cells - 1.0)) : 0; // and 0 for what is no number
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
        const int cell = (k * cells + j) * cells + i;
        if (m_begin[cell] == m_begin[cell + 1])
        {
          continue;
        }
        if (count > 64.0)
        {
          return 1.0; // a large box: let its parts be asked
        }
        double rest = 1.0;
        for (std::uint32_t n = m_begin[cell]; n < m_begin[cell + 1]; n += 6)
        {
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
