// What kernels of lit media need of a scene, prepared, and what of it is kept. Internal to Transport.
#pragma once

#include "Transport/fog.h"
#include "Transport/light_maps.h"
#include "Transport/lit_task.h"
#include "Transport/march_task.h"
#include "Transport/marcher.h"
#include "Transport/scene.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace brume
{

/// Whether a scene needs the kernels of lit media: there is fog, a volume's medium is lit, or a density
/// dims R, G and B differently.
bool needs_lit_kernels(const Scene& scene);

class LitTables
{
public:
  /// Brings everything up to date. `shadow_step` is in the data's units of the first volume, 0 for the
  /// method's default. `go`: see LightMaps::update.
  void update(const Scene& scene,
    const MarchSettings& settings,
    const std::vector<VolumeTask>& volumes,
    int threads,
    const std::function<bool()>& go);

  const LitTask& task() const { return this->Task; }
  std::size_t bytes() const { return this->Maps.bytes(); }
  double shadow_step() const { return this->Task.shadow_step; }
  /// The scene's fog; null for none.
  const FogModel* fog() const { return this->TheFog ? &*this->TheFog : nullptr; }
  /// A bound of the radiance that a place of the scene can send.
  double brightest() const { return this->Brightest; }

private:
  void fill_volume(const Scene& scene, std::size_t k, LitVolume& lit);
  void fill_frame(const Scene& scene, std::size_t k, LitFrame& frame) const;
  void fill_light(const Scene& scene, const Light& light, LitLight& lit) const;
  void fill_fog(const Scene& scene);
  void find_channels(const Scene& scene);
  void find_deep_enough(const Scene& scene);
  double brightest_fog(const Scene& scene) const;
  double largest_phase_toward_camera(
    const Scene& scene, const Light& light, const PhaseModel& phase) const;
  double find_brightest(const Scene& scene, const std::vector<VolumeTask>& volumes) const;

  struct Glow
  {
    double hottest = 0.0;
    double reference = 0.0;
    double largest = 0.0; ///< value of the temperatures
    const void* voxels = nullptr;
    std::uint64_t data_revision = 0;
    std::uint64_t medium_revision = 0;
    BlackBodyTable table;
  };
  LitTask Task;
  LightMaps Maps;
  std::optional<FogModel> TheFog;
  std::vector<std::unique_ptr<Glow>> Glows;
  double Brightest = 1.0;
};

}
