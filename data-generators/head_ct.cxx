#include "data-generators/head_ct.h"

#include "data-generators/head_anatomy.h"
#include "data-generators/hounsfield.h"
#include "data-generators/painted_volume.h"
#include "data-generators/signed_distance.h"

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
  const auto painting =
    std::make_shared<PaintedVolume>(head_ct_bounds(), hounsfield::air, options.edge);
  head::paint_soft_tissue(*painting);
  head::paint_skull(*painting, options.seed);
  head::paint_eyes(*painting);
  head::paint_brain(*painting, options.seed, options.edge);
  painting->paint([](const glm::dvec3& p)
    { return sphere_distance(p, glm::dvec3(head_marker[0], head_marker[1], head_marker[2]), 4.0); },
    hounsfield::marker);
  painting->finish();
  m_painting = painting;
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
  return sample_scan(head.painting(), noise, noise_seed, grid, extent, values, progress);
}

}
