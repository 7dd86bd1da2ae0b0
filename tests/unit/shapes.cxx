// Shapes by signed distance: exact where they say so, nowhere beyond their bound, and safe to step
// along. The oracle is a test of its own of what lies inside, and the nearest place found by search
// in all directions.
#include "data-generators/portable_math.h"
#include "data-generators/random.h"
#include "data-generators/sampling.h"
#include "data-generators/shape.h"
#include "data-generators/shape_text.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

using brume::Shape;
using glm::dvec3;
namespace shapes = brume::shapes;

/// Numbers in [0, 1), one after another.
class Numbers
{
public:
  explicit Numbers(std::uint32_t seed)
    : m_seed(seed)
  {
  }
  double next() { return brume::mix_bits(m_seed ^ brume::mix_bits(++m_count)) / 4294967296.0; }
  double between(double low, double high) { return low + (high - low) * this->next(); }
  dvec3 place(double half)
  {
    const double x = this->between(-half, half);
    const double y = this->between(-half, half);
    return { x, y, this->between(-half, half) };
  }
  dvec3 direction()
  {
    while (true)
    {
      const dvec3 d = this->place(1.0);
      const double length = glm::length(d);
      if (length > 0.1 && length < 1.0)
      {
        return d / length;
      }
    }
  }

private:
  std::uint32_t m_seed;
  std::uint32_t m_count = 0;
};

using Inside = std::function<bool(const dvec3&)>;

/// A shape, and what is inside of it by another formula.
struct Case
{
  std::string name;
  Shape shape;
  Inside inside;
};

/// Where between p and p + far * along, which is on the other side, the surface is crossed.
double bisected(const Inside& inside, const dvec3& p, const dvec3& along, double near, double far)
{
  const bool here = inside(p);
  for (int n = 0; n < 40; ++n)
  {
    const double middle = 0.5 * (near + far);
    (inside(p + middle * along) == here ? near : far) = middle;
  }
  return far;
}

/// Distance to where inside meets outside, at most `most`, by search: never too small.
double searched_distance(const Inside& inside, const dvec3& p, double most)
{
  const bool here = inside(p);
  double best = most;
  dvec3 toward(1.0, 0.0, 0.0);
  const int directions = 1000;
  const double step = 0.04;
  for (int n = 0; n < directions; ++n)
  {
    // Fibonacci's spiral.
    const double z = 1.0 - (2.0 * n + 1.0) / directions;
    const double r = std::sqrt(1.0 - z * z);
    const dvec3 d(r * std::cos(2.399963229728653 * n), r * std::sin(2.399963229728653 * n), z);
    for (double t = step; t < best; t += step)
    {
      if (inside(p + t * d) != here)
      {
        best = bisected(inside, p, d, t - step, t);
        toward = d;
      }
    }
  }
  // Then turned by chance, farther after a success, less far after a failure.
  Numbers random(17);
  double reach = 0.1;
  for (int n = 0; n < 1500 && reach > 1e-7; ++n)
  {
    const dvec3 d = glm::normalize(toward + reach * random.place(1.0));
    if (inside(p + (best - 1e-9) * d) != here)
    {
      best = bisected(inside, p, d, 0.0, best - 1e-9);
      toward = d;
      reach *= 1.6;
    }
    else
    {
      reach *= 0.93;
    }
  }
  return best;
}

bool in_sphere(const dvec3& p, double r)
{
  return glm::dot(p, p) < r * r;
}

bool in_box(const dvec3& p, const dvec3& half)
{
  return std::fabs(p.x) < half.x && std::fabs(p.y) < half.y && std::fabs(p.z) < half.z;
}

