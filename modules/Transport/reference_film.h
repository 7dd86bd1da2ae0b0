// Rays of a picture shared by threads, and their results in the film. Internal to the reference.
#pragma once

#include "Transport/film.h"
#include "Transport/marcher.h"
#include "Transport/reference_integrators.h"
#include "Transport/reference_ray.h"

#include <functional>

namespace brume
{

/// Calls draw(pixel, ray) for every pixel whose ray meets what is drawn, rows shared by threads.
/// Empties the film first. Returns whether it was completed.
bool for_each_ray(const Scene& scene,
  Film& film,
  int threads,
  const Progress& progress,
  const std::function<void(std::size_t, const PixelRay&)>& draw);

/// Writes a ray's result to the film.
void store(Film& film,
  std::size_t pixel,
  const PixelRay& ray,
  const RayResult& result,
  double error);

}
