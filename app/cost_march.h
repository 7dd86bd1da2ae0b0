// The ray march as a study turns its knobs.
#pragma once

#include "cost_setting.h"

#include "Transport/marcher.h"

#include "vtkBrumeRayMarchMapper.h"

#include <memory>
#include <optional>

namespace brume::app
{

/// Where the knobs of the ray march stand. Lengths in edges of a voxel.
struct MarchChoice
{
  /// Steps and shadows are chosen by the tolerance in place of `step`, `shadows`, `shadow_step`.
  bool automatic = false;
  double tolerance = 0.004;
  double step = 0.5;
  StepRule rule = StepRule::Midpoint;
  int shadows = vtkBrumeRayMarchMapper::VolumeShadows;
  double shadow_step = 1.0; ///< 0: exact, where rays can be
  int octaves = 1;
  bool ambient = true;
  int environment_lights = 16;
};

/// Draws one scene with the knobs where they are told to be.
class CostMarch
{
public:
  /// The scene must outlive it.
  explicit CostMarch(const VolumeScene& scene);
  ~CostMarch();

  /// Where the knobs stand that are not turned: steps of half a voxel and shadows by a volume of one, or
  /// what the user asked for.
  const MarchChoice& standard() const { return this->Standard; }

  /// A render. Throws as CostSetting::draw does.
  CostRender draw(const MarchChoice& choice, const Watch& watch);

  /// All that is set, as JSON.
  std::string settings(const MarchChoice& choice) const;

  SceneMarch& march() { return this->March; }
  const VolumeScene& scene() const { return this->March.scene(); }
  /// Whether the scene can be marched by a rule.
  bool follows(StepRule rule);
  /// Threads and instruction set of the last render.
  int threads() const { return this->Threads; }
  const std::string& simd() const { return this->Simd; }

private:
  void set(const MarchChoice& choice);
  CostRender draw_by_rule(const MarchChoice& choice, const Watch& watch);

  SceneMarch March;
  MarchChoice Standard;
  Marcher OfRules;
  int Threads = 0;
  std::string Simd;
};

}
