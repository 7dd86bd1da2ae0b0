// Drawing, timing and measuring the mappers of a comparison.
#pragma once

#include "mapper_names.h"
#include "mesh_scene.h"
#include "volume_scene.h"

#include "Analysis/comparison.h"
#include "Analysis/image_errors.h"
#include "Transport/film.h"

#include "vtkNew.h"

#include <map>
#include <string>
#include <vector>

class vtkBrumeRayMarchMapper;
class vtkVolume;

namespace brume::app
{

class ProgressBar;

/// Measures mappers on one scene at one fixed step against one truth. Where the scene has what VTK's
/// own mappers do not know (stock_scene.h), they draw what of it they do.
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
  /// Where the ray march's error comes from: from the step, of what only absorbs and emits, or from
  /// the shadows, of what is lit.
  void find_causes(ComparisonEntry& entry);
  /// The film that the ray march makes with the mapper's present settings.
  Film march();
  Film march(int width, int height);
  struct TrueFilm;
  /// The truth of the scene as this mapper has it, in double precision.
  TrueFilm true_film(vtkBrumeRayMarchMapper* mapper, vtkVolume* volume, const char* task);
  /// The truth of lit media: the ray march with shadow rays, its steps halved until the picture stands
  /// still, and checked by double precision at some pixels.
  Truth truth_by_march();
  /// Sets the mapper to simulate all of the scene, with shadows by rays of these steps; and back to
  /// what the user asked for.
  ///@{
  void simulate_all(double step, double shadow_step);
  void simulate_as_asked();
  ///@}
  /// How far march and double precision are apart at check_pixels × check_pixels pixels.
  ImageErrors check_march();
  /// The picture, as VTK's own mappers know the scene, of a fixed step in double precision, samples
  /// placed as told.
  Picture fixed_step(int placement, double leave_below);
  Picture over(const Film& film) const;
  /// Whether the scene only absorbs and emits, as VTK's own mappers have it.
  bool plain() const;

  const VolumeScene& Scene;
  VolumeScene Stock;                ///< what of the scene VTK's own mappers know
  std::vector<std::string> LeftOut; ///< what they do not
  SurfacePicture Surfaces;
  double Step;
  int Repetitions;
  vtkNew<vtkBrumeRayMarchMapper> Mapper;
  ProgressBar* Bar = nullptr; ///< of the march that goes on
  vtkNew<vtkBrumeRayMarchMapper> StockMapper; ///< for the truth of what VTK's own mappers know
  Picture TruePicture;
  Picture StockTruth; ///< of what VTK's own mappers know
  std::map<std::string, Film> Films;
  int Threads = 0;
  std::string Simd;
};

}
