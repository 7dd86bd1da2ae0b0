#include "Transport/phase.h"

#include <algorithm>
#include <cmath>

namespace brume
{

namespace
{

constexpr double pi = 3.14159265358979323846;

PhaseTerm henyey_greenstein(double g, double weight)
{
  const double size = std::abs(g);
  return { weight * (1.0 - size) * (1.0 + size) / (4.0 * pi), (1.0 - size) * (1.0 - size),
    2.0 * size, g > 0.0, false };
}

PhaseTerm schlick(double g, double weight)
{
  const double rest = schlick_one_minus_k(g);
  return { weight * rest * (2.0 - rest) / (4.0 * pi), rest, 1.0 - rest, g > 0.0, true };
}

/// Mean cosine of (1 − k²) / 4π / (1 − kμ)² for k = 1 − rest.
double schlick_mean(double rest)
{
  const double k = 1.0 - rest;
  if (k < 0.5)
  {
    // (1 − k²) Σ (n + 1)/(n + 2) kⁿ over odd n: the closed form cancels here.
    double sum = 0.0;
    double power = k;
    for (int n = 1; n < 60; n += 2, power *= k * k)
    {
      sum += (n + 1.0) / (n + 2.0) * power;
    }
    return (1.0 - k * k) * sum;
  }
  const double one_less_square = rest * (2.0 - rest);
  return 1.0 / k - one_less_square / (2.0 * k * k) * std::log((2.0 - rest) / rest);
}

double cut(double g)
{
  return std::clamp(std::isnan(g) ? 0.0 : g, -most_anisotropy, most_anisotropy);
}

}

double schlick_one_minus_k(double g)
{
  const double mean = std::abs(cut(g));
  double low = std::log(1e-8); // of 1 − k: the mean falls from here
  double high = 0.0;
  for (int i = 0; i < 80; ++i)
  {
    const double middle = 0.5 * (low + high);
    (schlick_mean(std::exp(middle)) > mean ? low : high) = middle;
  }
  return std::exp(0.5 * (low + high));
}

PhaseModel prepare_phase(const std::vector<PhaseLobe>& lobes, double anisotropy_factor)
{
  PhaseModel model;
  double sum = 0.0;
  for (const PhaseLobe& lobe : lobes)
  {
    sum += std::max(lobe.weight, 0.0);
  }
  if (!(sum > 0.0))
  {
    model.isotropic = 1.0 / (4.0 * pi);
    return model;
  }
  for (const PhaseLobe& lobe : lobes)
  {
    const double weight = std::max(lobe.weight, 0.0) / sum;
    const double g = cut(lobe.anisotropy * anisotropy_factor);
    if (weight == 0.0)
    {
      continue;
    }
    if (lobe.function == PhaseFunction::Rayleigh)
    {
      model.rayleigh += weight * 3.0 / (16.0 * pi);
    }
    else if (lobe.function == PhaseFunction::Isotropic || std::abs(g) < least_anisotropy)
    {
      model.isotropic += weight / (4.0 * pi);
    }
    else
    {
      model.terms.push_back(lobe.function == PhaseFunction::Schlick
          ? schlick(g, weight)
          : henyey_greenstein(g, weight));
    }
  }
  return model;
}

void add_silver_lining(const SilverLining& lining, PhaseModel& model)
{
  if (!lining.enabled || !(lining.strength > 0.0))
  {
    return;
  }
  const double g = cut(1.0 - lining.spread);
  const double shares[2] = { 1.0 - lining.back, lining.back };
  for (int i = 0; i < 2; ++i)
  {
    if (shares[i] > 0.0 && g < least_anisotropy)
    {
      model.isotropic += lining.strength * shares[i] / (4.0 * pi);
    }
    else if (shares[i] > 0.0)
    {
      model.terms.push_back(henyey_greenstein(i ? -g : g, lining.strength * shares[i]));
    }
  }
}

double largest_phase(const PhaseModel& model, double least_cosine, double largest_cosine)
{
  // Each lobe is largest at an end but for Rayleigh's sum with others, which is convex: so is the
  // sum of all, and its largest value stands at an end.
  double largest = 0.0;
  for (const double cosine : { least_cosine, largest_cosine })
  {
    largest = std::max(largest, scalar::phase<double>(model, 1.0 - cosine, 1.0 + cosine));
  }
  return largest;
}

}
