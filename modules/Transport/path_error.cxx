#include "Transport/path_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brume
{

namespace
{

/// The ratio that figures are searched to.
constexpr double close = 1.005;

}

void PathError::add(const double variance[3], int paths)
{
  ++this->Pixels;
  this->Sum += variance[0] + variance[1] + variance[2];
  const double largest = std::max({ variance[0], variance[1], variance[2] });
  this->Unknown |= !std::isfinite(variance[0] + variance[1] + variance[2]);
  if (largest > 0.0)
  {
    const double place = (0.5 * std::log2(largest) - least_exponent) * parts;
    const double last = static_cast<double>(this->Bins.size() - 1);
    const auto bin = static_cast<std::size_t>(std::clamp(std::floor(place), 0.0, last));
    ++this->Bins[bin];
    this->Paths[bin] += paths;
  }
}

double PathError::rms() const
{
  return this->Pixels > 0 ? std::sqrt(this->Sum / (3.0 * static_cast<double>(this->Pixels))) : 0.0;
}

namespace
{

double middle_of(std::size_t bin, int least_exponent, int parts)
{
  return std::exp2((static_cast<double>(bin) + 0.5) / parts + least_exponent);
}

}

double PathError::share_beyond(double error, double cap) const
{
  double sum = 0.0;
  for (std::size_t i = 0; i < this->Bins.size(); ++i)
  {
    if (this->Bins[i] > 0)
    {
      const double sigma = std::min(middle_of(i, least_exponent, parts), cap);
      sum += static_cast<double>(this->Bins[i]) * std::erfc(error / (sigma * std::sqrt(2.0)));
    }
  }
  return sum / static_cast<double>(std::max<std::uint64_t>(this->Pixels, 1));
}

double PathError::quantile(double beyond) const
{
  constexpr double none = std::numeric_limits<double>::infinity();
  if (this->Unknown)
  {
    return none;
  }
  double low = std::exp2(least_exponent);
  double high = std::exp2(28.0);
  if (this->share_beyond(low, none) <= beyond)
  {
    return 0.0;
  }
  while (high > close * low)
  {
    const double middle = std::sqrt(low * high);
    (this->share_beyond(middle, none) > beyond ? low : high) = middle;
  }
  return high;
}

double PathError::cap(double error, double beyond) const
{
  constexpr double none = std::numeric_limits<double>::infinity();
  if (this->Unknown || this->share_beyond(error, none) <= beyond)
  {
    return none;
  }
  double low = std::exp2(least_exponent);
  double high = std::exp2(28.0);
  while (high > close * low)
  {
    const double middle = std::sqrt(low * high);
    (this->share_beyond(error, middle) <= beyond ? low : high) = middle;
  }
  return low;
}

double PathError::paths_to(double cap) const
{
  double sum = 0.0;
  for (std::size_t i = 0; i < this->Bins.size(); ++i)
  {
    if (this->Bins[i] > 0)
    {
      const double ratio = middle_of(i, least_exponent, parts) / cap;
      sum += ratio > 1.0 ? this->Paths[i] * (ratio * ratio - 1.0) : 0.0;
    }
  }
  return sum;
}

double PathError::cap_of(double paths) const
{
  double low = std::exp2(least_exponent);
  double high = std::exp2(28.0);
  while (high > close * low)
  {
    const double middle = std::sqrt(low * high);
    (this->paths_to(middle) > paths ? low : high) = middle;
  }
  return high;
}

}
