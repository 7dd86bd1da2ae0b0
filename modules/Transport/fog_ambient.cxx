// Light from all around in fog: quadrature over the optical depth along the view.
#include "Transport/fog.h"

#include "Transport/exponential_integral.h"
#include "Transport/quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace brume
{

namespace
{

constexpr int degree = 17;
/// Above, the tail is asked of exponential_integral_2 itself, where it is quick.
constexpr double largest_quick = 50.0;
/// Optical depths from which next to nothing comes: e^−24 = 4e-11.
constexpr double deepest = 24.0;

/// A polynomial through the values of a smooth function at Chebyshev's nodes of [−1, 1].
struct Chebyshev
{
  std::array<double, degree + 1> coefficients{};

  template <class Function>
  explicit Chebyshev(const Function& function)
  {
    constexpr int n = degree + 1;
    const double pi = 3.14159265358979323846;
    for (int node = 0; node < n; ++node)
    {
      const double angle = pi * (node + 0.5) / n;
      const double value = function(std::cos(angle));
      for (int k = 0; k < n; ++k)
      {
        coefficients[k] += value * std::cos(k * angle) * (k == 0 ? 1.0 : 2.0) / n;
      }
    }
  }
  /// By Clenshaw's recurrence.
  double operator()(double x) const
  {
    double next = 0.0;
    double after = 0.0;
    for (int k = degree; k > 0; --k)
    {
      const double here = coefficients[k] + 2.0 * x * next - after;
      after = next;
      next = here;
    }
    return coefficients[0] + x * next - after;
  }
};

}

// E₂(x) − x ln x has a power series that converges everywhere; e^x E₂(x) is smooth in 1/x.
double quick_exponential_integral_2(double x)
{
  static const Chebyshev near(
    [](double u)
    {
      const double v = u + 1.0;
      return exponential_integral_2(v) - (v > 0.0 ? v * std::log(v) : 0.0);
    });
  static const Chebyshev far(
    [](double u)
    {
      const double v = 2.0 / (0.5 * (1.0 + u) * (1.0 - 2.0 / largest_quick) + 2.0 / largest_quick);
      return std::exp(v) * exponential_integral_2(v);
    });
  if (!(x > 0.0))
  {
    return 1.0;
  }
  if (x <= 2.0)
  {
    return near(x - 1.0) + x * std::log(x);
  }
  if (x > largest_quick)
  {
    return exponential_integral_2(x);
  }
  constexpr double least = 2.0 / largest_quick;
  return std::exp(-x) * far(2.0 * (2.0 / x - least) / (1.0 - least) - 1.0);
}

// Along the view, measured by its optical depth t, the depth upward is linear: a − slope · t. What
// comes from the sky is ½ L ∫ e^(−t) E₂(a − slope t) dt. E₂ has a logarithm's kink where its argument
// is 0: at or beyond the end where it is smallest. There t is taken as a square, which makes it smooth.
glm::dvec3 FogModel::ambient(const FogRay& ray, double from, double to) const
{
  const glm::dvec3 ground = this->Falloff > 0.0 ? glm::dvec3(0.0) : this->Ground;
  if (!this->visible() || !(to > from) || this->SkyRadiance + ground == glm::dvec3(0.0))
  {
    return glm::dvec3(0.0);
  }
  const glm::dvec3 view = this->optical_depth(ray, from, to);
  const double up_begin = this->Falloff > 0.0 ? this->profile(ray, from) / this->Falloff : 0.0;
  const double up_end = this->Falloff > 0.0 ? this->profile(ray, to) / this->Falloff : 0.0;
  glm::dvec3 share(0.0);
  for (int c = 0; c < 3; ++c)
  {
    const double k = this->Extinction[c];
    if (c > 0 && k == this->Extinction[c - 1])
    {
      share[c] = share[c - 1];
      continue;
    }
    if (!(view[c] > 0.0))
    {
      continue;
    }
    const double begin = k * up_begin;
    if (this->Falloff == 0.0 || ray.slope == 0.0)
    {
      share[c] = -std::expm1(-view[c]) * quick_exponential_integral_2(begin);
      continue;
    }
    if (begin > 700.0)
    {
      continue; // no light gets so deep
    }
    const double length = std::min(view[c], deepest);
    const bool rising = ray.slope > 0.0;
    const double least = !rising               ? begin
                         : length == view[c]   ? k * up_end
                                               : begin - ray.slope * length;
    double sum = 0.0;
    const auto add = [&](const auto& rule)
    {
      for (std::size_t i = 0; i < rule.nodes.size(); ++i)
      {
        const double v = 0.5 + 0.5 * rule.nodes[i];
        const double away = length * v * v;
        sum += rule.weights[i] * v * std::exp(-(rising ? length - away : away)) *
               quick_exponential_integral_2(least + std::abs(ray.slope) * away);
      }
    };
    length < 1.0   ? add(gauss_legendre<8>())
    : length < 6.0 ? add(gauss_legendre<12>())
                   : add(gauss_legendre<20>());
    share[c] = sum * length;
  }
  return this->Albedo * (this->SkyRadiance * share + ground * share) * 0.5;
}

}
