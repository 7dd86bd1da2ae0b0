#include "data-generators/shape.h"

#include "data-generators/shape_node.h"
#include "data-generators/shaping.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace brume
{

Shape::Shape(std::shared_ptr<const ShapeNode> node)
  : m_node(std::move(node))
{
  shapes::require(m_node->cost <= 1e5,
    "a distance would be the work of more than 100000 shapes: take fewer parts, or fewer repeats "
    "within repeats");
}

double Shape::distance(const glm::dvec3& place) const
{
  return shapes::finite(place) ? m_node->distance(place) : std::numeric_limits<double>::quiet_NaN();
}

glm::dvec3 Shape::gradient(const glm::dvec3& place, double scale) const
{
  const double h = 1e-5 * scale;
  glm::dvec3 slope;
  for (int a = 0; a < 3; ++a)
  {
    glm::dvec3 ahead = place;
    glm::dvec3 behind = place;
    ahead[a] += h;
    behind[a] -= h;
    slope[a] = (this->distance(ahead) - this->distance(behind)) / (ahead[a] - behind[a]);
  }
  return slope;
}

double Shape::lipschitz() const
{
  return m_node->lipschitz;
}

bool Shape::exact_outside() const
{
  return m_node->exact_outside;
}

bool Shape::exact_inside() const
{
  return m_node->exact_inside;
}

Box Shape::bounds() const
{
  return m_node->reach(0.0);
}

ShapeHit sphere_trace(const Shape& shape,
  const glm::dvec3& origin,
  const glm::dvec3& direction,
  double from,
  double to,
  double tolerance,
  int most_steps)
{
  const glm::dvec3 along = glm::normalize(direction);
  ShapeHit found;
  found.distance = from;
  while (found.distance <= to && found.steps < most_steps)
  {
    const double f = std::fabs(shape.distance(origin + found.distance * along));
    ++found.steps;
    if (!(f > tolerance))
    {
      found.hit = f <= tolerance;
      return found;
    }
    found.distance += f / shape.lipschitz();
  }
  found.distance = std::min(found.distance, to);
  return found;
}

ShapeField::ShapeField(const Shape& shape,
  const Box& box,
  Quantity quantity,
  double width,
  double band)
  : m_shape(shape)
  , m_box(box)
  , m_quantity(quantity)
  , m_width(width)
  , m_band(band)
{
  shapes::require(band > 0.0, "the band of a distance must be above 0");
  shapes::require(
    width >= 0.0 && std::isfinite(width), "the width of a surface must not be below 0");
}

float ShapeField::of_distance(double f) const
{
  return static_cast<float>(m_quantity == Quantity::distance
                              ? std::clamp(f, -m_band, m_band)
                              : smooth_ramp(-f, -0.5 * m_width, 0.5 * m_width));
}

float ShapeField::value(const glm::dvec3& place, double) const
{
  return this->of_distance(m_shape.distance(place));
}

FieldRange ShapeField::range_in(const Box& box, double) const
{
  const double f = m_shape.distance(0.5 * (box.lower + box.upper));
  const double reach = 0.5 * glm::length(box.upper - box.lower) * m_shape.lipschitz();
  // A little more than the bound, for what is rounded on the way.
  const double margin = reach + 1e-6 * (reach + std::fabs(f));
  if (!std::isfinite(margin))
  {
    return {};
  }
  const float a = this->of_distance(f - margin);
  const float b = this->of_distance(f + margin);
  return { std::min(a, b), std::max(a, b) };
}

}
