#include "Transport/exponential_integral.h"

#include <cmath>

namespace brume
{

namespace
{

/// 1 + x (ln x + γ − 1) − Σ (−x)^m / ((m − 1) m!), m from 2 on; for 0 < x ≤ 1, where the sum is at
/// most seven times the result.
double series(double x)
{
  constexpr double euler = 0.57721566490153286061;
  double power = x; // −(−x)^m / m!
  double sum = 0.0;
  for (int m = 2; m < 24; ++m)
  {
    power *= -x / m;
    const double term = power / (m - 1);
    sum += term;
    if (std::abs(term) < 1e-18)
    {
      break;
    }
  }
  return 1.0 + (x * (std::log(x) + (euler - 1.0)) + sum);
}

/// e^(−x) / (x + 2 − 1·2 / (x + 4 − 2·3 / (x + 6 − …))), from the tail up; for x > 1.
double continued_fraction(double x)
{
  // Terms that are left out change the result by less than e^(−4 √(terms x)).
  const int terms = 8 + static_cast<int>(100.0 / x);
  double tail = x + 2.0 * (terms + 1);
  for (int k = terms; k > 0; --k)
  {
    tail = x + 2.0 * k - k * (k + 1.0) / tail;
  }
  return std::exp(-x) / tail;
}

}

double exponential_integral_2(double x)
{
  if (x <= 0.0)
  {
    return 1.0;
  }
  return x > 1.0 ? continued_fraction(x) : series(x);
}

}