std::vector<Case> primitives()
{
  std::vector<Case> all;
  all.push_back(
    { "sphere", shapes::sphere(0.8), [](const dvec3& p) { return in_sphere(p, 0.8); } });
  all.push_back({ "box", shapes::box({ 0.9, 0.5, 0.3 }), [](const dvec3& p) {
                   return in_box(p, { 0.9, 0.5, 0.3 });
                 } });
  all.push_back({ "rounded box",
    shapes::box({ 0.9, 0.6, 0.5 }, 0.25),
    [](const dvec3& p)
    {
      const dvec3 nearest = glm::clamp(p, -dvec3(0.65, 0.35, 0.25), dvec3(0.65, 0.35, 0.25));
      return in_sphere(p - nearest, 0.25);
    } });
  all.push_back({ "torus",
    shapes::torus(0.7, 0.3),
    [](const dvec3& p)
    {
      const double r = std::hypot(p.x, p.y) - 0.7;
      return r * r + p.z * p.z < 0.09;
    } });
  all.push_back({ "capsule",
    shapes::capsule({ -0.5, 0.1, 0.0 }, { 0.6, 0.3, 0.4 }, 0.3),
    [](const dvec3& p)
    {
      for (int n = 0; n <= 200; ++n)
      {
        const double t = n / 200.0;
        if (in_sphere(p - ((1.0 - t) * dvec3(-0.5, 0.1, 0.0) + t * dvec3(0.6, 0.3, 0.4)), 0.3))
        {
          return true;
        }
      }
      return false;
    } });
  all.push_back({ "cylinder", shapes::cylinder(0.6, 0.7), [](const dvec3& p) {
                   return std::hypot(p.x, p.y) < 0.6 && std::fabs(p.z) < 0.7;
                 } });
  const auto in_cone = [](double bottom, double top, double h)
  {
    return [=](const dvec3& p)
    {
      return std::fabs(p.z) < h &&
             std::hypot(p.x, p.y) < bottom + (top - bottom) * 0.5 * (p.z / h + 1.0);
    };
  };
  all.push_back({ "cone", shapes::cone(0.8, 0.0, 0.6), in_cone(0.8, 0.0, 0.6) });
  all.push_back({ "cut cone", shapes::cone(0.3, 0.7, 0.5), in_cone(0.3, 0.7, 0.5) });
  for (const dvec3& r :
    { dvec3(0.9, 0.5, 0.3), dvec3(0.4, 0.4, 0.9), dvec3(0.3, 0.8, 0.8), dvec3(0.6, 0.6, 0.6) })
  {
    all.push_back(
      { "ellipsoid", shapes::ellipsoid(r), [r](const dvec3& p) { return in_sphere(p / r, 1.0); } });
  }
  all.push_back({ "plane", shapes::plane({ 1.0, 2.0, -2.0 }, 0.2), [](const dvec3& p) {
                   return p.x + 2.0 * p.y - 2.0 * p.z < 0.6;
                 } });
  return all;
}

