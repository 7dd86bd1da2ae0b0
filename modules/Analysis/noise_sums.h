// Sums over pixels of errors against a truth with noise. Internal to Analysis.
#pragma once

#include "study_errors.h"

#include <cmath>
#include <cstddef>

namespace brume
{

/// What a mean and a mean square freed of the truth's noise are made of (StudyErrors has the formulas).
struct NoiseSums
{
  std::size_t values = 0;
  double error = 0.0;       ///< Σ e
  double square = 0.0;      ///< Σ e² − d²/4
  double square_variance = 0.0; ///< Σ over pixels of (Σ_c e d)²
  double mean_variance = 0.0;   ///< Σ over pixels of (Σ_c d/2)², by chance of (Σ_c e)²

  /// `by_chance`: the picture has noise of its own, of which the mean's variance knows by the errors.
  void add(const Picture& picture,
    const Picture& truth,
    const TruthHalves& halves,
    bool by_chance,
    std::size_t pixel)
  {
    double cross = 0.0;
    double sum = 0.0;
    double noise = 0.0;
    for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i)
    {
      const double e = static_cast<double>(picture.rgb[i]) - static_cast<double>(truth.rgb[i]);
      const double d = halves.empty()
        ? 0.0
        : static_cast<double>(halves.a.rgb[i]) - static_cast<double>(halves.b.rgb[i]);
      sum += e;
      this->square += e * e - 0.25 * d * d;
      cross += e * d;
      noise += 0.5 * d;
    }
    this->values += 3;
    this->error += sum;
    this->square_variance += cross * cross;
    this->mean_variance += by_chance ? sum * sum : noise * noise;
  }

  double mean_square() const { return this->square / static_cast<double>(this->values); }
  double mean_square_error() const
  {
    return std::sqrt(this->square_variance) / static_cast<double>(this->values);
  }
  double mean() const { return this->error / static_cast<double>(this->values); }
  double mean_error() const
  {
    return std::sqrt(this->mean_variance) / static_cast<double>(this->values);
  }
};

}
