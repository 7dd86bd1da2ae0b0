// The shading model, prepared for a scene, and its formulas for double precision.
#pragma once

#include "Transport/scene.h"

#include <cmath>
#include <vector>

namespace brume
{

/// A light with the material's coefficients multiplied in; single precision, as kernels read it.
struct ShadeLight
{
  float diffuse[3];
  float specular[3];
  float direction[3];
  float position[3];
  float attenuation[3];
  float cone_cosine; ///< cosine of the cone's half angle; −1 or less for none
  float exponent;
  bool positional;
};

/// A light as kernels read it, its colours multiplied by factors.
ShadeLight prepare_light(const Light& light, double diffuse = 1.0, double specular = 1.0);

struct ShadeModel
{
  bool enabled = false;
  bool two_sided = true;
  bool specular = false; ///< whether any highlight can be seen
  bool needs_place = false;
  float ambient[3] = { 1, 1, 1 };
  float specular_power = 1;
  std::vector<ShadeLight> lights;
  /// Index-space gradient to a gradient in world space; row-major.
  float world_from_gradient[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
  /// Index space to world, for places; row-major 3 × 4.
  float world_from_index[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
  /// Upper bound of what shading makes of a colour of 1.
  double brightest = 1.0;
};

ShadeModel prepare_shading(const Scene& scene, const Volume& volume);

namespace scalar
{

template <class R>
struct Vec3
{
  R x, y, z;
  Vec3 operator+(const Vec3& b) const { return { x + b.x, y + b.y, z + b.z }; }
  Vec3 operator-(const Vec3& b) const { return { x - b.x, y - b.y, z - b.z }; }
  Vec3 operator*(const Vec3& b) const { return { x * b.x, y * b.y, z * b.z }; }
  Vec3 operator*(R s) const { return { x * s, y * s, z * s }; }
  Vec3 operator-() const { return { -x, -y, -z }; }
};

template <class R>
R broadcast(float value)
{
  return R(value);
}
template <class R>
Vec3<R> broadcast3(const float* v)
{
  return { R(v[0]), R(v[1]), R(v[2]) };
}
template <class R>
R dot(const Vec3<R>& a, const Vec3<R>& b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline double max(double a, double b)
{
  return a > b ? a : b;
}
inline double select(bool condition, double yes, double no)
{
  return condition ? yes : no;
}
inline double pow(double base, float exponent)
{
  return std::pow(base, static_cast<double>(exponent));
}
/// 1/√x, and 0 where x is not positive.
inline double rsqrt_or_zero(double x)
{
  return x > 0.0 ? 1.0 / std::sqrt(x) : 0.0;
}

#include "Transport/shading-inl.h"

}

}
