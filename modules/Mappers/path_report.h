// What path tracing simulates of a scene, for statistics. Internal to Mappers.
#ifndef path_report_h
#define path_report_h

#include "Transport/effect_plan.h"
#include "Transport/path_tracer.h"
#include "Transport/scene.h"

#include <nlohmann/json_fwd.hpp>

namespace brume
{

/// Which effects paths of up to `most_scatterings` (0: any number) simulate, and why. `environment`: with
/// an environment map beside the scene's lights.
EffectPlan plan_of_paths(const Scene& scene, int most_scatterings, bool environment);

/// The plan's effects, as statistics list them.
nlohmann::json effects_of(const EffectPlan& plan);

/// What statistics tell of any picture by paths; docs/user/statistics.md has the keys.
nlohmann::json statistics_of(const Scene& scene,
  const PathSettings& settings,
  const PathStatistics& paths,
  const EffectPlan& plan,
  bool window_level);

/// As is_radiometric() (march_report.h): paths draw neither shading of lit media, nor silver lining,
/// nor powder.
bool is_radiometric_as_paths(const Scene& scene, bool window_level);

}

#endif
