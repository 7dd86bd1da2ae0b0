#include "painter.h"

#include "command.h"
#include "mesh_scene.h"

#include "Transport/effects.h"
#include "Transport/film.h"

#include "vtkBrumePathTraceMapper.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSmartVolumeMapper.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"
#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"
#include "vtkImageData.h"
#include "vtkPolyData.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace brume::app
{

namespace
{

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What drafts may be off by: what nobody sees of a picture that moves.
constexpr double draft_tolerance = 0.03;
/// Voxels between the nodes of their light volumes.
constexpr double draft_shadow_voxels = 2.0;
/// Where the user says no number, paths go on for as many as a patient one waits for.
constexpr int most_paths = 1 << 20;
constexpr int paths_at_once = 8; ///< of a pixel, from one picture to the next

/// A mapper that draws films of the scene: asked whether to go on, its errors kept.
class FilmMaker
{
public:
  explicit FilmMaker(vtkSmartPointer<vtkBrumeVolumeMapper> mapper)
    : Mapper(std::move(mapper))
  {
    vtkNew<vtkCallbackCommand> observer;
    observer->SetClientData(this);
    observer->SetCallback(
      [](vtkObject* caller, unsigned long event, void* data, void* text)
      {
        auto* self = static_cast<FilmMaker*>(data);
        if (event == vtkCommand::ErrorEvent)
        {
          self->Error = static_cast<const char*>(text);
        }
        else if (self->Go && !(*self->Go)(self->Mapper->GetProgress()))
        {
          self->Stopped = true;
          static_cast<vtkAlgorithm*>(caller)->AbortExecuteOn();
        }
      });
    this->Mapper->AddObserver(vtkCommand::ProgressEvent, observer);
    this->Mapper->AddObserver(vtkCommand::ErrorEvent, observer);
  }

  /// False where `go` ended it. Throws Failure for what cannot be drawn.
  bool draw(const VolumeScene& scene, Film& film, const KeepGoing& go)
  {
    this->Stopped = false;
    this->Error.clear();
    this->Go = &go;
    this->Mapper->SetAbortExecute(0);
    const bool done = this->Mapper->RenderFilm(scene.volume, scene.camera, scene.lights, film);
    this->Go = nullptr;
    if (!done && !this->Stopped)
    {
      throw Failure(scene.options.input, "it cannot be drawn", words_of_vtk(this->Error));
    }
    return done;
  }

  vtkBrumeVolumeMapper* mapper() const { return this->Mapper; }

private:
  vtkSmartPointer<vtkBrumeVolumeMapper> Mapper;
  const KeepGoing* Go = nullptr;
  bool Stopped = false;
  std::string Error;
};

/// The effects of a mapper's statistics, with what each costs of the seconds that it took: their
/// shares are those of `brume plan` (effect_cost).
std::vector<ShownEffect> effects_of(const nlohmann::json& statistics, double seconds)
{
  std::vector<ShownEffect> effects;
  const auto cost_of = [](const std::string& name)
  {
    for (int i = 0; i < effect_count; ++i)
    {
      if (name == effect_name(static_cast<Effect>(i)))
      {
        return effect_cost(static_cast<Effect>(i));
      }
    }
    return std::numeric_limits<double>::quiet_NaN();
  };
  double whole = 0.0;
  for (const auto& entry : statistics.value("effects", nlohmann::json::array()))
  {
    ShownEffect effect;
    effect.name = entry.value("name", "");
    effect.on = entry.value("on", false);
    effect.forced = entry.value("forced", false);
    effect.reason = entry.value("reason", "");
    const auto bound = entry.find("error_bound");
    effect.error_bound = bound != entry.end() && bound->is_number()
                           ? bound->get<double>()
                           : std::numeric_limits<double>::quiet_NaN();
    effect.milliseconds = cost_of(effect.name);
    whole += effect.on && effect.milliseconds > 0.0 ? effect.milliseconds : 0.0;
    effects.push_back(std::move(effect));
  }
  for (ShownEffect& effect : effects)
  {
    effect.milliseconds *= whole > 0.0 ? 1e3 * seconds / whole : 0.0;
  }
  return effects;
}

/// Drafts and first whole pictures are ray marches. The path tracer then adds paths until the
/// tolerance is met; the smart mapper makes the picture that it promises.
class OwnPainter : public Painter
{
public:
  explicit OwnPainter(MapperKind kind)
    : Kind(kind)
    , Drafts(vtkSmartPointer<vtkBrumeRayMarchMapper>::New())
    , March(vtkSmartPointer<vtkBrumeRayMarchMapper>::New())
  {
    if (kind == MapperKind::PathTrace)
    {
      this->Best = std::make_unique<FilmMaker>(vtkSmartPointer<vtkBrumePathTraceMapper>::New());
    }
    else if (kind == MapperKind::Smart)
    {
      this->Best = std::make_unique<FilmMaker>(vtkSmartPointer<vtkBrumeSmartVolumeMapper>::New());
    }
  }

  void set_scene(const VolumeScene& scene) override;
  bool draft(int width, int height, double seconds, const KeepGoing& go) override;
  bool refine(int width, int height, const KeepGoing& go) override;
  bool finished() const override { return this->Finished; }
  const Shot& shot() const override { return this->Shown; }

private:
  /// Draws with one of the mappers; false where it was ended.
  bool draw(FilmMaker& maker, int width, int height, bool draft, const KeepGoing& go);
  /// Paths are added to those there are, a few at first and then as many again.
  bool add_paths(int width, int height, const KeepGoing& go);

  MapperKind Kind;
  VolumeScene Scene; ///< with a volume of its own
  FilmMaker Drafts;
  FilmMaker March;
  std::unique_ptr<FilmMaker> Best; ///< what comes after the march; null for nothing
  std::unique_ptr<MeshStage> Meshes;
  Shot Shown;
  bool Finished = false;
  bool Marched = false; ///< a whole picture by the march is there
  int Paths = 0;        ///< of each pixel of the picture that is there
  double SecondsOfPaths = 0.0;
  double SecondsPerPixel = 0.0; ///< of the last draft; 0 before
  int Divisor = 4;              ///< pixels of a draft's edge; the first is there soon
  nlohmann::json Statistics;    ///< of the last picture
};

bool OwnPainter::draw(FilmMaker& maker, int width, int height, bool draft, const KeepGoing& go)
{
  const auto start = Clock::now();
  VolumeScene& scene = this->Scene;
  scene.options.resolution = { width, height };
  scene.volume->SetMapper(maker.mapper());
  fit_clipping_range(scene);
  SurfacePicture surfaces;
  if (!scene.meshes.empty())
  {
    if (!this->Meshes)
    {
      this->Meshes = std::make_unique<MeshStage>();
    }
    surfaces = this->Meshes->draw(scene, draft);
  }
  maker.mapper()->SetSurfaceDepth(surfaces.depth);
  const auto kept = std::make_shared<Film>(width, height);
  Film& film = *kept;
  if (!maker.draw(scene, film, go))
  {
    return false;
  }
  const nlohmann::json statistics = nlohmann::json::parse(maker.mapper()->GetStatistics());
  this->Shown.picture = { width, height, over_scene(film, scene, surfaces) };
  this->Shown.film = kept;
  this->Shown.seconds = seconds_since(start);
  this->Shown.effects = effects_of(statistics, this->Shown.seconds);
  this->Shown.failure.clear();
  const auto error = statistics.find("estimated_error");
  this->Shown.error.reset();
  if (error != statistics.end() && error->is_number())
  {
    this->Shown.error = error->get<double>();
  }
  this->Statistics = statistics;
  return true;
}
bool OwnPainter::add_paths(int width, int height, const KeepGoing& go)
{
  auto* paths = static_cast<vtkBrumePathTraceMapper*>(this->Best->mapper());
  const Shot before = this->Shown;
  if (!this->draw(*this->Best, width, height, false, go))
  {
    this->Shown = before;
    return false;
  }
  this->SecondsOfPaths += this->Shown.seconds;
  this->Shown.seconds = this->SecondsOfPaths;
  this->Paths = paths->GetRenderedSamplesPerPixel();
  this->Shown.state = std::to_string(this->Paths) + " paths a pixel";
  this->Finished =
    this->Paths >= paths->GetSamplesPerPixel() || this->Statistics.value("tolerance_met", false);
  return true;
}

void OwnPainter::set_scene(const VolumeScene& scene)
{
  const vtkSmartPointer<vtkVolume> volume =
    this->Scene.volume ? this->Scene.volume : vtkSmartPointer<vtkVolume>::New();
  this->Scene = scene;
  this->Scene.volume = volume;
  volume->SetProperty(scene.volume->GetProperty());
  const auto set_up_march = [&](FilmMaker& maker)
  { set_up(this->Scene, static_cast<vtkBrumeRayMarchMapper*>(maker.mapper())); };
  set_up_march(this->March);
  set_up_march(this->Drafts);
  auto* drafts = static_cast<vtkBrumeRayMarchMapper*>(this->Drafts.mapper());
  drafts->ReusePlanOn();
  if (drafts->GetShadowMethod() != vtkBrumeRayMarchMapper::NoShadows)
  {
    // Made once for a light, and looked up as long as only the camera turns: shadow rays take ten
    // times as long in a thick cloud.
    drafts->SetShadowMethodToVolume();
    drafts->SetShadowSampleDistance(
      std::max(draft_shadow_voxels * scene.voxel_edge, drafts->GetShadowSampleDistance()));
  }
  this->Drafts.mapper()->SetTolerance(std::max(draft_tolerance, scene.options.tolerance));
  if (this->Kind == MapperKind::PathTrace)
  {
    auto* paths = static_cast<vtkBrumePathTraceMapper*>(this->Best->mapper());
    set_up(this->Scene, paths);
    paths->SetSamplesPerPixel(scene.options.paths.samples_per_pixel.value_or(most_paths));
    paths->SetSamplesPerRender(paths_at_once);
  }
  else if (this->Kind == MapperKind::Smart)
  {
    set_up(this->Scene, static_cast<vtkBrumeSmartVolumeMapper*>(this->Best->mapper()));
  }
}

bool OwnPainter::draft(int width, int height, double seconds, const KeepGoing& go)
{
  this->Finished = this->Marched = false;
  this->Paths = 0;
  this->SecondsOfPaths = 0.0;
  if (this->SecondsPerPixel > 0.0)
  {
    // From one divisor to the next only where it pays, so that a still hand sees no flicker.
    const double wanted = std::sqrt(this->SecondsPerPixel * width * height / seconds);
    const int divisor = std::clamp(static_cast<int>(std::ceil(wanted)), 1, 16);
    if (divisor > this->Divisor || wanted < 0.8 * (this->Divisor - 1))
    {
      this->Divisor = divisor;
    }
  }
  const int w = std::max(1, (width + this->Divisor - 1) / this->Divisor);
  const int h = std::max(1, (height + this->Divisor - 1) / this->Divisor);
  if (!this->draw(this->Drafts, w, h, true, go))
  {
    return false;
  }
  const double per_pixel = this->Shown.seconds / (double(w) * h);
  this->SecondsPerPixel =
    this->SecondsPerPixel > 0.0 ? 0.5 * (this->SecondsPerPixel + per_pixel) : per_pixel;
  this->Shown.whole = this->Divisor == 1;
  this->Shown.draft = true;
  this->Shown.state = this->Divisor == 1 ? "draft"
                                         : "draft, a ray for " + std::to_string(this->Divisor) +
                                             " x " + std::to_string(this->Divisor) + " pixels";
  return true;
}

bool OwnPainter::refine(int width, int height, const KeepGoing& go)
{
  if (this->Finished)
  {
    return false;
  }
  if (!this->Marched)
  {
    if (!this->draw(this->March, width, height, false, go))
    {
      return false;
    }
    this->Marched = true;
    this->Finished = this->Best == nullptr;
    this->Shown.whole = true;
    this->Shown.draft = false;
    this->Shown.state = "ray march";
    return true;
  }
  if (this->Kind == MapperKind::PathTrace)
  {
    return this->add_paths(width, height, go);
  }
  if (!this->draw(*this->Best, width, height, false, go))
  {
    return false;
  }
  const auto method = this->Statistics.find("method");
  this->Shown.state = method != this->Statistics.end() && method->is_object()
                        ? "by " + method->value("chosen", std::string("what was chosen"))
                        : "smart";
  this->Finished = true;
  return true;
}

}

std::unique_ptr<Painter> make_own_painter(MapperKind kind)
{
  return std::make_unique<OwnPainter>(kind);
}

}
