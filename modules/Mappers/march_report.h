// What a march tells of itself. Internal to Mappers.
#ifndef march_report_h
#define march_report_h

#include "Transport/effect_plan.h"
#include "Transport/marcher.h"
#include "Transport/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>

namespace brume
{

/// The most memory that the process has held so far.
std::int64_t peak_memory_bytes();

/// The effects that a picture was made with and without, as a JSON list of
/// {name, on, reason, error_bound, forced}: those of the plan, then what has no place in a plan.
nlohmann::json effects_of(const Scene& scene,
  const MarchSettings& settings,
  const MarchStatistics& march,
  const EffectPlan& plan,
  bool window_level);

/// What statistics tell of any march: seconds, samples, step, shadows, effects, voxels, … docs/user/statistics.md
/// has them. `scene` is what was marched.
nlohmann::json statistics_of(const Scene& scene,
  const MarchSettings& settings,
  const MarchStatistics& march,
  const EffectPlan& plan,
  bool window_level);

/// Whether nothing but physics had a part in the picture of a scene (as it was marched).
bool is_radiometric(const Scene& scene, bool window_level);

/// The scene's blend mode as the command line calls it.
const char* blend_mode_name(BlendMode mode);

}

#endif
