#include "Transport/film.h"

#include <limits>
#include <stdexcept>

namespace brume
{

Film::Film(int w, int h)
  : width(w)
  , height(h)
{
  if (w <= 0 || h <= 0)
  {
    throw std::invalid_argument("a film needs a positive width and height, not " +
      std::to_string(w) + " x " + std::to_string(h));
  }
  clear();
}

void Film::clear()
{
  for (int c = 0; c < 3; ++c)
  {
    radiance[c].assign(size(), 0.0f);
    transmittance[c].assign(size(), 1.0f);
  }
  depth.assign(size(), std::numeric_limits<float>::infinity());
  error.assign(size(), 0.0f);
}

std::vector<float> over_background(const Film& film, const double background[3])
{
  std::vector<float> picture(3 * film.size());
  for (std::size_t i = 0; i < film.size(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      picture[3 * i + c] = film.radiance[c][i] +
        film.transmittance[c][i] * static_cast<float>(background[c]);
    }
  }
  return picture;
}

}
