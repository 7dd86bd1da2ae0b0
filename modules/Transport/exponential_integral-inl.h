// The second exponential integral for packets. Included inside the namespaces of a SIMD target, once
// for each, after packet-inl.h; exponential_integral.h has it in double precision.

/// E₂(x) for x ≥ 0, within 3e-7: e⁻ˣ − x E₁(x) by the approximations 5.1.53 (below 1) and 5.1.56 of E₁ in
/// M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, 1964; from 1 on with the
/// difference of numerator and denominator written out, so that nothing cancels.
HWY_INLINE Real second_exponential_integral(Real x)
{
  const Real passes = hn::Exp(float_tag, hn::Neg(x));
  const auto polynomial = [](Real at, std::initializer_list<float> highest_first)
  {
    Real sum = hn::Zero(float_tag);
    for (const float coefficient : highest_first)
    {
      sum = hn::MulAdd(sum, at, real(coefficient));
    }
    return sum;
  };
  const Real small = hn::Min(x, real(1.0f));
  const Real low = small * (hn::Log(float_tag, max(small, real(1e-30f))) -
    polynomial(small, { 0.00107857f, -0.00976004f, 0.05519968f, -0.24991055f, 0.99999193f, -0.57721566f }));
  const Real large = clamp(x, real(1.0f), real(90.0f));
  const Real high = passes *
    polynomial(large, { 0.9999936053f, 7.5739391756f, 12.4648921902f, 3.6907231885f }) /
    polynomial(large, { 1.0f, 9.5733223454f, 25.6329561486f, 21.0996530827f, 3.9584969228f });
  return hn::IfThenElse(x < real(1.0f), passes + low, high);
}