std::vector<Case> combinations()
{
  const auto ball = [](const dvec3& at, double r) { return shapes::moved(shapes::sphere(r), at); };
  const dvec3 east(0.4, 0.1, 0.0);
  std::vector<Case> all;
  all.push_back({ "union",
    shapes::unite({ ball(east, 0.5), ball(-east, 0.4) }),
    [=](const dvec3& p) { return in_sphere(p - east, 0.5) || in_sphere(p + east, 0.4); } });
  all.push_back({ "union of two apart",
    shapes::unite({ ball(2.0 * east, 0.4), ball(-2.0 * east, 0.3) }),
    [=](const dvec3& p)
    { return in_sphere(p - 2.0 * east, 0.4) || in_sphere(p + 2.0 * east, 0.3); } });
  all.push_back({ "intersection",
    shapes::intersect({ ball(east, 0.7), shapes::box({ 0.5, 0.5, 0.5 }) }),
    [=](const dvec3& p) { return in_sphere(p - east, 0.7) && in_box(p, dvec3(0.5)); } });
  all.push_back({ "difference",
    shapes::subtract(shapes::box({ 0.8, 0.6, 0.5 }), ball({ 0.5, 0.3, 0.3 }, 0.5)),
    [=](const dvec3& p) {
      return in_box(p, { 0.8, 0.6, 0.5 }) && !in_sphere(p - dvec3(0.5, 0.3, 0.3), 0.5);
    } });
  all.push_back(
    { "complement", shapes::complement(shapes::box({ 0.6, 0.5, 0.4 })), [](const dvec3& p) {
       return !in_box(p, { 0.6, 0.5, 0.4 });
     } });
  all.push_back({ "turned, scaled and moved",
    shapes::moved(
      shapes::scaled(shapes::rotated(shapes::box({ 0.3, 0.2, 0.1 }), { 0, 0, 1 }, 30.0), 2.5),
      { 0.2, 0.0, -0.1 }),
    [](const dvec3& p)
    {
      const dvec3 q = (p - dvec3(0.2, 0.0, -0.1)) / 2.5;
      const double c = std::cos(M_PI / 6.0), s = std::sin(M_PI / 6.0);
      return in_box({ c * q.x + s * q.y, -s * q.x + c * q.y, q.z }, { 0.3, 0.2, 0.1 });
    } });
  // A part that leans over the border of its cell, toward one side.
  const dvec3 off(0.3, -0.2, 0.1);
  const auto in_copies = [](const Inside& part, const dvec3& spacing, int low, int high)
  {
    return [=](const dvec3& p)
    {
      // The cell of the place and those around it, and theirs: no part here reaches farther.
      int from[3] = { 0, 0, 0 }, to[3] = { 0, 0, 0 };
      for (int a = 0; a < 3; ++a)
      {
        if (spacing[a] > 0.0)
        {
          const int cell = static_cast<int>(std::floor(p[a] / spacing[a] + 0.5));
          from[a] = std::max(cell - 2, low);
          to[a] = std::min(cell + 2, high);
        }
      }
      for (int k = from[2]; k <= to[2]; ++k)
        for (int j = from[1]; j <= to[1]; ++j)
          for (int i = from[0]; i <= to[0]; ++i)
          {
            if (part(p - dvec3(i, j, k) * spacing))
            {
              return true;
            }
          }
      return false;
    };
  };
  const Inside part = [=](const dvec3& p) { return in_sphere(p - off, 0.3); };
  all.push_back({ "copies without end",
    shapes::repeated(ball(off, 0.3), { 0.9, 1.1, 0.8 }),
    in_copies(part, { 0.9, 1.1, 0.8 }, -99, 99) });
  all.push_back({ "copies in a plane",
    shapes::repeated(ball(off, 0.3), { 0.9, 0.7, 0.0 }),
    in_copies(part, { 0.9, 0.7, 0.0 }, -99, 99) });
  all.push_back({ "few copies",
    shapes::repeated(ball(off, 0.3), { 0.9, 0.7, 0.8 }, { 3, 3, 3 }),
    in_copies(part, { 0.9, 0.7, 0.8 }, -1, 1) });
  all.push_back({ "copies that overlap",
    shapes::repeated(ball(off, 0.3), { 0.45, 0.7, 0.0 }),
    in_copies(part, { 0.45, 0.7, 0.0 }, -99, 99) });
  all.push_back({ "copies of a bitten box",
    shapes::repeated(
      shapes::subtract(shapes::box({ 0.35, 0.3, 0.3 }), ball({ 0.3, 0.2, 0.0 }, 0.3)),
      { 0.8, 0.75, 0.9 }),
    in_copies(
      [](const dvec3& p) {
        return in_box(p, { 0.35, 0.3, 0.3 }) && !in_sphere(p - dvec3(0.3, 0.2, 0.0), 0.3);
      },
      { 0.8, 0.75, 0.9 },
      -99,
      99) });
  all.push_back({ "grown", shapes::grown(shapes::box({ 0.4, 0.3, 0.2 }), 0.2), [](const dvec3& p) {
                   return in_sphere(
                     p - glm::clamp(p, -dvec3(0.4, 0.3, 0.2), dvec3(0.4, 0.3, 0.2)), 0.2);
                 } });
  all.push_back({ "shell", shapes::shell(shapes::sphere(0.7), 0.2), [](const dvec3& p) {
                   return in_sphere(p, 0.8) && !in_sphere(p, 0.6);
                 } });
  return all;
}

