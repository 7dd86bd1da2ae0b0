// Directions drawn from phase functions. Theory: docs/theory/paths.md.
#pragma once

#include "Transport/medium.h"
#include "Transport/phase.h"
#include "Transport/random_stream.h"

#include <glm/vec3.hpp>

#include <vector>

namespace brume
{

/// Draws directions whose density over the sphere is the phase function itself, and tells its
/// value.
class PhaseSampler
{
public:
  PhaseSampler()
    : PhaseSampler(std::vector<PhaseLobe>())
  {
  }
  /// As prepare_phase() takes them.
  explicit PhaseSampler(const std::vector<PhaseLobe>& lobes);

  /// 1/sr, of light that travelled along `from` and goes on along `to`; unit vectors. The same as
  /// the density of sample().
  double value(const glm::dvec3& from, const glm::dvec3& to) const;

  /// The next direction of light that travelled along `from`.
  glm::dvec3 sample(const glm::dvec3& from, RandomStream& random) const;

  /// A part of the function.
  struct Lobe
  {
    double up_to; ///< the sum of the weights to here; the last is 1
    PhaseFunction function;
    double parameter; ///< g; of Schlick's 1 − |k|
    bool forward;
  };

  /// None: isotropic.
  const std::vector<Lobe>& lobes() const { return this->Lobes; }
  const PhaseModel& model() const { return this->Model; }

private:
  std::vector<Lobe> Lobes;
  PhaseModel Model;
};

/// A unit vector at an angle to `axis` (a unit vector) of this 1 − cosine, in [0, 2], and around it
/// by `turn`, in [0, 1].
glm::dvec3 direction_around(const glm::dvec3& axis, double one_minus_cosine, double turn);

}
