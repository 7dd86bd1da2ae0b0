// Phase functions, once for scalars and packets. Included inside the namespace that has the number
// type R and its functions: constant, rsqrt_or_zero.
// No include guard: phase.h includes it once, each SIMD target once more.

/// The value (1/sr) at an angle θ between the directions of travel before and after, given by
/// 1 − cos θ and 1 + cos θ. Both are asked for because near 0 one of them keeps digits that cos θ has
/// lost: of unit vectors a and b they are ½ |a − b|² and ½ |a + b|².
///
/// Henyey and Greenstein's denominator is (1 − |g|)² + 2 |g| (1 ∓ cos θ), Schlick's
/// 1 − |k| + |k| (1 ∓ cos θ): sums of what is not negative, so that nothing cancels.
template <class R>
R phase(const PhaseModel& model, R one_minus_cosine, R one_plus_cosine)
{
  R sum = constant<R>(model.isotropic);
  if (model.rayleigh > 0.0)
  {
    const R cosine = (one_plus_cosine - one_minus_cosine) * constant<R>(0.5);
    sum = sum + constant<R>(model.rayleigh) * (constant<R>(1.0) + cosine * cosine);
  }
  for (const PhaseTerm& term : model.terms)
  {
    const R away = term.forward ? one_minus_cosine : one_plus_cosine;
    const R denominator = constant<R>(term.least) + constant<R>(term.slope) * away;
    const R inverse = rsqrt_or_zero(denominator);
    const R square = inverse * inverse;
    sum = sum + constant<R>(term.scale) * (term.schlick ? square * square : square * inverse);
  }
  return sum;
}
