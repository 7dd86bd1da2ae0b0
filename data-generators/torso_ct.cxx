#include "data-generators/torso_ct.h"

#include "data-generators/hounsfield.h"
#include "data-generators/painted_volume.h"
#include "data-generators/torso_anatomy.h"

#include <cmath>
#include <stdexcept>

namespace brume
{

Box torso_ct_bounds()
{
  const glm::dvec3 half(200.0, 140.0, 280.0);
  return { -half, half };
}

TorsoCT::TorsoCT(const TorsoCTOptions& options)
{
  if (!(options.edge > 0.0) || !std::isfinite(options.edge))
  {
    throw std::invalid_argument("torso CT: the edge must be above 0");
  }
  const auto painting =
    std::make_shared<PaintedVolume>(torso_ct_bounds(), hounsfield::air, options.edge);
  torso::paint_wall(*painting);
  torso::paint_belly(*painting, options.seed);
  torso::paint_lungs(*painting, options.seed);
  torso::paint_heart(*painting);
  torso::paint_bones(*painting, options.seed);
  torso::paint_vessels(*painting);
  painting->finish();
  m_painting = painting;
}

TorsoCT::~TorsoCT() = default;

Box TorsoCT::bounds() const
{
  return torso_ct_bounds();
}

float TorsoCT::value(const glm::dvec3& place, double) const
{
  return static_cast<float>(m_painting->value(place));
}

}