/// Those whose inside is what f says, and whose bound is other than 1, or not exact anywhere.
std::vector<Case> bent()
{
  std::vector<std::pair<std::string, Shape>> list;
  const Shape bar = shapes::box({ 0.4, 0.2, 1.0 });
  const Shape twist = shapes::twisted(bar, 120.0);
  list.emplace_back("twist", twist);
  list.emplace_back("twist of what stands off the axis",
    shapes::twisted(shapes::moved(shapes::box({ 0.2, 0.2, 0.8 }), { 0.6, 0.0, 0.0 }), -80.0));
  list.emplace_back("waves", shapes::displaced_by_waves(shapes::sphere(0.7), 0.1, 0.5));
  list.emplace_back("noise", shapes::displaced_by_noise(shapes::sphere(0.7), 0.2, 0.4, 3));
  list.emplace_back("copies of waves",
    shapes::repeated(
      shapes::displaced_by_waves(shapes::sphere(0.3), 0.06, 0.3), { 0.8, 0.9, 1.0 }));
  list.emplace_back("few copies of a twist",
    shapes::repeated(shapes::scaled(twist, 0.4), { 0.5, 0.5, 0.0 }, { 3, 2, 1 }));
  list.emplace_back("fillet",
    shapes::smooth_unite(
      shapes::sphere(0.5), shapes::moved(shapes::box({ 0.3, 0.3, 0.3 }), { 0.6, 0, 0 }), 0.3));
  list.emplace_back("rounded bite",
    shapes::smooth_subtract(shapes::box({ 0.7, 0.6, 0.5 }), shapes::sphere(0.6), 0.2));
  list.emplace_back("rounded core",
    shapes::smooth_intersect(shapes::box({ 0.7, 0.6, 0.5 }), shapes::sphere(0.7), 0.2));
  list.emplace_back("worn", shapes::grown(twist, -0.05));
  std::vector<Case> all;
  for (const auto& [name, shape] : list)
  {
    all.push_back({ name, shape, [s = shape](const dvec3& p) { return s.distance(p) < 0.0; } });
  }
  return all;
}

std::vector<Case> all_cases()
{
  std::vector<Case> all = primitives();
  for (const Case& c : combinations())
  {
    all.push_back(c);
  }
  for (const Case& c : bent())
  {
    all.push_back(c);
  }
  return all;
}

}

TEST(Shapes, AreExactWhereTheySaySo)
{
  std::vector<Case> all = primitives();
  for (const Case& c : all)
  {
    EXPECT_TRUE(c.shape.exact_outside() && c.shape.exact_inside()) << c.name;
  }
  for (const Case& c : combinations())
  {
    all.push_back(c);
  }
  Numbers random(1);
  for (const Case& c : all)
  {
    ASSERT_EQ(c.shape.lipschitz(), 1.0) << c.name;
    for (int n = 0; n < 25; ++n)
    {
      const dvec3 p = random.place(1.4);
      const double f = c.shape.distance(p);
      const bool inside = c.inside(p);
      const double d = searched_distance(c.inside, p, 1.3);
      ASSERT_EQ(f < 0.0, inside) << c.name << ' ' << p.x << ' ' << p.y << ' ' << p.z;
      // The search finds a place of the surface, not always quite the nearest.
      EXPECT_LE(std::min(std::fabs(f), 1.2), d + 1e-9)
        << c.name << ' ' << p.x << ' ' << p.y << ' ' << p.z;
      if (inside ? c.shape.exact_inside() : c.shape.exact_outside())
      {
        EXPECT_NEAR(std::min(std::fabs(f), 1.2), std::min(d, 1.2), 0.02)
          << c.name << ' ' << p.x << ' ' << p.y << ' ' << p.z;
      }
    }
  }
}

TEST(Shapes, SayWhereTheyAreNot)
{
  for (const Case& c : combinations())
  {
    const bool outside =
      c.name != "intersection" && c.name != "difference" && c.name != "copies of a bitten box";
    EXPECT_EQ(c.shape.exact_outside(), outside) << c.name;
    const bool inside = c.name != "union" && c.name != "copies that overlap" && c.name != "grown" &&
                        c.name != "shell";
    EXPECT_EQ(c.shape.exact_inside(), inside) << c.name;
  }
  for (const Case& c : bent())
  {
    EXPECT_FALSE(c.shape.exact_outside() || c.shape.exact_inside()) << c.name;
  }
}

TEST(Shapes, EllipsoidsFindTheNearestPlaceToTheLastBits)
{
  // The way from the surface along the normal and back: p = s + t n has the distance t, up to the
  // smallest radius of curvature inside, without limit outside.
  Numbers random(2);
  for (const dvec3& r : { dvec3(3.0, 2.0, 1.0), dvec3(1.0, 1.0, 0.2), dvec3(0.01, 1.0, 1.0) })
  {
    const Shape shape = shapes::ellipsoid(r);
    const double least = std::min({ r.x, r.y, r.z }), most = std::max({ r.x, r.y, r.z });
    const double curvature = least * least / most;
    for (int n = 0; n < 500; ++n)
    {
      const dvec3 u = random.direction();
      const dvec3 s = r * u;
      const dvec3 normal = glm::normalize(u / r);
      const double t = random.between(-0.99 * curvature, 3.0);
      EXPECT_NEAR(shape.distance(s + t * normal), t, 1e-13 * most * (1.0 + std::fabs(t)));
    }
    EXPECT_NEAR(shape.distance(dvec3(0.0)), -least, 1e-13);
  }
  // On the long axis, within the evolute: two nearest places, off the axis.
  EXPECT_NEAR(shapes::ellipsoid({ 2.0, 1.0, 1.0 }).distance({ 0.75, 0.0, 0.0 }),
    -std::sqrt(0.8125), // (x - 0.75)^2 + 1 - x^2/4 is least at x = 1: 1/16 + 3/4
    1e-13);
}

