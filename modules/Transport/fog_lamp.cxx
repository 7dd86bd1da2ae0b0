// Light of lamps at a place, scattered by fog along a ray: a quadrature.
//
// With x the way along the ray from where it passes the lamp, and δ the distance there, x = δ sinh v.
// Distances are then δ cosh v: all lengths from δ on are met in even steps of v, whatever the light
// falls off with. (The substitution x = δ tan θ, which suits light that falls off with the square of
// the distance and nothing else, puts all its nodes near the lamp: light that does not fall off, as
// vtkLight's without attenuation, would be lost.) The singularities of distance, phase function and
// attenuation lie π/2 off the real axis, so that eight Gauss–Legendre nodes for each stretch of v ≤ 2.5
// leave 4e-6; stretches in which the fog changes by more are halved.
#include "Transport/fog.h"

#include "Transport/quadrature.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace brume
{

namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double longest_stretch = 2.5;
/// The largest change of the integrand's logarithm in a stretch.
constexpr double largest_change = 4.0;
constexpr int most_halvings = 24;
/// Some tens are enough for any ray that numbers can resolve.
constexpr int most_cuts = 2000;
/// e^−750 is 0.
constexpr double darkest = 750.0;
/// Stretches in which the integrand is e^−18 of what it is elsewhere, or less, are left out.
constexpr double negligible = 18.0;
/// Optical depths from which nothing comes: e^−40 = 4e-18.
constexpr double deepest = 40.0;

}

/// One ray's light of one lamp in a channel, by unit of irradiance: ∫ f p e^(−k column) strength dx.
class FogLampIntegral
{
public:
  FogLampIntegral(const FogModel& fog,
    const FogModel::Lamp& lamp,
    double extinction,
    const FogRay& ray,
    double from,
    double to)
    : Fog(fog)
    , Light(lamp)
    , Extinction(extinction)
    , Ray(ray)
    , From(from)
    , Begin(fog.profile(ray, from))
    , Fall(std::abs(fog.Falloff * ray.slope))
  {
    const glm::dvec3 offset = ray.origin - lamp.position;
    this->Nearest = -glm::dot(offset, ray.direction);
    this->Aside = offset + ray.direction * this->Nearest;
    this->Distance = glm::length(this->Aside);
    const double width = ray.spread * std::abs(this->Nearest);
    if (this->Distance < width && core(lamp.shape.attenuation) < width)
    {
      this->Aside = this->Distance > 0.0 ? this->Aside * (width / this->Distance)
                                         : aside_of(ray.direction) * width;
      this->Distance = width;
    }
    this->find_range(to);
  }

  double value()
  {
    // In order: where the range ends, the cone begins or ends, and the ray passes the lamp.
    std::array<double, 5> cuts{ this->Lower, this->Upper, 0.0, 0.0, 0.0 };
    std::size_t count = 2;
    const auto cut = [&](double x)
    {
      if (x > this->Lower && x < this->Upper)
      {
        std::size_t i = count++;
        for (; cuts[i - 1] > x; --i)
        {
          cuts[i] = cuts[i - 1];
        }
        cuts[i] = x;
      }
    };
    cut(0.0);
    double edges[2];
    if (this->Light.shape.cone_cosine > -1.0f)
    {
      const int found = this->cone_edges(edges);
      for (int i = 0; i < found; ++i)
      {
        cut(edges[i]);
      }
    }
    this->Width = std::max(this->Distance,
      1e-9 * std::max(std::abs(this->Lower), std::abs(this->Upper)));
    if (!(this->Width > 0.0))
    {
      return this->Sum;
    }
    std::array<Level, 5> levels{};
    for (std::size_t i = 0; i < count; ++i)
    {
      levels[i] = this->level(cuts[i]);
      this->Least = std::min(this->Least, levels[i].whole);
    }
    for (std::size_t i = 0; i + 1 < count; ++i)
    {
      if (this->in_cone(0.5 * (cuts[i] + cuts[i + 1])))
      {
        const double v0 = std::asinh(cuts[i] / this->Width);
        const double v1 = std::asinh(cuts[i + 1] / this->Width);
        this->add(v0, levels[i], v1, levels[i + 1], 0);
      }
    }
    return this->Sum;
  }

private:
  /// The distance within which light of 1 / (a + b d + c d²) hardly changes.
  static double core(const float attenuation[3])
  {
    const double a = attenuation[0];
    const double b = attenuation[1];
    const double c = attenuation[2];
    return a > 0.0 ? 2.0 * a / (b + std::sqrt(b * b + 4.0 * a * c)) : 0.0;
  }

