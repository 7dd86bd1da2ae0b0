// What the march of lit media is made of: what it gathers, and the light of lamps, black bodies and
// powder at a place. Included by lit-inl.h inside the namespaces of a SIMD target.

/// What a packet gathers of lit media: also the transmittances of G and B.
struct LitGathered : Gathered
{
  Real through[3];
  Sum depths[3]; ///< of a grey medium the first alone
  bool coloured = false;

  HWY_INLINE const Sum& depth_of(int c) const { return depths[coloured ? c : 0]; }

  HWY_INLINE LitGathered()
    : Gathered()
    , through{ real(1.0f), real(1.0f), real(1.0f) }
  {
  }
};

/// A number of each channel; of a grey medium the three are one.
template <bool Chromatic>
struct Channels;
template <>
struct Channels<true>
{
  Real value[3];
  HWY_INLINE Real& operator[](int c) { return value[c]; }
  HWY_INLINE Real operator[](int c) const { return value[c]; }
};
template <>
struct Channels<false>
{
  Real value;
  HWY_INLINE Real& operator[](int) { return value; }
  HWY_INLINE Real operator[](int) const { return value; }
};

constexpr int lamp_points = 3;

/// A lamp at one place of a stretch.
struct LampPoint
{
  Real strength; ///< what arrives, attenuation, cone and the place's weight in it
  Real along;    ///< where the place is: 0 at the stretch's beginning, 1 at its end
  Real further;  ///< how much further off it is than if the distance ran evenly
  Vec3<Real> travel; ///< the light's direction there
};
struct LampStretch
{
  Real inverse_of_ends; ///< 1 / (the sum of the distances of both ends)
  LampPoint points[lamp_points];
};

/// What a lamp sends to a stretch, at three places of it: those of Gauss and Legendre, evenly over
/// the stretch, or, where the light weakens with the square of the distance d, over the angle that
/// the lamp sees it under. With b the way from the place nearest to the lamp, δ its distance and
/// r² = δ² + a / c,
///     ∫ f ds / (a + c d²) = 1 / (c r) ∫ f dφ,    s = r tan φ,
/// which stays right when the ray runs through the lamp. `offset` is the way from the lamp to the
/// stretch's middle, `length` the stretch's in the world.
HWY_INLINE void find_lamp_points(const ShadeLight& light,
  const Vec3<Real>& offset,
  const Vec3<Real>& viewer,
  Real length,
  LampStretch& lamp)
{
  const Real zero = hn::Zero(float_tag);
  const Real one = real(1.0f);
  const Real half = real(0.5f);
  const Real middle = hn::Neg(dot(offset, viewer));
  const Vec3<Real> nearest = offset + viewer * middle;
  const Mask some = length > zero;
  const Real inverse_length = hn::IfThenElseZero(some, one / hn::IfThenElse(some, length, one));
  const Real begin = hn::NegMulAdd(length, half, middle);
  const Real square = dot(nearest, nearest);
  const float constant_part = light.attenuation[0];
  const float linear_part = light.attenuation[1];
  const float square_part = light.attenuation[2];
  const bool by_angle = square_part > 0.0f;
  // A ray through the lamp itself would be infinitely bright there.
  const Real least = max(length * length * real(1e-10f), real(1e-30f));
  const Real r2 = max(square + real(by_angle ? constant_part / square_part : 0.0f), least);
  const Real inverse = rsqrt_or_zero(r2);
  const Real r = r2 * inverse;
  Real low = zero;
  Real angle = zero;
  if (by_angle)
  {
    low = hn::Atan(float_tag, begin * inverse);
    // atan2(h r, r² + b² − h²/4), in (0, π): what the difference of two angles would have lost.
    const Real y = length * r;
    const Real x = hn::MulAdd(middle, middle, r2) - length * length * real(0.25f);
    const Mask steep = hn::Abs(x) < y;
    const Real denominator = hn::IfThenElse(steep, y, x);
    const Mask any = hn::Abs(denominator) > zero;
    const Real slope = hn::Atan(float_tag,
      hn::IfThenElse(steep, x, y) / hn::IfThenElse(any, denominator, one));
    const Real pi = real(3.14159265f);
    angle = hn::IfThenElse(
      steep, pi * half - slope, hn::IfThenElse(x < zero, slope + pi, slope));
  }
  const auto distance = [&](Real s) { return hn::Sqrt(hn::MulAdd(s, s, square)); };
  const Real first = distance(begin);
  const Real last = distance(begin + length);
  const Real both = first + last;
  lamp.inverse_of_ends = one / max(both, real(1e-30f));
  for (int i = 0; i < lamp_points; ++i)
  {
    constexpr float places[lamp_points] = { 0.11270167f, 0.5f, 0.88729833f };
    constexpr float weights[lamp_points] = { 5.0f / 18.0f, 8.0f / 18.0f, 5.0f / 18.0f };
    Real s = hn::MulAdd(length, real(places[i]), begin);
    if (by_angle)
    {
      const Real at = hn::MulAdd(angle, real(places[i]), low);
      const Real cosine = hn::Cos(float_tag, at);
      s = r * hn::Sin(float_tag, at) / max(cosine, real(1e-7f));
      s = clamp(s, begin, begin + length);
    }
    const Real along = (s - begin) * inverse_length;
    const Real d = distance(s);
    const Vec3<Real> away = nearest - viewer * s;
    const Vec3<Real> travel = away * rsqrt_or_zero(dot(away, away));
    const Real square_term = real(square_part) * d * d + real(constant_part);
    const Real whole = hn::MulAdd(real(linear_part), d, square_term);
    Real strength;
    if (by_angle)
    {
      strength = angle * inverse * inverse_length * real(1.0f / square_part);
      if (linear_part != 0.0f)
      {
        strength = strength * square_term / max(whole, real(1e-12f));
      }
    }
    else
    {
      strength = one / max(whole, real(1e-12f));
    }
    strength = strength * real(weights[i]) * cone_factor<Real>(light, travel);
    lamp.points[i] = { strength, along, d - lerp(first, last, along), travel };
  }
}

