// Fog in closed form, once for scalars and packets. Included inside the namespace that has the number
// type R and its functions: constant, max, select, transmittance_of, mean_transmittance_of.
// No include guard: fog.h includes it once, each SIMD target once more. Theory: docs/theory/fog.md.

/// ∫ f ds over a stretch of `length` between two places where the profile f = e^(−falloff · height) is
/// `begin` and `end`; `fall` = |falloff · Δheight|. Written from the denser end, where the mean of f is
/// f (1 − e^(−fall)) / fall: no 0/0 for a level stretch, no overflow for a steep one.
template <class R>
R fog_column(R begin, R end, R fall, R length)
{
  return max(begin, end) * length * mean_transmittance_of(fall);
}

/// ∫ e^(−τ_view − τ_light) dτ_view over a stretch of the optical depth `view`, at whose ends the depths
/// up to a light at infinity are `light_begin` and `light_end`. In layers both depths are linear in the
/// profile, hence in one another: with dτ_light/dτ_view = −`ratio` the integral is
/// e^(−light_begin) (1 − e^(−c view)) / c, c = 1 − ratio. Written from the end that is better lit, so
/// that no exponent is positive. `view` and `ratio` finite, with a
/// finite product.
template <class R>
R fog_lit_depth(R view, R light_begin, R light_end, R ratio)
{
  const R c = constant<R>(1.0) - ratio;
  const R zero = constant<R>(0.0);
  const R nearest = select(c > zero, light_begin, view + light_end);
  return transmittance_of(nearest) * view * mean_transmittance_of(max(c, zero - c) * view);
}