TEST(Shapes, NeverChangeFasterThanTheirBound)
{
  Numbers random(3);
  for (const Case& c : all_cases())
  {
    const double most = c.shape.lipschitz();
    double steepest = 0.0;
    for (int n = 0; n < 20000; ++n)
    {
      const dvec3 a = random.place(1.5);
      const dvec3 b =
        n % 4 == 0 ? random.place(1.5) : a + random.between(1e-4, 0.1) * random.direction();
      const double way = glm::length(a - b);
      const double change = std::fabs(c.shape.distance(a) - c.shape.distance(b));
      steepest = std::max(steepest, change / way);
      // Noise is given in single precision: 1e-7 of its amplitude.
      ASSERT_LE(change, most * way + 1e-7) << c.name << ' ' << a.x << ' ' << a.y << ' ' << a.z;
    }
    // The bound is not idle: two thirds of it happen.
    const double idle = c.name == "noise" ? 0.45 : 0.66;
    EXPECT_GT(steepest, idle * most) << c.name;
  }
}

TEST(Shapes, AreSteppedAlongWithoutPassingThrough)
{
  // Rays in all directions; the truth is the sign along the ray, looked at every 0.001.
  Numbers random(4);
  int hits = 0, misses = 0, from_within = 0;
  for (const Case& c : all_cases())
  {
    if (c.name == "capsule")
    {
      continue; // its oracle is slow, and it is half a sphere
    }
    for (int n = 0; n < 40; ++n)
    {
      const dvec3 origin = random.place(1.3);
      const dvec3 along = random.direction();
      const double to = 2.5;
      const bool within = c.inside(origin);
      double truth = to;
      for (double t = 0.0; t < to; t += 0.001)
      {
        if (c.inside(origin + t * along) != within)
        {
          truth = t;
          break;
        }
      }
      const brume::ShapeHit hit =
        brume::sphere_trace(c.shape, origin, 2.0 * along, 0.0, to, 1e-7, 100000);
      from_within += within;
      if (hit.hit)
      {
        ++hits;
        // At a grazing place it may stop before the ray goes through.
        EXPECT_LE(hit.distance, truth + 1e-6) << c.name;
        EXPECT_LE(std::fabs(c.shape.distance(origin + hit.distance * along)), 1e-7) << c.name;
      }
      else
      {
        ++misses;
        EXPECT_EQ(truth, to) << c.name << " passed through at " << truth;
        EXPECT_NEAR(hit.distance, to, 1e-12) << c.name;
      }
    }
  }
  EXPECT_GT(hits, 300);
  EXPECT_GT(misses, 100);
  EXPECT_GT(from_within, 100);
}

TEST(Shapes, CopiesAreRightAtTheBordersOfCells)
{
  // Against the least over many copies, at borders and on the side below 0.
  const Shape part = shapes::moved(shapes::box({ 0.3, 0.1, 0.2 }), { 0.25, 0.0, -0.1 });
  const dvec3 s(1.0, 0.5, 0.75);
  const Shape all = shapes::repeated(part, s);
  const Shape some = shapes::repeated(part, s, { 4, 1, 3 });
  Numbers random(5);
  for (int n = 0; n < 2000; ++n)
  {
    dvec3 p = random.place(3.0);
    if (n % 2 == 0)
    {
      p.x = s.x * (std::floor(p.x / s.x) + 0.5) + (n % 4 == 0 ? 1e-12 : -1e-12);
    }
    double every = 1e300, few = 1e300;
    for (int k = -9; k <= 9; ++k)
      for (int j = -12; j <= 12; ++j)
        for (int i = -6; i <= 6; ++i)
        {
          const double d = part.distance(p - dvec3(i, j, k) * s);
          every = std::min(every, d);
          if (i >= -1 && i <= 2 && j == 0 && k >= -1 && k <= 1)
          {
            few = std::min(few, d);
          }
        }
    ASSERT_NEAR(all.distance(p), every, 1e-12);
    ASSERT_NEAR(some.distance(p), few, 1e-12);
  }
  // Far out, where places are rounded, there is still an answer, and soon.
  EXPECT_TRUE(std::isfinite(all.distance({ 1e30, -1e300, 1e18 })));
  EXPECT_TRUE(std::isnan(all.distance({ 1.0, std::numeric_limits<double>::infinity(), 0.0 })));
}

