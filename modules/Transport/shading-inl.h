// Surface-like shading of a volume, once for scalars and packets. Included inside the namespace
// that has the number type R and its functions: dot, max, select, pow, rsqrt_or_zero.
// No include guard: shading.h includes it once, each SIMD target once more.

/// Light that a light source of the model sends to a point: how much, and from where.
template <class R>
struct Incidence
{
  Vec3<R> toward; ///< unit vector from the point toward the light
  R strength;     ///< attenuation and cone
};

/// The cone's cosᵉ fall-off (vtkLight) for light that travels along a unit vector.
template <class R>
R cone_factor(const ShadeLight& light, const Vec3<R>& travel)
{
  if (!(light.cone_cosine > -1.0f))
  {
    return broadcast<R>(1.0f);
  }
  const R cosine = dot(travel, broadcast3<R>(light.direction));
  return select(cosine >= broadcast<R>(light.cone_cosine),
    pow(max(cosine, broadcast<R>(1e-6f)), light.exponent), broadcast<R>(0.0f));
}

/// Incidence of a light at a place of the world. Distance attenuation 1/(a + b d + c d²) and the
/// cone's cosᵉ fall-off are VTK's (vtkLight).
template <class R>
Incidence<R> incidence(const ShadeLight& light, const Vec3<R>& place)
{
  const Vec3<R> along = broadcast3<R>(light.direction);
  if (!light.positional)
  {
    return { -along, broadcast<R>(1.0f) };
  }
  const Vec3<R> offset = place - broadcast3<R>(light.position);
  const R square = dot(offset, offset);
  const R inverse = rsqrt_or_zero(square);
  const R distance = square * inverse;
  const Vec3<R> travel = offset * inverse;
  const R weakening = broadcast<R>(light.attenuation[0]) +
    broadcast<R>(light.attenuation[1]) * distance + broadcast<R>(light.attenuation[2]) * square;
  // Never a division by 0: at the lamp itself, or with all its factors 0.
  R strength = broadcast<R>(1.0f) / max(weakening, broadcast<R>(1e-12f));
  if (light.cone_cosine > -1.0f)
  {
    strength = strength * cone_factor<R>(light, travel);
  }
  return { -travel, strength };
}

/// What a surface sends of a light, by the light it has already: adds to both.
template <class R>
void add_light(const ShadeModel& model,
  const ShadeLight& light,
  const Incidence<R>& from,
  const Vec3<R>& normal,
  const Vec3<R>& toward_viewer,
  Vec3<R>& diffuse,
  Vec3<R>& specular)
{
  const R zero = broadcast<R>(0.0f);
  const R n_dot_l = dot(normal, from.toward);
  const R lit = max(n_dot_l, zero) * from.strength;
  diffuse = diffuse + broadcast3<R>(light.diffuse) * lit;
  if (model.specular)
  {
    const Vec3<R> between = from.toward + toward_viewer;
    const R n_dot_h = dot(normal, between) * rsqrt_or_zero(dot(between, between));
    const R highlight =
      select(n_dot_l > zero, pow(max(n_dot_h, broadcast<R>(1e-6f)), model.specular_power), zero);
    specular = specular + broadcast3<R>(light.specular) * (highlight * from.strength);
  }
}

/// The normal against the gradient, turned toward the viewer when two-sided; 0 without a gradient.
template <class R>
Vec3<R> surface_normal(
  const ShadeModel& model, const Vec3<R>& gradient, const Vec3<R>& toward_viewer)
{
  const R zero = broadcast<R>(0.0f);
  const Vec3<R> normal = gradient * (zero - rsqrt_or_zero(dot(gradient, gradient)));
  if (!model.two_sided)
  {
    return normal;
  }
  const R facing = dot(normal, toward_viewer);
  return normal * select(facing >= zero, broadcast<R>(1.0f), broadcast<R>(-1.0f));
}

/// Blinn and Phong's model on the direction of the gradient, as vtkFixedPointVolumeRayCastMapper
/// has it: colour ← colour · (ambient + Σ diffuse) + Σ specular, with the normal against the
/// gradient and turned toward the viewer when two-sided. No gradient: the ambient term alone.
/// `gradient` is in world space and of any length, `toward_viewer` a unit vector.
/// Source: Blinn, Models of light reflection for computer synthesized pictures, SIGGRAPH 1977.
template <class R>
Vec3<R> shade(const ShadeModel& model, const Vec3<R>& gradient, const Vec3<R>& toward_viewer,
  const Vec3<R>& place, const Vec3<R>& colour)
{
  const R zero = broadcast<R>(0.0f);
  const Vec3<R> normal = surface_normal<R>(model, gradient, toward_viewer);
  Vec3<R> diffuse = broadcast3<R>(model.ambient);
  Vec3<R> specular{ zero, zero, zero };
  for (const ShadeLight& light : model.lights)
  {
    add_light<R>(
      model, light, incidence<R>(light, place), normal, toward_viewer, diffuse, specular);
  }
  return colour * diffuse + specular;
}
