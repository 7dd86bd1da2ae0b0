// What path tracing asks of a volume. Internal to Transport.
#pragma once

#include "Transport/path_bricks.h"
#include "Transport/phase_sampler.h"
#include "Transport/random_stream.h"
#include "Transport/reference_medium.h"
#include "Transport/scene.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace brume
{

/// A ray as one volume has it: places begin + t · along in index space, t in world units.
struct MatterRay
{
  glm::dvec3 begin{ 0.0 };
  glm::dvec3 along{ 0.0 };
  double scale = 0.0; ///< of the data's units in one of the world's
  double from = 0.0;  ///< inside the volume's box from here
  double to = 0.0;    ///< to here; not above `from`: never
};

/// Matter that light collides with: a volume, or the components of one grid. Its extinction is
/// density(place) · channels(). Collisions of several of them in one place are apart from one
/// another, so that each is tracked by itself.
class PathMatter
{
public:
  /// Keeps references to all. `numbers`: the volumes that it is made of.
  PathMatter(const Scene& scene,
    const std::vector<ReferenceMedium>& media,
    const std::vector<int>& numbers);
  virtual ~PathMatter() = default;

  MatterRay ray(const glm::dvec3& world_begin, const glm::dvec3& world_direction) const;

  /// Density at a place of index space, per unit of the data's length, within the bounds of
  /// bricks(). Its expectation over `random` is the interpolated one: a matter may draw one of the
  /// voxels around with the weight that interpolation gives it.
  virtual double density(const glm::dvec3& place, RandomStream& random) const;
  /// The interpolated one itself.
  double interpolated_density(const glm::dvec3& place) const;
  /// Whether density() is the extinction of one voxel: read_voxels() gives them by themselves.
  virtual bool has_voxels() const { return false; }
  /// The values of voxels at whole places, one after another, where their bit is set; only where
  /// has_voxels().
  virtual void read_voxels(const std::int32_t* x,
    const std::int32_t* y,
    const std::int32_t* z,
    const std::uint8_t* bits,
    int count,
    float* values) const;
  /// σs / σt at a place.
  virtual glm::dvec3 albedo(const glm::dvec3& place) const;
  /// Radiance sent per unit of the data's length.
  virtual glm::dvec3 emission(const glm::dvec3& place) const;

  const Volume& volume() const { return this->Media.front()->volume(); }
  const PathBricks& bricks() const { return this->Bricks; }
  const glm::dvec3& channels() const { return this->Channels; }
  bool emits() const { return this->Emits; }
  bool scatters() const { return this->Scatters; }
  const PhaseSampler& phase() const { return this->Phase; }

  const glm::dmat4& index_from_world() const { return this->IndexFromWorld; }
  const glm::dmat3& data_from_index() const { return this->DataFromIndex; }
  /// Whether cropping or clipping planes leave some of it out.
  bool is_cut() const { return this->Cut; }

protected:
  const ReferenceMedium& medium() const { return *this->Media.front(); }
  /// Whether cropping and clipping planes leave a place.
  bool is_drawn(const glm::dvec3& place) const;

private:
  void find_bricks();

  const Scene& TheScene;
  std::vector<const ReferenceMedium*> Media;
  std::vector<std::unique_ptr<ReferenceGrid>> Temperatures;
  PathBricks Bricks;
  PhaseSampler Phase;
  glm::dvec3 Channels{ 1.0 };
  bool Emits = false;
  bool Scatters = false;
  bool Cut = false;
  std::vector<glm::dvec4> Planes; ///< clipping planes in index space
  glm::dmat4 IndexFromWorld{ 1.0 };
  glm::dmat3 DataFromIndex{ 1.0 };
};

/// The matter of a scene's volumes: one for each, or one for all components of an unlit grid that
/// are mixed as Mixture::Components.
std::vector<std::unique_ptr<PathMatter>> find_path_matter(const Scene& scene,
  const std::vector<ReferenceMedium>& media);

}
