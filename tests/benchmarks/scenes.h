// The scenes of the benchmarks, each with its truth, and the two renderers that are timed on them.
#pragma once

#include "stock_renderer.h"
#include "volume_scene.h"

#include "Analysis/image_errors.h"
#include "Analysis/picture.h"
#include "Transport/film.h"

#include "vtkBrumeRayMarchMapper.h"

#include "vtkNew.h"

#include <nlohmann/json.hpp>

#include <map>
#include <memory>
#include <string>

namespace benchmarks
{

/// What all rows share.
struct Options
{
  bool quick = false; ///< small volumes and pictures, everything once: does it run at all
  int threads = 2;
  int resolution = 512; ///< pixels along each side
  int repetitions = 5;
  std::string brain;      ///< the scan's file; empty where there is none
  std::string no_display; ///< why there is no display; empty where there is one
};

/// A scene, its truth made when it is first asked for.
class Scene
{
public:
  explicit Scene(brume::app::VolumeScene scene)
    : Volume(std::move(scene))
  {
  }
  const brume::app::VolumeScene& volume() const { return this->Volume; }
  /// render_reference's picture over black.
  const brume::Picture& truth();
  /// Of the truth's picture.
  double truth_seconds() const { return this->TruthSeconds; }

private:
  brume::app::VolumeScene Volume;
  brume::Picture Truth;
  double TruthSeconds = 0.0;
};

/// Brume on a scene.
class Subject
{
public:
  /// A fixed step, in world units, or 0 for the mapper's own by its tolerance.
  Subject(const Scene& scene, double step, int threads);
  vtkBrumeRayMarchMapper* mapper() { return this->Mapper; }
  /// Renders once; seconds of the march alone, from the mapper's statistics.
  double render();
  double prepare_seconds() const { return this->Statistics["seconds_prepare"]; }
  const nlohmann::json& statistics() const { return this->Statistics; }
  brume::Picture picture() const;

private:
  const Scene& TheScene;
  vtkNew<vtkBrumeRayMarchMapper> Mapper;
  brume::Film Film;
  nlohmann::json Statistics;
};

/// The volumes, each made when it is first asked for and kept.
class Scenes
{
public:
  explicit Scenes(const Options& options)
    : Settings(options)
  {
  }
  const Options& options() const { return this->Settings; }
  /// The translucent ball with bumps, 256³ uint16 (tests/support/bumpy_ball.h).
  Scene& ball(bool shaded);
  /// A file or sample as `brume compare` draws it, its preset picked from the data.
  Scene& input(const std::string& spec, bool shaded);
  /// The scene of an image of bumpy balls, not kept.
  std::unique_ptr<Scene> of_balls(vtkImageData* image,
    double largest,
    double edge,
    const char* name) const;

private:
  Options Settings;
  std::map<std::string, std::unique_ptr<Scene>> Kept;
};

/// "mean 0.12, 99.9 % 1.1, largest 4.0" in 1/255 of white.
std::string in_words(const brume::ImageErrors& errors);
/// Mean, 99.9th percentile and largest are all no larger.
bool no_larger(const brume::ImageErrors& a, const brume::ImageErrors& b);

}