TEST(Shapes, LieWithinTheirBounds)
{
  Numbers random(6);
  for (const Case& c : all_cases())
  {
    const brume::Box box = c.shape.bounds();
    int inside = 0;
    for (int n = 0; n < 20000; ++n)
    {
      const dvec3 p = random.place(2.0);
      if (c.shape.distance(p) < 0.0)
      {
        ++inside;
        for (int a = 0; a < 3; ++a)
        {
          ASSERT_GE(p[a], box.lower[a]) << c.name;
          ASSERT_LE(p[a], box.upper[a]) << c.name;
        }
      }
    }
    EXPECT_GT(inside, 20) << c.name;
  }
  const brume::Box half = shapes::plane({ 0, 0, -3 }, 2.0).bounds();
  EXPECT_EQ(half.lower.z, -2.0);
  EXPECT_TRUE(std::isinf(half.upper.z) && std::isinf(half.lower.x));
}

TEST(Shapes, HaveGradientsOfLengthOne)
{
  Numbers random(7);
  for (const Case& c : primitives())
  {
    for (int n = 0; n < 200; ++n)
    {
      const dvec3 p = random.place(1.5);
      const dvec3 g = c.shape.gradient(p);
      EXPECT_LE(glm::length(g), 1.0 + 1e-9) << c.name;
      // The way back along it leads to the surface, but from edges of the field.
      const double left = c.shape.distance(p - c.shape.distance(p) * g);
      EXPECT_LT(std::fabs(left), glm::length(g) > 1.0 - 1e-6 ? 1e-5 : 1.0) << c.name;
    }
  }
}

TEST(Shapes, HaveTheSameBytesEverywhere)
{
  const Shape scene = brume::shape_from_text(
    "(unite (twist 40 (noise 0.1 0.3 5 (box 0.3 0.3 0.8 0.05)))"
    " (waves 0.03 0.2 (ellipsoid 0.9 0.5 0.2)) (rotate 1 2 3 40 (torus 0.8 0.1)))");
  const brume::Lattice grid = brume::grid_over({ dvec3(-1.0), dvec3(1.0) }, 32);
  std::vector<float> values(brume::whole_extent(grid).voxels());
  brume::sample(brume::ShapeField(
                  scene, { dvec3(-1.0), dvec3(1.0) }, brume::ShapeField::Quantity::density, 0.1),
    0.0,
    grid,
    brume::whole_extent(grid),
    values.data());
  std::uint64_t hash = 0xcbf29ce484222325ull;
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t n = 0; n < values.size() * sizeof(float); ++n)
  {
    hash = (hash ^ bytes[n]) * 0x100000001b3ull;
  }
  EXPECT_EQ(hash, 12755208655981825165ull);
}

TEST(Shapes, FieldsKnowTheirRangeInABox)
{
  using Quantity = brume::ShapeField::Quantity;
  Numbers random(10);
  const Shape shape = shapes::displaced_by_waves(shapes::torus(0.7, 0.3), 0.05, 0.5);
  int empty = 0, full = 0;
  for (const Quantity quantity : { Quantity::distance, Quantity::density })
  {
    const brume::ShapeField field(shape, shape.bounds(), quantity, 0.1);
    for (int n = 0; n < 500; ++n)
    {
      const dvec3 centre = random.place(1.2);
      const dvec3 half = glm::abs(random.place(0.12));
      const brume::FieldRange range = field.range_in({ centre - half, centre + half }, 0.0);
      empty += range.upper == 0.0f;
      full += range.lower == 1.0f;
      for (int m = 0; m < 50; ++m)
      {
        const float value = field.value(centre + half * random.place(1.0), 0.0);
        ASSERT_GE(value, range.lower);
        ASSERT_LE(value, range.upper);
      }
    }
  }
  EXPECT_GT(empty, 100);
  EXPECT_GT(full, 2);
}

