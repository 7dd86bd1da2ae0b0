// What the tests of fog are measured against: adaptive quadrature by Boost.Math, and the extinction of
// fog written down once more.
#pragma once

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace fog_truth
{

using glm::dvec3;

constexpr double pi = 3.14159265358979323846;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// ∫ g over [from, to], to possibly infinite: cut at the places and at tenfold distances from them, so
/// that no feature near any of them is passed over.
inline double integral(const std::function<double(double)>& g,
  double from,
  double to,
  std::vector<double> places = {})
{
  places.push_back(from);
  std::vector<double> cuts{ from };
  for (double place : places)
  {
    cuts.push_back(place);
    for (double away = 1e-8; away < 1e15; away *= 10.0)
    {
      cuts.push_back(place - away);
      cuts.push_back(place + away);
    }
  }
  if (std::isinf(to))
  {
    for (double away = 1e16; away < 1e100; away *= 10.0)
    {
      cuts.push_back(away);
    }
    to = cuts.back();
  }
  else
  {
    cuts.push_back(to);
  }
  std::sort(cuts.begin(), cuts.end());
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
  {
    if (cuts[i] >= from && cuts[i + 1] <= to && cuts[i] < cuts[i + 1])
    {
      // Over [0, 1]: Boost's estimate of the error does not count the length of the interval.
      const double begin = cuts[i];
      const double length = cuts[i + 1] - begin;
      sum += boost::math::quadrature::gauss_kronrod<double, 15>::integrate(
        [&](double u) { return length * g(begin + length * u); }, 0.0, 1.0, 10, 1e-10);
    }
  }
  return sum;
}

/// A unit vector that rises by `slope`.
inline dvec3 direction_of(double slope, double angle = 0.7)
{
  const double level = std::sqrt(std::max(0.0, 1.0 - slope * slope));
  return { level * std::cos(angle), level * std::sin(angle), slope };
}

inline double henyey_greenstein(double g, double cosine)
{
  return (1.0 - g * g) / (4.0 * pi) / std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5);
}

/// The extinction along a ray, by its definition.
struct Matter
{
  double k;
  double falloff;
  double height; ///< of the ray's origin over the base height
  double slope;

  double at(double s) const { return k * std::exp(-falloff * (height + slope * s)); }
  /// The depth of [from, to], in long double and in the form that suits the case.
  double depth(double from, double to) const
  {
    const long double b = static_cast<long double>(falloff) * slope;
    const long double begin = k * std::exp(-(falloff * (long double)height + b * from));
    if (std::isinf(to))
    {
      return b > 0.0L ? static_cast<double>(begin / b) : begin > 0.0L ? infinity : 0.0;
    }
    const long double x = b * (static_cast<long double>(to) - from);
    return static_cast<double>(std::abs(x) < 1e-12L ? begin * (to - from) * (1.0L - x / 2.0L)
                                                    : -begin * std::expm1(-x) / b);
  }
};

/// Where the depth from `from` on reaches 1, or so.
inline double place_of_depth_one(const Matter& matter, double from)
{
  double lower = from;
  double upper = from + 1e100;
  for (int i = 0; i < 500; ++i)
  {
    const double middle = upper > 2.0 * (lower + 1.0) ? std::sqrt((lower + 1e-3) * upper)
                                                      : 0.5 * (lower + upper);
    (matter.depth(from, middle) < 1.0 ? lower : upper) = middle;
  }
  return lower;
}

}
