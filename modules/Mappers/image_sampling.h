// Films coarser or finer than the pixels they are shown on. Internal to Mappers.
#ifndef image_sampling_h
#define image_sampling_h

#include "Transport/film.h"

#include <vector>

namespace brume
{

/// How many rays a picture is made of, for a distance between rays in pixels: below 1 whole numbers
/// of them for each pixel, else one for so many pixels.
struct ImageSampling
{
  ImageSampling(int width, int height, double distance);

  int width;       ///< rays along x
  int height;      ///< rays along y
  int per_pixel;   ///< rays along each side of a pixel; 1 where there are not several
  double distance; ///< pixels between rays, as it came out
};

/// Depths of a picture's pixels, from the bottom left, at the places of the rays.
std::vector<float> at_rays(const std::vector<float>& depth,
  int width,
  int height,
  const ImageSampling& rays);

/// The mean of so many by so many rays for each pixel. The depth is the nearest, the error the
/// largest.
Film averaged(const Film& film, int per_pixel);

/// A brightness window: radiance becomes radiance / window + (½ − level / window) (1 −
/// transmittance), not below 0. `window` is not 0.
void apply_window_level(Film& film, double window, double level);

}

#endif
