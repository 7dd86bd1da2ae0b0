// Light volumes and shadow maps of a scene: made by sweeping, kept while light and matter stand
// still. Internal to Transport.
#pragma once

#include "Transport/lit_task.h"
#include "Transport/march_task.h"
#include "Transport/raw_array.h"
#include "Transport/scene.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace brume
{

/// The memory of one lattice.
struct LightLattice
{
  int dims[3] = { 0, 0, 0 };
  glm::dmat4 node_from_world{ 1.0 };
  std::vector<double> key; ///< what it was made of
  RawArray<std::uint16_t> words[6];
  RawArray<float> floats[6];
  float scale = 1.0f;

  std::size_t bytes() const;
};

class LightMaps
{
public:
  /// Makes what is missing and fills in the lights of `lit`, whose volumes and frames are there.
  /// `volumes` are those of the scene, prepared; `spacing` the distance between nodes in the world,
  /// `voxel` the smallest voxel edge there. `matter` names all that shadows hang on but the lights;
  /// `ambient`: whether the light of sky and ground is wanted. `go`, if there is one, is asked now and
  /// then from the calling thread; where it says false this throws Marcher::Interrupted, and what was
  /// begun is made anew next time.
  void update(const Scene& scene,
    const std::vector<VolumeTask>& volumes,
    const std::vector<double>& matter,
    double spacing,
    double voxel,
    bool floats,
    int threads,
    LitTask& lit,
    bool ambient,
    const std::function<bool()>& go);

  std::size_t bytes() const;
  void clear();

private:
  struct Frame;
  Frame frame_along(const glm::dvec3& axis, double spacing) const;
  Frame frame_of_box(double spacing) const;
  /// In fog, which sends light from everywhere, of whole boxes.
  void find_corners(const Scene& scene, const std::vector<VolumeTask>& volumes,
    const LitTask& lit,
    bool whole);
  double deepest(const Scene& scene, const std::vector<VolumeTask>& volumes) const;
  void run(SweepTask& task, int threads, const std::function<bool()>& go) const;

  std::vector<LightLattice> Lights;
  LightLattice Ambient;
  std::vector<glm::dvec3> Corners; ///< of what can be seen, in the world
  glm::dmat4 WorldFromIndex{ 1.0 };
};

}
