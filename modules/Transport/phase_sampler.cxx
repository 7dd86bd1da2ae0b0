#include "Transport/phase_sampler.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace brume
{

namespace
{

constexpr double pi = 3.14159265358979323846;

/// 1 − cos θ of Henyey and Greenstein's function for g ≥ 0. With s = (1 − g²) / (1 − g + 2 g u) the
/// inverse of its distribution is (s² − (1 − g)²) / 2g, of which g cancels.
double sample_henyey_greenstein(double g, double u)
{
  const double denominator = 1.0 - g + 2.0 * g * u;
  const double s = (1.0 - g) * (1.0 + g) / denominator;
  return (1.0 - g) * (1.0 - u) / denominator * (s + 1.0 - g);
}

/// 1 − cos θ of Schlick's function for k ≥ 0, given as 1 − k.
double sample_schlick(double one_minus_k, double u)
{
  return 2.0 * one_minus_k * (1.0 - u) / (one_minus_k + 2.0 * (1.0 - one_minus_k) * u);
}

/// cos θ is the root of x³ + 3 x = 8 u − 4 (J. R. Frisvad, Importance sampling the Rayleigh phase
/// function, J. Opt. Soc. Am. A 28, 2011).
double sample_rayleigh(double u)
{
  const double half = 4.0 * u - 2.0;
  const double a = std::cbrt(std::abs(half) + std::sqrt(half * half + 1.0));
  return 1.0 - std::copysign(a - 1.0 / a, half);
}

}

PhaseSampler::PhaseSampler(const std::vector<PhaseLobe>& lobes)
  : Model(prepare_phase(lobes))
{
  double sum = 0.0;
  for (const PhaseLobe& lobe : lobes)
  {
    const double weight = std::max(lobe.weight, 0.0);
    if (weight > 0.0)
    {
      const double g = std::clamp(lobe.anisotropy, -most_anisotropy, most_anisotropy);
      Lobe one{ sum += weight, lobe.function, std::abs(g), g >= 0.0 };
      if (std::abs(g) < least_anisotropy && one.function != PhaseFunction::Rayleigh)
      {
        one.function = PhaseFunction::Isotropic;
      }
      if (one.function == PhaseFunction::Schlick)
      {
        one.parameter = schlick_one_minus_k(std::abs(g));
      }
      this->Lobes.push_back(one);
    }
  }
  for (Lobe& lobe : this->Lobes)
  {
    lobe.up_to /= sum;
  }
}

double PhaseSampler::value(const glm::dvec3& from, const glm::dvec3& to) const
{
  const glm::dvec3 less = from - to;
  const glm::dvec3 more = from + to;
  return scalar::phase<double>(this->Model, 0.5 * glm::dot(less, less), 0.5 * glm::dot(more, more));
}

glm::dvec3 PhaseSampler::sample(const glm::dvec3& from, RandomStream& random) const
{
  const Lobe* lobe = nullptr;
  if (this->Lobes.size() == 1)
  {
    lobe = &this->Lobes.front();
  }
  else if (!this->Lobes.empty())
  {
    const double which = random.uniform();
    lobe = &*std::find_if(this->Lobes.begin(), this->Lobes.end() - 1,
      [which](const Lobe& l) { return which < l.up_to; });
  }
  const double u = random.uniform();
  const double turn = random.uniform();
  double one_minus_cosine = 2.0 * u;
  if (lobe)
  {
    switch (lobe->function)
    {
      case PhaseFunction::Isotropic:
        break;
      case PhaseFunction::Rayleigh:
        one_minus_cosine = sample_rayleigh(u);
        break;
      case PhaseFunction::HenyeyGreenstein:
        one_minus_cosine = sample_henyey_greenstein(lobe->parameter, u);
        break;
      case PhaseFunction::Schlick:
        one_minus_cosine = sample_schlick(lobe->parameter, u);
        break;
    }
    if (!lobe->forward)
    {
      return direction_around(-from, one_minus_cosine, turn);
    }
  }
  return direction_around(from, one_minus_cosine, turn);
}

glm::dvec3 direction_around(const glm::dvec3& axis, double one_minus_cosine, double turn)
{
  // A frame around the axis without a place where it breaks: T. Duff et al., Building an orthonormal
  // basis, revisited, J. Computer Graphics Techniques 6, 2017.
  const double sign = std::copysign(1.0, axis.z);
  const double a = -1.0 / (sign + axis.z);
  const double b = axis.x * axis.y * a;
  const glm::dvec3 x(1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x);
  const glm::dvec3 y(b, sign + axis.y * axis.y * a, -axis.y);
  const double m = std::clamp(one_minus_cosine, 0.0, 2.0);
  const double sine = std::sqrt(m * (2.0 - m));
  const double angle = 2.0 * pi * turn;
  return glm::normalize(
    axis * (1.0 - m) + x * (sine * std::cos(angle)) + y * (sine * std::sin(angle)));
}

}
