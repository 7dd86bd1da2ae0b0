#include "Transport/scene.h"

#include <cmath>
#include <stdexcept>

namespace brume
{

void Scene::validate() const
{
  this->grid.validate();
  if (this->meaning == ValueMeaning::Density)
  {
    if (this->grid.components != 1)
    {
      throw std::invalid_argument("a density is a grid of one component");
    }
    if (!(this->density.extinction >= 0.0) || !std::isfinite(this->density.extinction))
    {
      throw std::invalid_argument("the extinction must be finite and not negative");
    }
    return;
  }
  const Classification& c = this->classification;
  const bool has_colours = this->grid.components == 4;
  if (c.opacity.size() < 2 || (!has_colours && c.rgb.size() != 3 * c.opacity.size()))
  {
    throw std::invalid_argument("a transfer function needs at least 2 nodes, and as many colours");
  }
}

}