/// What a black body of a volume's temperature array sends, R, G, B.
HWY_INLINE Vec3<Real> black_body_of(const LitVolume& medium, Real value)
{
  const BlackBodyTable& table = *medium.black_body;
  const Real at = clamp(value * real(medium.temperature_scale * table.scale), hn::Zero(float_tag),
    real(static_cast<float>(table.intervals)));
  const Int index = hn::Min(hn::ConvertTo(int_tag, at), integer(table.intervals - 1));
  const Real fraction = at - hn::ConvertTo(float_tag, index);
  const Int offset = hn::ShiftLeft<2>(index);
  const float* nodes = &table.nodes[0].red;
  Real body[3];
  for (int c = 0; c < 3; ++c)
  {
    body[c] = real(medium.black_body_scale) *
      lerp(hn::GatherIndex(float_tag, nodes + c, offset),
        hn::GatherIndex(float_tag, nodes + c + 4, offset), fraction);
  }
  return { body[0], body[1], body[2] };
}

/// See Powder: of a density or an opacity `value`, at a height from 0 to 1.
HWY_INLINE Real powder_of(const LitVolume& medium, Real value, Real height)
{
  const Real zero = hn::Zero(float_tag);
  const Real one = real(1.0f);
  const Real d = clamp(value * real(medium.powder_scale), zero, one);
  const Real strength = real(medium.powder_strength);
  if (medium.powder_form == Powder::Form::Exponential)
  {
    return one - strength * hn::Exp(float_tag, d * real(-2.0f));
  }
  const Real h = clamp(height, zero, one);
  const Real exponent = clamp(
    hn::MulAdd(h - real(0.3f), real(0.5f / 0.6f), real(0.5f)), real(0.5f), one);
  const Real base = clamp(hn::MulAdd(h, real(0.2f / 0.3f), real(0.8f)), real(0.8f), one);
  const Real power = hn::Exp(float_tag, exponent * hn::Log(float_tag, max(d, real(1e-30f))));
  const Real lower = hn::Exp(float_tag, real(0.8f) * hn::Log(float_tag, base));
  return one - clamp(strength * power, zero, one) * lower;
}
