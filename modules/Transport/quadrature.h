// Gauss and Legendre's rule. Internal to Transport.
#pragma once

#include <array>
#include <cmath>

namespace brume
{

/// Nodes and weights over [−1, 1]: exact for polynomials of a degree up to 2 count − 1.
template <int count>
struct GaussLegendre
{
  std::array<double, count> nodes{};
  std::array<double, count> weights{};
};

/// The nodes are the roots of Legendre's polynomial, found by Newton's method from their asymptotic
/// places; the weights are 2 / ((1 − x²) P'²). Source: M. Abramowitz, I. Stegun, Handbook of
/// Mathematical Functions, 1964, 25.4.29 and 22.16.6.
template <int count>
const GaussLegendre<count>& gauss_legendre()
{
  static const GaussLegendre<count> rule = []
  {
    GaussLegendre<count> r;
    for (int i = 0; i < count; ++i)
    {
      double x = std::cos(3.14159265358979323846 * (i + 0.75) / (count + 0.5));
      double slope = 1.0;
      for (int step = 0; step < 20; ++step)
      {
        double value = x;
        double before = 1.0;
        for (int n = 2; n <= count; ++n)
        {
          const double next = ((2 * n - 1) * x * value - (n - 1) * before) / n;
          before = value;
          value = next;
        }
        slope = count * (x * value - before) / (x * x - 1.0);
        x -= value / slope;
      }
      r.nodes[i] = x;
      r.weights[i] = 2.0 / ((1.0 - x * x) * slope * slope);
    }
    return r;
  }();
  return rule;
}

}
