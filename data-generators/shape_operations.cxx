// Shapes from several, and what changes a shape without moving it: unions, intersections, fillets,
// displacement, growth.
#include "data-generators/noise.h"
#include "data-generators/portable_math.h"
#include "data-generators/random.h"
#include "data-generators/shape_node.h"
#include "data-generators/signed_distance.h"

#include <algorithm>

namespace brume
{
namespace shapes
{

namespace
{

using glm::dvec3;

Box joined(const Box& a, const Box& b)
{
  return { glm::min(a.lower, b.lower), glm::max(a.upper, b.upper) };
}

Box common(const Box& a, const Box& b)
{
  return { glm::max(a.lower, b.lower), glm::min(a.upper, b.upper) };
}

bool apart(const Box& a, const Box& b)
{
  const Box both = common(a, b);
  return both.lower.x > both.upper.x || both.lower.y > both.upper.y || both.lower.z > both.upper.z;
}

const Box everywhere{ dvec3(-infinity), dvec3(infinity) };

struct Union : ShapeNode
{
  explicit Union(const std::vector<Shape>& given)
    : parts(given)
  {
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
      const ShapeNode& part = parts[i].node();
      boxes.push_back(part.reach(0.0));
      lipschitz = std::max(i == 0 ? 0.0 : lipschitz, part.lipschitz);
      cost += part.cost;
      exact_outside = exact_outside && part.exact_outside;
      exact_inside = exact_inside && part.exact_inside;
      for (std::size_t j = 0; j < i && exact_inside; ++j)
      {
        exact_inside = apart(boxes[i], boxes[j]);
      }
    }
  }
  double distance(const dvec3& p) const override
  {
    double d = infinity;
    for (const Shape& part : parts)
    {
      d = std::min(d, part.node().distance(p));
    }
    return d;
  }
  Box reach(double level) const override
  {
    Box box{ dvec3(infinity), dvec3(-infinity) };
    for (const Shape& part : parts)
    {
      box = joined(box, part.node().reach(level));
    }
    return box;
  }
  std::vector<Shape> parts;
};

struct Intersection : ShapeNode
{
  explicit Intersection(const std::vector<Shape>& given)
    : parts(given)
  {
    lipschitz = 0.0;
    exact_outside = parts.size() == 1 && parts.front().exact_outside();
    for (const Shape& part : parts)
    {
      cost += part.node().cost;
      lipschitz = std::max(lipschitz, part.lipschitz());
      exact_inside = exact_inside && part.exact_inside();
    }
  }
  double distance(const dvec3& p) const override
  {
    double d = -infinity;
    for (const Shape& part : parts)
    {
      d = std::max(d, part.node().distance(p));
    }
    return d;
  }
  Box reach(double level) const override
  {
    Box box = everywhere;
    for (const Shape& part : parts)
    {
      box = common(box, part.node().reach(level));
    }
    return box;
  }
  std::vector<Shape> parts;
};

struct Complement : ShapeNode
{
  explicit Complement(const Shape& part)
    : part(part)
  {
    cost = 1.0 + part.node().cost;
    lipschitz = part.lipschitz();
    exact_outside = part.exact_inside();
    exact_inside = part.exact_outside();
  }
  double distance(const dvec3& p) const override { return -part.node().distance(p); }
  Box reach(double) const override { return everywhere; }
  Shape part;
};

/// The smooth union; the other two are made of it with complements.
struct SmoothUnion : ShapeNode
{
  SmoothUnion(const Shape& a, const Shape& b, double width)
    : a(a)
    , b(b)
    , width(width)
  {
    cost = 1.0 + a.node().cost + b.node().cost;
    lipschitz = std::max(a.lipschitz(), b.lipschitz());
    exact_outside = false;
    exact_inside = false;
  }
  double distance(const dvec3& p) const override
  {
    return smooth_union(a.node().distance(p), b.node().distance(p), width);
  }
  // It is not below min(a, b) - width/4.
  Box reach(double level) const override
  {
    return joined(a.node().reach(level + 0.25 * width), b.node().reach(level + 0.25 * width));
  }
  Shape a, b;
  double width;
};

/// The smooth intersection of a and b: not below max(a, b).
struct SmoothIntersection : ShapeNode
{
  SmoothIntersection(const Shape& a, const Shape& b, double width)
    : a(a)
    , b(b)
    , width(width)
  {
    cost = 1.0 + a.node().cost + b.node().cost;
    lipschitz = std::max(a.lipschitz(), b.lipschitz());
    exact_outside = false;
    exact_inside = false;
  }
  double distance(const dvec3& p) const override
  {
    return smooth_intersection(a.node().distance(p), b.node().distance(p), width);
  }
  Box reach(double level) const override
  {
    return common(a.node().reach(level), b.node().reach(level));
  }
  Shape a, b;
  double width;
};

struct Waves : ShapeNode
{
  Waves(const Shape& part, double amplitude, double wavelength)
    : part(part)
    , amplitude(amplitude)
    , frequency(2.0 * pi / wavelength)
  {
    cost = 1.0 + part.node().cost;
    lipschitz = part.lipschitz() + std::fabs(amplitude) * frequency;
    exact_outside = exact_inside = false;
  }
  double distance(const dvec3& p) const override
  {
    return part.node().distance(p) + amplitude * portable_sincos(frequency * p.x).sine *
                                       portable_sincos(frequency * p.y).sine *
                                       portable_sincos(frequency * p.z).sine;
  }
  Box reach(double level) const override { return part.node().reach(level + std::fabs(amplitude)); }
  Shape part;
  double amplitude, frequency;
};

struct Noise : ShapeNode
{
  Noise(const Shape& part, double amplitude, double size, std::uint32_t seed)
    : part(part)
    , amplitude(amplitude)
    , size(size)
    , key(substream(seed, 60))
  {
    cost = 1.0 + part.node().cost;
    lipschitz = part.lipschitz() + 4.0 * std::fabs(amplitude) / size;
    exact_outside = exact_inside = false;
  }
  double distance(const dvec3& p) const override
  {
    return part.node().distance(p) + amplitude * perlin_noise(p / size, key);
  }
  Box reach(double level) const override { return part.node().reach(level + std::fabs(amplitude)); }
  Shape part;
  double amplitude, size;
  std::uint32_t key;
};

struct Grown : ShapeNode
{
  Grown(const Shape& part, double radius)
    : part(part)
    , radius(radius)
  {
    cost = 1.0 + part.node().cost;
    lipschitz = part.lipschitz();
    exact_outside = part.exact_outside() && radius >= 0.0;
    exact_inside = false;
  }
  double distance(const dvec3& p) const override { return part.node().distance(p) - radius; }
  Box reach(double level) const override
  {
    return part.node().reach(std::max(level + radius, 0.0));
  }
  Shape part;
  double radius;
};

struct Shell : ShapeNode
{
  Shell(const Shape& part, double thickness)
    : part(part)
    , half(0.5 * thickness)
  {
    cost = 1.0 + part.node().cost;
    lipschitz = part.lipschitz();
    exact_outside = part.exact_outside() && part.exact_inside();
    exact_inside = false;
  }
  double distance(const dvec3& p) const override
  {
    return std::fabs(part.node().distance(p)) - half;
  }
  Box reach(double level) const override { return part.node().reach(level + half); }
  Shape part;
  double half;
};

void require_parts(const std::vector<Shape>& parts)
{
  require(!parts.empty(), "a shape made of parts needs at least one");
}

void require_width(double width)
{
  require(width > 0.0 && std::isfinite(width), "the width of a fillet must be above 0");
}

}

Shape unite(const std::vector<Shape>& parts)
{
  require_parts(parts);
  return Shape(std::make_shared<const Union>(parts));
}

Shape intersect(const std::vector<Shape>& parts)
{
  require_parts(parts);
  return Shape(std::make_shared<const Intersection>(parts));
}

Shape complement(const Shape& part)
{
  return Shape(std::make_shared<const Complement>(part));
}

Shape subtract(const Shape& a, const Shape& b)
{
  return intersect({ a, complement(b) });
}

Shape smooth_unite(const Shape& a, const Shape& b, double width)
{
  require_width(width);
  return Shape(std::make_shared<const SmoothUnion>(a, b, width));
}

Shape smooth_intersect(const Shape& a, const Shape& b, double width)
{
  require_width(width);
  return Shape(std::make_shared<const SmoothIntersection>(a, b, width));
}

Shape smooth_subtract(const Shape& a, const Shape& b, double width)
{
  return smooth_intersect(a, complement(b), width);
}

Shape displaced_by_waves(const Shape& part, double amplitude, double wavelength)
{
  require(std::isfinite(amplitude), "waves: the amplitude must be finite");
  require(wavelength > 0.0 && std::isfinite(wavelength), "waves: the wavelength must be above 0");
  return Shape(std::make_shared<const Waves>(part, amplitude, wavelength));
}

Shape displaced_by_noise(const Shape& part, double amplitude, double size, std::uint32_t seed)
{
  require(std::isfinite(amplitude), "noise: the amplitude must be finite");
  require(size > 0.0 && std::isfinite(size), "noise: the size must be above 0");
  return Shape(std::make_shared<const Noise>(part, amplitude, size, seed));
}

Shape grown(const Shape& part, double radius)
{
  require(std::isfinite(radius), "grow: the radius must be finite");
  return Shape(std::make_shared<const Grown>(part, radius));
}

Shape shell(const Shape& part, double thickness)
{
  require(thickness > 0.0 && std::isfinite(thickness), "shell: the thickness must be above 0");
  return Shape(std::make_shared<const Shell>(part, thickness));
}

}
}
