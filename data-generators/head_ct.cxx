#include "data-generators/head_ct.h"

#include "data-generators/head_anatomy.h"
#include "data-generators/hounsfield.h"
#include "data-generators/painted_volume.h"
#include "data-generators/random.h"
#include "data-generators/signed_distance.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brume
{

Box head_ct_bounds()
{
  const glm::dvec3 half(96.0, 120.0, 128.0);
  return { -half, half };
}

HeadCT::HeadCT(const HeadCTOptions& options)
{
  if (!(options.edge > 0.0) || !std::isfinite(options.edge))
  {
    throw std::invalid_argument("head CT: the edge must be above 0");
  }
  m_painting = std::make_unique<PaintedVolume>(bounds(), hounsfield::air, options.edge);
  head::paint_soft_tissue(*m_painting);
  head::paint_skull(*m_painting, options.seed);
  head::paint_eyes(*m_painting);
  head::paint_brain(*m_painting, options.seed, options.edge);
  m_painting->paint([](const glm::dvec3& p)
    { return sphere_distance(p, glm::dvec3(head_marker[0], head_marker[1], head_marker[2]), 4.0); },
    hounsfield::marker);
  m_painting->finish();
}

HeadCT::~HeadCT() = default;

Box HeadCT::bounds() const
{
  return head_ct_bounds();
}

float HeadCT::value(const glm::dvec3& place, double) const
{
  return static_cast<float>(m_painting->value(place));
}

bool sample_head_ct(const HeadCT& head,
  double noise,
  std::uint32_t noise_seed,
  const Lattice& grid,
  const Extent& extent,
  std::int16_t* values,
  const Progress& progress)
{
  const std::uint32_t key = substream(noise_seed, 50);
  return for_each_row(
    extent,
    [&](int j, int k, std::size_t offset)
    {
      for (int i = extent.first.x; i <= extent.last.x; ++i)
      {
        double value = head.painting().value(grid.place(i, j, k));
        if (noise > 0.0)
        {
          value += noise * unit_normal(hash_lattice(i, j, k, key));
        }
        value = std::clamp(value, hounsfield::lowest, hounsfield::highest);
        values[offset++] = static_cast<std::int16_t>(std::floor(value + 0.5));
      }
    },
    progress);
}

}