TEST(Shapes, RefuseWhatMakesNone)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(shapes::sphere(0.0), std::invalid_argument);
  EXPECT_THROW(shapes::sphere(nan), std::invalid_argument);
  EXPECT_THROW(shapes::box({ 1, 1, 1 }, 2.0), std::invalid_argument);
  EXPECT_THROW(shapes::torus(0.1, 0.2), std::invalid_argument);
  EXPECT_THROW(shapes::cone(0.0, 0.0, 1.0), std::invalid_argument);
  EXPECT_THROW(shapes::plane({ 0, 0, 0 }, 1.0), std::invalid_argument);
  EXPECT_THROW(shapes::unite({}), std::invalid_argument);
  EXPECT_THROW(shapes::scaled(shapes::sphere(1.0), -1.0), std::invalid_argument);
  EXPECT_THROW(shapes::twisted(shapes::plane({ 0, 0, 1 }, 0.0), 10.0), std::invalid_argument);
  EXPECT_THROW(
    shapes::repeated(shapes::plane({ 0, 0, 1 }, 0.0), { 1, 0, 0 }), std::invalid_argument);
  EXPECT_THROW(shapes::repeated(shapes::sphere(10.0), dvec3(0.1)), std::invalid_argument);
  EXPECT_THROW(shapes::shell(shapes::sphere(1.0), 0.0), std::invalid_argument);
}

TEST(ShapeText, SaysWhatTheFunctionsSay)
{
  const Shape read = brume::shape_from_text("; a scene\n"
                                            "(subtract (smooth-unite .3 (sphere 1) (move 0 0 +1.2\n"
                                            "   (box 0.5 0.5 0.5 0.1))) ; bitten\n"
                                            " (rotate 0 1 0 45 (cylinder 2e-1 3)))\n");
  const Shape built = shapes::subtract(
    shapes::smooth_unite(
      shapes::sphere(1.0), shapes::moved(shapes::box({ 0.5, 0.5, 0.5 }, 0.1), { 0, 0, 1.2 }), 0.3),
    shapes::rotated(shapes::cylinder(0.2, 3.0), { 0, 1, 0 }, 45.0));
  Numbers random(8);
  for (int n = 0; n < 100; ++n)
  {
    const dvec3 p = random.place(2.0);
    EXPECT_EQ(read.distance(p), built.distance(p));
  }
}

TEST(ShapeText, KnowsEveryWord)
{
  for (const char* text : { "(sphere 1)",
         "(box 1 1 1)",
         "(box 1 1 1 .2)",
         "(torus 1 .2)",
         "(capsule 0 0 0 1 1 1 .2)",
         "(cylinder 1 1)",
         "(cone 1 0 1)",
         "(ellipsoid 1 2 3)",
         "(plane 0 0 1 0)",
         "(unite (sphere 1))",
         "(intersect (sphere 1) (sphere 2))",
         "(subtract (sphere 1) (sphere .5) (sphere .2))",
         "(complement (sphere 1))",
         "(smooth-unite .1 (sphere 1) (sphere 2) (sphere 3))",
         "(smooth-intersect .1 (sphere 1) (sphere 2))",
         "(smooth-subtract .1 (sphere 1) (sphere 2))",
         "(move 1 2 3 (sphere 1))",
         "(rotate 0 0 1 90 (sphere 1))",
         "(scale 2 (sphere 1))",
         "(twist 10 (sphere 1))",
         "(repeat 3 3 3 (sphere 1))",
         "(repeat 3 3 3 2 2 2 (sphere 1))",
         "(waves .1 1 (sphere 1))",
         "(noise .1 1 7 (sphere 1))",
         "(grow .1 (sphere 1))",
         "(shell .1 (sphere 1))" })
  {
    EXPECT_NO_THROW(brume::shape_from_text(text)) << text;
  }
}

