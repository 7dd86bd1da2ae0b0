// Drawing, timing and measuring the mappers of a comparison.
#pragma once

#include "mapper_names.h"
#include "volume_scene.h"

#include "Analysis/comparison.h"
#include "Transport/film.h"

#include "vtkNew.h"

#include <map>
#include <string>

class vtkBrumeRayMarchMapper;

namespace brume::app
{

/// Measures mappers on one scene at one fixed step against one truth.
class ComparisonMeasure
{
public:
  /// `step` in world units, `repetitions` timed renders of each mapper. The scene must outlive it.
  ComparisonMeasure(const VolumeScene& scene, double step, int repetitions);
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
  void measure_ray_march(ComparisonEntry& entry);
  void measure_stock(ComparisonEntry& entry, MapperKind kind);
  /// The picture of a fixed step in double precision, samples placed as told.
  Picture fixed_step(int placement, double leave_below);
  Picture over(const Film& film) const;

  const VolumeScene& Scene;
  double Step;
  int Repetitions;
  vtkNew<vtkBrumeRayMarchMapper> Mapper;
  Picture TruePicture;
  std::map<std::string, Film> Films;
  int Threads = 0;
  std::string Simd;
};

}
