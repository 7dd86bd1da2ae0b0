// The knobs of a study, and where each is turned to.
#pragma once

#include "cost_march.h"
#include "cost_paths.h"
#include "cost_setting.h"
#include "cost_smart.h"
#include "cost_voxels.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace brume::app
{

class PrivateDisplay;

/// The names of all knobs, in the order in which they are shown.
const std::vector<std::string>& knob_names();

/// What the settings of a study are drawn with.
class CostScene
{
public:
  /// The scene must outlive it.
  explicit CostScene(const VolumeScene& scene);
  ~CostScene();

  const VolumeScene& scene() const { return this->Scene; }
  CostMarch& march() { return this->March; }
  CostPaths& paths();
  CostSmart& smart();
  /// Whether the truth holds all scatterings.
  bool TruthByPaths = false;
  /// Mappers by name that are asked for; empty: all.
  std::vector<std::string> Mappers;

  bool wants(const std::string& mapper) const;
  /// The same scene, its pictures smaller.
  CostMarch& smaller(int divisor);
  /// The same scene, its voxels stored differently; null, with the reason, where that cannot be.
  CostMarch* stored(VoxelStore store, std::string& reason);
  /// The same scene as VTK's own mappers know it, and its surfaces in the light that they know.
  const VolumeScene& stock();
  const SurfacePicture& stock_surfaces();
  /// Made at the first call; may be unavailable.
  const PrivateDisplay& display();

private:
  struct Variant;

  const VolumeScene& Scene;
  CostMarch March;
  std::unique_ptr<CostPaths> Paths;
  std::unique_ptr<CostSmart> Smart;
  std::vector<std::unique_ptr<Variant>> Variants;
  std::unique_ptr<VolumeScene> Stock;
  SurfacePicture StockSurfaces;
  std::unique_ptr<PrivateDisplay> Display;
};

/// The knob of that name with all its settings, or with the reason why it has none. The scene must
/// outlive the settings.
CostKnob make_knob(const std::string& name, CostScene& scene);

/// Several knobs turned at once, from coarse to fine, with this rule of steps and number of octaves.
CostKnob make_combined_knob(CostScene& scene, StepRule rule, int octaves);

}