  static glm::dvec3 aside_of(const glm::dvec3& direction)
  {
    const glm::dvec3 axis = std::abs(direction.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    return glm::normalize(glm::cross(direction, axis));
  }

  /// The stretch from which anything comes, as x.
  void find_range(double to)
  {
    to = std::min(
      to, this->Fog.place_of_column(this->Ray, this->From, deepest / this->Extinction));
    const double fall = this->Fog.Falloff * this->Ray.slope;
    if (fall > 0.0)
    {
      to = std::min(to, this->From + deepest / fall); // the fog itself ends there
    }
    to = std::min(to, std::max(this->From, std::abs(this->Nearest)) + 1e150);
    this->Lower = this->From - this->Nearest;
    this->Upper = std::max(this->Lower, to - this->Nearest);
  }

  glm::dvec3 offset(double x) const { return this->Aside + this->Ray.direction * x; }

  /// Where the ray meets the cone's surface: (A + B x)² = cos² (δ² + x²). Returns how often.
  int cone_edges(double* edges) const
  {
    const glm::dvec3 axis(this->Light.shape.direction[0], this->Light.shape.direction[1],
      this->Light.shape.direction[2]);
    const double cosine = this->Light.shape.cone_cosine;
    const double a = glm::dot(this->Aside, axis);
    const double b = glm::dot(this->Ray.direction, axis);
    const double square = b * b - cosine * cosine;
    const double constant = a * a - cosine * cosine * this->Distance * this->Distance;
    const double discriminant = a * a * b * b - square * constant;
    if (!(discriminant >= 0.0))
    {
      return 0;
    }
    const double q = -(a * b + std::copysign(std::sqrt(discriminant), a * b));
    int count = 0;
    for (double edge : { q / square, constant / q })
    {
      if (std::isfinite(edge))
      {
        edges[count++] = edge;
      }
    }
    return count;
  }

  bool in_cone(double x) const
  {
    return !(this->Light.shape.cone_cosine > -1.0f) || this->lit(x).strength > 0.0;
  }

  scalar::Incidence<double> lit(double x) const
  {
    const glm::dvec3 offset = this->offset(x);
    return scalar::incidence<double>(this->Light.shape, { offset.x, offset.y, offset.z });
  }

  double profile(double x) const
  {
    return this->Fog.Falloff > 0.0 ? this->Fog.profile(this->Ray, x + this->Nearest) : 1.0;
  }

  /// The columns from the ray's beginning and from the lamp to a place.
  double columns(double x, double profile) const
  {
    const double way = std::max(0.0, x - this->Lower);
    return FogModel::column_between(this->Begin, profile, this->Fall, way) +
           this->Fog.lamp_column(this->Light, profile, this->offset(x));
  }

  /// −1 times the integrand's logarithm at a place.
  struct Level
  {
    double fog;   ///< but for distance and angle, which the substitution takes care of
    double whole; ///< of what a step of v has, but for the phase function
  };
  Level level(double x) const
  {
    const double f = this->profile(x);
    const double strength = this->lit(x).strength;
    const double distance = std::hypot(std::max(this->Distance, this->Width), x);
    Level result;
    result.fog = std::min(this->Extinction * this->columns(x, f), 1e300) +
                 this->Fog.Falloff * this->Ray.slope * (x + this->Nearest);
    result.whole = result.fog - std::log(std::max(strength * distance, 1e-300));
    if (this->Light.shape.cone_cosine > -1.0f)
    {
      result.fog -= std::log(std::max(strength, 1e-6));
    }
    return result;
  }

  void add(double v0, const Level& l0, double v1, const Level& l1, int halvings)
  {
    const double middle = 0.5 * (v0 + v1);
    const Level l = this->level(this->Width * std::sinh(middle));
    const bool is_long = v1 - v0 > longest_stretch;
    this->Least = std::min(this->Least, l.whole);
    if (!is_long && std::min({ l0.whole, l.whole, l1.whole }) > this->Least + negligible)
    {
      return;
    }
    // What exponents of this size are rounded by is no change.
    const double rounding = 1e-14 * std::max({ std::abs(l0.fog), std::abs(l.fog), std::abs(l1.fog) });
    const double change = std::abs(l.fog - l0.fog) + std::abs(l1.fog - l.fog) - rounding;
    if (halvings < most_halvings &&
        (is_long || (change > largest_change && ++this->Cuts < most_cuts)))
    {
      this->add(v0, l0, middle, l, halvings + 1);
      this->add(middle, l, v1, l1, halvings + 1);
      return;
    }
    const GaussLegendre<8>& rule = gauss_legendre<8>();
    const double half = 0.5 * (v1 - v0);
    for (int i = 0; i < 8; ++i)
    {
      const double v = middle + half * rule.nodes[i];
      this->add_node(this->Width * std::sinh(v), rule.weights[i] * half * this->Width * std::cosh(v));
    }
  }

  void add_node(double x, double weight)
  {
    const double f = this->profile(x);
    const double depth = this->Extinction * this->columns(x, f);
    if (!(depth < darkest))
    {
      return; // f may be infinite
    }
    const scalar::Incidence<double> light = this->lit(x);
    // cos θ = −x / d; each of 1 ∓ cos θ in the form that does not cancel.
    const double square = this->Distance * this->Distance;
    const double d = std::sqrt(square + x * x);
    const double long_way = d + std::abs(x);
    const double larger = long_way / d;
    const double smaller = square / (d * long_way);
    const double p = scalar::phase<double>(
      this->Fog.Phase, x > 0.0 ? larger : smaller, x > 0.0 ? smaller : larger);
    this->Sum += weight * f * p * light.strength * std::exp(-depth);
  }

  const FogModel& Fog;
  const FogModel::Lamp& Light;
  double Extinction;
  const FogRay& Ray;
  double From;
  double Begin; ///< the profile where the stretch begins
  double Fall;
  double Nearest;    ///< s where the ray passes the lamp
  glm::dvec3 Aside;  ///< from the lamp to there
  double Distance;   ///< its length
  double Lower = 0.0;
  double Upper = 0.0;
  double Width = 0.0; ///< of the substitution: the distance, or next to nothing where it is 0
  double Least = darkest; ///< of Level::whole so far
  int Cuts = 0;
  double Sum = 0.0;
};

double FogModel::lamp_column(
  const Lamp& lamp, double profile, const glm::dvec3& offset) const
{
  const double length = glm::length(offset);
  if (!(this->Falloff > 0.0) || !(length > 0.0))
  {
    return length;
  }
  const double slope = std::abs(glm::dot(offset, this->Up)) / length;
  return column_between(profile, lamp.profile, this->Falloff * slope, length);
}

glm::dvec3 FogModel::lit_by_lamp(
  const Lamp& lamp, const FogRay& ray, double from, double to) const
{
  if (this->profile(ray, from) == infinity || lamp.profile == infinity)
  {
    return glm::dvec3(0.0); // nothing gets out of such fog, or through it
  }
  glm::dvec3 sum(0.0);
  for (int c = 0; c < 3; ++c)
  {
    const double k = this->Extinction[c];
    if (c > 0 && k == this->Extinction[c - 1])
    {
      sum[c] = sum[c - 1];
    }
    else if (k > 0.0)
    {
      sum[c] = k * FogLampIntegral(*this, lamp, k, ray, from, to).value();
    }
  }
  return this->Albedo * lamp.irradiance * sum;
}

}
