#include "data-generators/painted_volume.h"

#include "data-generators/shaping.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <tbb/parallel_for.h>

namespace brume
{

namespace
{
constexpr int blocks = 16;       ///< along each axis: a first, coarse sorting
constexpr int cells_a_block = 4; ///< along each axis
constexpr int cells = blocks * cells_a_block;
/// How far a shape is kept beyond the reach that its distance gives: an ellipsoid's distance is
/// right at its surface only.
constexpr double caution = 1.5;
}

PaintedVolume::PaintedVolume(const Box& box, double background, double edge)
  : m_box(box)
  , m_background(background)
  , m_edge(edge)
{
}

void PaintedVolume::paint(Distance distance, double value)
{
  paint(std::move(distance), { Layer(0.0, value) });
}

void PaintedVolume::paint(Distance distance, std::vector<Layer> layers)
{
  m_shapes.push_back({ std::move(distance), std::move(layers) });
}

double PaintedVolume::blend(const Shape& shape,
  int first,
  int last,
  bool covered,
  const glm::dvec3& place,
  double below) const
{
  double depth = 0.0;
  const auto layer_value = [&](const Layer& layer)
  { return layer.texture ? layer.texture(place, depth) : layer.value; };

  if (covered && last == first + 1 && !shape.layers[first].texture)
  {
    return shape.layers[first].value;
  }
  depth = -shape.distance(place);
  // The deepest layer that hides all before it.
  for (int l = last - 1; l > first; --l)
  {
    if (depth >= shape.layers[l].depth + 0.5 * m_edge)
    {
      first = l;
      covered = true;
      break;
    }
  }
  for (int l = first; l < last; ++l)
  {
    const Layer& layer = shape.layers[l];
    const double cover =
      covered && l == first ? 1.0 : smooth_ramp(depth - layer.depth, -0.5 * m_edge, 0.5 * m_edge);
    if (cover > 0.0)
    {
      below = mix(below, layer_value(layer), cover);
    }
  }
  return below;
}

std::vector<PaintedVolume::Entry> PaintedVolume::entries_of(const glm::dvec3& centre,
  double radius,
  const std::vector<std::uint16_t>& candidates) const
{
  const double reach = caution * (radius + 0.5 * m_edge);
  std::vector<Entry> entries;
  for (const std::uint16_t s : candidates)
  {
    const std::vector<Layer>& layers = m_shapes[s].layers;
    const double depth = -m_shapes[s].distance(centre);
    std::size_t first = 0;
    std::size_t last = 0;
    bool covered = false;
    for (std::size_t l = 0; l < layers.size() && depth > layers[l].depth - reach; ++l)
    {
      last = l + 1;
      if (depth > layers[l].depth + reach)
      {
        first = l;
        covered = true;
      }
    }
    if (covered)
    {
      entries.clear(); // nothing shows of what lies beneath
    }
    if (last > first)
    {
      entries.push_back(
        { s, static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(last), covered });
    }
  }
  return entries;
}

void PaintedVolume::finish()
{
  const glm::dvec3 block_size = (m_box.upper - m_box.lower) / static_cast<double>(blocks);
  const glm::dvec3 cell_size = block_size / static_cast<double>(cells_a_block);
  std::vector<std::uint16_t> all(m_shapes.size());
  std::iota(all.begin(), all.end(), std::uint16_t(0));
  m_cells.assign(static_cast<std::size_t>(cells) * cells * cells, {});
  tbb::parallel_for(0,
    blocks * blocks * blocks,
    [&](int b)
    {
      const glm::ivec3 block(b % blocks, (b / blocks) % blocks, b / (blocks * blocks));
      std::vector<std::uint16_t> near;
      for (const Entry& e :
        entries_of(
          m_box.lower + (glm::dvec3(block) + 0.5) * block_size, 0.5 * glm::length(block_size), all))
      {
        near.push_back(e.shape);
      }
      for (int c = 0; c < cells_a_block * cells_a_block * cells_a_block; ++c)
      {
        const glm::ivec3 cell = block * cells_a_block + glm::ivec3(c % cells_a_block,
                                                          (c / cells_a_block) % cells_a_block,
                                                          c / (cells_a_block * cells_a_block));
        m_cells[(static_cast<std::size_t>(cell.z) * cells + cell.y) * cells + cell.x] = entries_of(
          m_box.lower + (glm::dvec3(cell) + 0.5) * cell_size, 0.5 * glm::length(cell_size), near);
      }
    });
}

double PaintedVolume::value(const glm::dvec3& place) const
{
  int index[3];
  for (int a = 0; a < 3; ++a)
  {
    const double t = (place[a] - m_box.lower[a]) / (m_box.upper[a] - m_box.lower[a]);
    index[a] = t > 0.0 ? static_cast<int>(std::min(t * cells, cells - 1.0)) : 0;
  }
  double result = m_background;
  for (const Entry& e : m_cells[(index[2] * cells + index[1]) * cells + index[0]])
  {
    result = blend(m_shapes[e.shape], e.first, e.last, e.covered, place, result);
  }
  return result;
}

double PaintedVolume::value_by_all(const glm::dvec3& place) const
{
  double result = m_background;
  for (const Shape& s : m_shapes)
  {
    result = blend(s, 0, static_cast<int>(s.layers.size()), false, place, result);
  }
  return result;
}

}
