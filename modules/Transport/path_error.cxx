#include "Transport/path_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brume
{

void PathError::add(const double variance[3])
{
  ++this->Pixels;
  this->Sum += variance[0] + variance[1] + variance[2];
  const double largest = std::max({ variance[0], variance[1], variance[2] });
  this->Unknown |= !std::isfinite(variance[0] + variance[1] + variance[2]);
  if (largest > 0.0)
  {
    const double place = (0.5 * std::log2(largest) - least_exponent) * parts;
    const double last = static_cast<double>(this->Bins.size() - 1);
    ++this->Bins[static_cast<std::size_t>(std::clamp(std::floor(place), 0.0, last))];
  }
}

double PathError::rms() const
{
  return this->Pixels > 0 ? std::sqrt(this->Sum / (3.0 * static_cast<double>(this->Pixels))) : 0.0;
}

double PathError::quantile(double beyond) const
{
  if (this->Unknown)
  {
    return std::numeric_limits<double>::infinity();
  }
  const auto share_beyond = [this](double error)
  {
    double sum = 0.0;
    for (std::size_t i = 0; i < this->Bins.size(); ++i)
    {
      if (this->Bins[i] > 0)
      {
        const double sigma = std::exp2((static_cast<double>(i) + 0.5) / parts + least_exponent);
        sum += static_cast<double>(this->Bins[i]) * std::erfc(error / (sigma * std::sqrt(2.0)));
      }
    }
    return sum / static_cast<double>(std::max<std::uint64_t>(this->Pixels, 1));
  };
  double low = std::exp2(least_exponent);
  double high = std::exp2(28.0);
  if (share_beyond(low) <= beyond)
  {
    return 0.0;
  }
  while (high > 1.005 * low)
  {
    const double middle = std::sqrt(low * high);
    (share_beyond(middle) > beyond ? low : high) = middle;
  }
  return high;
}

}
