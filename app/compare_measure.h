// Drawing, timing and measuring the mappers of a comparison.
#pragma once

#include "compare_paths.h"
#include "mapper_names.h"
#include "scene_march.h"

#include "Analysis/comparison.h"
#include "Analysis/image_errors.h"
#include "Transport/film.h"

#include "vtkNew.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

class vtkBrumeRayMarchMapper;

namespace brume::app
{

/// Measures mappers on one scene at one fixed step against one truth. Where the scene has what VTK's
/// own mappers do not know (stock_scene.h), they draw what of it they do.
class ComparisonMeasure
{
public:
  /// `step` in world units, `repetitions` timed renders of each mapper. `paths`: the path tracer takes
  /// part, and is then the truth of what scatters light. The scene must outlive it.
  ComparisonMeasure(const VolumeScene& scene, double step, int repetitions, bool paths = false);
  ~ComparisonMeasure();

  /// Computes the truth. To be called first.
  Truth measure_truth();

  /// Draws, times and measures a mapper. Its film is kept in films().
  ComparisonEntry measure(const MapperName& mapper);

  /// What each measured mapper drew, by the mapper's name.
  const std::map<std::string, Film>& films() const { return this->Films; }

  /// From the last measured ray march: threads and instruction set.
  int threads() const { return this->Threads; }
  const std::string& simd() const { return this->Simd; }

private:
  Truth truth_by_paths();
  void measure_ray_march(ComparisonEntry& entry);
  void measure_paths(ComparisonEntry& entry);
  void measure_stock(ComparisonEntry& entry, MapperKind kind);
  /// Where the ray march's error comes from: from the step, of what only absorbs and emits, or from
  /// the shadows, of what is lit.
  void find_causes(ComparisonEntry& entry);
  /// The picture, as VTK's own mappers know the scene, of a fixed step in double precision, samples
  /// placed as told.
  Picture fixed_step(int placement, double leave_below);
  Picture over_stock(const Film& film) const;
  /// Whether the scene only absorbs and emits, as VTK's own mappers have it.
  bool plain() const;

  const VolumeScene& Scene;
  VolumeScene Stock;                ///< what of the scene VTK's own mappers know
  std::vector<std::string> LeftOut; ///< what they do not
  SceneMarch March;
  std::unique_ptr<ComparePaths> Paths; ///< null: they take no part
  SurfacePicture StockSurfaces; ///< in the light that VTK's own mappers know
  double Step;
  int Repetitions;
  vtkNew<vtkBrumeRayMarchMapper> StockMapper; ///< for the truth of what VTK's own mappers know
  Picture TruePicture;
  Picture StockTruth; ///< of what VTK's own mappers know
  std::map<std::string, Film> Films;
  int Threads = 0;
  std::string Simd;
};

}
