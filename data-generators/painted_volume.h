// A volume painted shape over shape, each with soft edges: how a phantom of tissues is made.
#pragma once

#include "data-generators/field.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace brume
{

/// Shapes painted one over the other onto a background. A shape is a signed distance (see
/// signed_distance.h); its layers are values that begin at given depths below its surface, so that
/// skin, fat and muscle need one distance between them. Where a layer begins, its value takes over
/// along 3 t^2 - 2 t^3 over the width `edge`: the partial volume of a voxel of about that size.
class PaintedVolume
{
public:
  using Distance = std::function<double(const glm::dvec3&)>;
  /// A value that varies: with the place, and the depth below the shape's surface.
  using Texture = std::function<double(const glm::dvec3& place, double depth)>;

  struct Layer
  {
    Layer(double depth, double value)
      : depth(depth)
      , value(value)
    {
    }
    Layer(double depth, Texture texture)
      : depth(depth)
      , texture(std::move(texture))
    {
    }
    double depth;       ///< below the shape's surface, world units; may be negative
    double value = 0.0; ///< where there is no texture
    Texture texture;
  };

  /// `edge` is in world units and above 0.
  PaintedVolume(const Box& box, double background, double edge);

  void paint(Distance distance, double value);
  /// Layers from the outside inward.
  void paint(Distance distance, std::vector<Layer> layers);

  /// Sorts what was painted into cells, so that value() asks only the shapes whose edges come near.
  /// To be called once, when all is painted.
  void finish();

  /// The value at a place of the box; outside of it the nearest cell answers.
  double value(const glm::dvec3& place) const;

  /// The same by asking every shape: slow, needs no finish(). A test compares the two.
  double value_by_all(const glm::dvec3& place) const;

private:
  struct Shape
  {
    Distance distance;
    std::vector<Layer> layers;
  };
  /// Layers [first, last) of a shape, of which the first covers the cell whole if `covered`.
  struct Entry
  {
    std::uint16_t shape;
    std::uint8_t first;
    std::uint8_t last;
    bool covered;
  };

  double blend(const Shape& shape,
    int first,
    int last,
    bool covered,
    const glm::dvec3& place,
    double below) const;
  /// What shows within `radius` of a centre, of the shapes named.
  std::vector<Entry> entries_of(const glm::dvec3& centre,
    double radius,
    const std::vector<std::uint16_t>& candidates) const;

  Box m_box;
  double m_background;
  double m_edge;
  std::vector<Shape> m_shapes;
  std::vector<std::vector<Entry>> m_cells;
};

}
