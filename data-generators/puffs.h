// What clouds of heaped shape are piled from: soft ellipsoids, sorted into cells so that a place
// asks only those that reach it. Internal to the generators.
#pragma once

#include "data-generators/field.h"
#include "data-generators/random.h"
#include "data-generators/shaping.h"

#include <cstdint>
#include <vector>

namespace brume
{

/// A soft ellipsoid with axes along x, y, z: f(p) = 1 - |(p - centre) / radii|^2, held to 0 and
/// above.
struct Puff
{
  glm::dvec3 centre;
  glm::dvec3 radii;
};

/// Random numbers in [0, 1), one after the other.
class RandomSequence
{
public:
  explicit RandomSequence(std::uint32_t key)
    : m_key(key)
  {
  }
  double next() { return unit_float(hash_lattice(m_counter++, 0, 0, m_key)); }
  double between(double low, double high) { return mix(low, high, next()); }

private:
  std::uint32_t m_key;
  std::uint32_t m_counter = 0;
};

/// The heap h(p) = 1 - prod (1 - f_b(p)^2) over all puffs b, in [0, 1].
class PuffHeap
{
public:
  /// `box` is where it is asked; `reach` is how far a place may be moved along each axis, after its
  /// cell was found, before it asks.
  PuffHeap(const std::vector<Puff>& puffs, const Box& box, double reach);

  /// Along each axis. 32, and level more the flatter the box, up to 512: a cell's puffs are few,
  /// however wide a field. Below 2^24 in all.
  const glm::ivec3& cells() const { return m_cells; }

  /// An upper bound of the heap at all places in a box, each moved by the reach or less.
  double most_in(const Box& box) const;

  // For the kernels: cell (i, j, k) has the puffs that begin at puffs() + lists()[n], n from
  // begin()[c] to begin()[c + 1], c = (k * cells().y + j) * cells().x + i: six numbers each, the
  // centre and one over the radii.
  const float* puffs() const { return m_puffs.data(); }
  const std::uint32_t* lists() const { return m_lists.data(); }
  const std::uint32_t* begin() const { return m_begin.data(); }
  const glm::dvec3& lower() const { return m_box.lower; }
  /// Cells in a unit of length.
  const glm::dvec3& cells_by_length() const { return m_scale; }

private:
  int cell_of(double x, int axis) const;

  /// Calls function(c) for each cell that the puff reaches.
  template <class Function>
  void for_cells_of(const Puff& puff, const Function& function) const;

  Box m_box;
  glm::ivec3 m_cells;
  glm::dvec3 m_scale;
  double m_reach;
  std::vector<float> m_puffs;
  std::vector<std::uint32_t> m_lists;
  std::vector<std::uint32_t> m_begin;
};

}
