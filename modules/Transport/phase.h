// Phase functions, prepared from a medium's lobes. Theory: docs/theory/light.md.
#pragma once

#include "Transport/medium.h"
#include "Transport/shading.h"

#include <vector>

namespace brume
{

/// Anisotropies beyond are cut to this; nearer 0 than that, they count as 0.
constexpr double most_anisotropy = 0.9999;
constexpr double least_anisotropy = 1e-6;

/// scale · (least + slope · (1 ∓ cos θ))^(−3/2), or ^(−2) for Schlick's form.
struct PhaseTerm
{
  double scale;
  double least;
  double slope;
  bool forward; ///< 1 − cos θ counts, else 1 + cos θ
  bool schlick;
};

/// A weighted sum of lobes.
struct PhaseModel
{
  double isotropic = 0.0; ///< 1/sr
  double rayleigh = 0.0;  ///< factor of 1 + cos² θ
  std::vector<PhaseTerm> terms;

  /// Whether the value is the same for every angle.
  bool is_isotropic() const { return this->rayleigh == 0.0 && this->terms.empty(); }
};

/// The weighted mean of lobes (their weights are divided by their sum; none, or weights of 0: the
/// isotropic one), each g times `anisotropy_factor`. A lobe of |g| < 1e-6 counts as isotropic.
PhaseModel prepare_phase(
  const std::vector<PhaseLobe>& lobes, double anisotropy_factor = 1.0);

/// Adds what silver lining adds, where it is on.
void add_silver_lining(const SilverLining& lining, PhaseModel& model);

/// The k with which Schlick's function has the mean cosine g: near 1.55 g − 0.55 g³. |g| ≤ 0.9999.
/// Given as 1 − |k|, which keeps its digits near 1.
double schlick_one_minus_k(double g);

/// The largest value over all angles with cos θ between two bounds.
double largest_phase(
  const PhaseModel& model, double least_cosine = -1.0, double largest_cosine = 1.0);

namespace scalar
{

template <class R>
R constant(double v)
{
  return R(v);
}

#include "Transport/phase-inl.h"

}

}