TEST(ShapeText, TellsWhereItIsWrong)
{
  const auto message = [](const std::string& text) -> std::string
  {
    try
    {
      brume::shape_from_text(text);
    }
    catch (const std::invalid_argument& problem)
    {
      return problem.what();
    }
    return "no error";
  };
  EXPECT_EQ(message(""), "line 1, column 1: there is no shape");
  EXPECT_EQ(message("  ; only a word"), "line 1, column 16: there is no shape");
  EXPECT_EQ(
    message("sphere 1"), "line 1, column 1: a shape begins with a bracket, as in (sphere 1)");
  EXPECT_EQ(message("(unite\n  (sphere 1)\n  (spere 2))").substr(0, 38),
    "line 3, column 4: \"spere\" is no shape:");
  EXPECT_EQ(message("(sphere -1)"), "line 1, column 1: sphere: the radius must be above 0");
  EXPECT_EQ(message("(sphere 1 2)"),
    "line 1, column 1: here are 2 numbers and 0 shapes, but it is (sphere RADIUS)");
  EXPECT_EQ(
    message("(sphere 1x)"), "line 1, column 9: \"1x\" is not a number that can be used here");
  EXPECT_EQ(
    message("(sphere nan)"), "line 1, column 9: \"nan\" is not a number that can be used here");
  EXPECT_EQ(
    message("(unite (sphere 1)"), "line 1, column 1: the bracket opened here is not closed");
  EXPECT_EQ(message("(scale (sphere 1) 2)"),
    "line 1, column 19: numbers come before shapes: (scale FACTOR SHAPE)");
  EXPECT_EQ(message("(sphere 1) (sphere 2)").substr(0, 52),
    "line 1, column 12: something follows the shape: put ");
  EXPECT_EQ(message("(noise .1 1 1.5 (sphere 1))"),
    "line 1, column 1: counts and seeds are whole numbers, not below 0");
  std::string deep;
  for (int n = 0; n < 100000; ++n)
  {
    deep += "(unite ";
  }
  EXPECT_NE(message(deep).find("nested deeper"), std::string::npos);
  std::string many = "(smooth-unite .1 ";
  for (int n = 0; n < 4900; ++n)
  {
    many += "(sphere 1)";
  }
  EXPECT_LT(brume::shape_from_text(many + ")").distance(dvec3(0.0)), -1.0);
  for (int n = 0; n < 200; ++n)
  {
    many += "(sphere 1)";
  }
  EXPECT_NE(message(many + ")").find("more than 5000"), std::string::npos);
}

TEST(ShapeText, NestingTakesNoMoreThanItsShapes)
{
  std::string nested = "(sphere 1)";
  for (int n = 0; n < 150; ++n)
  {
    nested = "(unite " + nested + ")";
  }
  EXPECT_EQ(brume::shape_from_text(nested).bounds().upper.x, 1.0); // at once
  // Repeats multiply: 27 copies asked, of 27, of 27, of 27.
  Shape many = shapes::sphere(1.0);
  many = shapes::repeated(many, dvec3(1.5), glm::ivec3(100));
  many = shapes::repeated(many, dvec3(148.0), glm::ivec3(100));
  many = shapes::repeated(many, dvec3(14000.0), glm::ivec3(100));
  EXPECT_THROW(shapes::repeated(many, dvec3(1400000.0), glm::ivec3(100)), std::invalid_argument);
}

TEST(Grid, NeedsABoxThatIsFinite)
{
  const double endless = std::numeric_limits<double>::infinity();
  EXPECT_THROW(
    brume::grid_over({ dvec3(0.0), dvec3(1.0, endless, 1.0) }, 8), std::invalid_argument);
  EXPECT_THROW(brume::grid_over({ dvec3(-1.5e308), dvec3(1.5e308) }, 8), std::invalid_argument);
}

TEST(PortableMath, SinesAndCosinesAreRight)
{
  Numbers random(9);
  for (int n = 0; n < 20000; ++n)
  {
    const double x = random.between(-1.0, 1.0) * std::pow(10.0, random.between(-8.0, 6.0));
    const brume::SineCosine r = brume::portable_sincos(x);
    EXPECT_NEAR(r.sine, std::sin(x), 4e-16) << x;
    EXPECT_NEAR(r.cosine, std::cos(x), 4e-16) << x;
  }
  for (double x : { 123456789.123, -9.87654321e8 })
  {
    EXPECT_NEAR(brume::portable_sincos(x).sine, std::sin(x), 1e-13);
    EXPECT_NEAR(brume::portable_sincos(x).cosine, std::cos(x), 1e-13);
  }
  EXPECT_EQ(brume::portable_sincos(1e300).cosine, 1.0);
  EXPECT_EQ(brume::portable_sincos(std::nan("")).sine, 0.0);
}
