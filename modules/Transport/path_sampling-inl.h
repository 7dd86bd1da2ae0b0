// Directions drawn from phase functions, in packets: phase_sampler.h's. Included inside the
// namespace of a SIMD target, after phase-inl.h. No include guard: each SIMD target includes it
// once.

HWY_INLINE Vec3<Real> choose(Mask mask, const Vec3<Real>& yes, const Vec3<Real>& no)
{
  return { select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z) };
}
HWY_INLINE Int choose(Mask mask, Int yes, Int no)
{
  return hn::IfThenElse(hn::RebindMask(int_tag, mask), yes, no);
}

/// See brume::direction_around.
HWY_INLINE Vec3<Real> direction_around(const Vec3<Real>& axis, Real one_minus_cosine, Real turn)
{
  const Real one = real(1.0f);
  const Real sign = hn::CopySign(one, axis.z);
  const Real a = real(-1.0f) / (sign + axis.z);
  const Real b = axis.x * axis.y * a;
  const Vec3<Real> x{
    hn::MulAdd(sign * axis.x * axis.x, a, one), sign * b, hn::Neg(sign * axis.x)
  };
  const Vec3<Real> y{ b, hn::MulAdd(axis.y * axis.y, a, sign), hn::Neg(axis.y) };
  const Real m = clamp(one_minus_cosine, hn::Zero(float_tag), real(2.0f));
  const Real sine = hn::Sqrt(m * (real(2.0f) - m));
  const Real angle = turn * real(6.28318531f);
  const Vec3<Real> along = axis * (one - m) + x * (sine * hn::Cos(float_tag, angle)) +
                           y * (sine * hn::Sin(float_tag, angle));
  return along * (one / hn::Sqrt(dot(along, along)));
}

/// 1 − cos θ by one lobe; its formulas are explained in phase_sampler.cxx.
HWY_INLINE Real sample_lobe(PhaseFunction function, float parameter, Real u)
{
  const Real one = real(1.0f);
  const Real two = real(2.0f);
  switch (function)
  {
    case PhaseFunction::HenyeyGreenstein:
    {
      const Real less = real(1.0f - parameter);
      const Real inverse = one / hn::MulAdd(real(2.0f * parameter), u, less);
      const Real s = real((1.0f - parameter) * (1.0f + parameter)) * inverse;
      return less * (one - u) * inverse * (s + less);
    }
    case PhaseFunction::Schlick: // the parameter is 1 − k
      return real(2.0f * parameter) * (one - u) /
             hn::MulAdd(real(2.0f * (1.0f - parameter)), u, real(parameter));
    case PhaseFunction::Rayleigh:
    {
      const Real half = hn::MulSub(real(4.0f), u, two);
      const Real sum = hn::Abs(half) + hn::Sqrt(hn::MulAdd(half, half, one));
      const Real root = hn::Exp(float_tag, real(1.0f / 3.0f) * hn::Log(float_tag, sum));
      return one - hn::CopySign(root - one / root, half);
    }
    case PhaseFunction::Isotropic:
      break;
  }
  return two * u;
}

/// The next directions of light that travelled along `from`.
HWY_INLINE Vec3<Real> sample_phase(const PhaseSampler& phase,
  const Vec3<Real>& from,
  Real u,
  Real turn)
{
  const auto& lobes = phase.lobes();
  if (lobes.empty())
  {
    return direction_around(from, real(2.0f) * u, turn);
  }
  Real one_minus_cosine = hn::Zero(float_tag);
  Real before = hn::Zero(float_tag);
  for (std::size_t i = 0; i < lobes.size(); ++i)
  {
    // u is among the lobes first, and then in the part that is this one's.
    const Real up_to = real(static_cast<float>(lobes[i].up_to));
    const Real own = clamp((u - before) / (up_to - before), real(0x1p-25f), real(1.0f - 0x1p-24f));
    const Real found = sample_lobe(lobes[i].function, static_cast<float>(lobes[i].parameter), own);
    one_minus_cosine =
      select(u >= before, lobes[i].forward ? found : real(2.0f) - found, one_minus_cosine);
    before = up_to;
  }
  return direction_around(from, one_minus_cosine, turn);
}
