#include "compare_measure.h"

#include "command.h"
#include "interruption.h"
#include "progress.h"
#include "stock_renderer.h"
#include "stock_scene.h"

#include "Transport/reference.h"

#include "vtkBrumeEffectPlan.h"
#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <sstream>
#include <vector>

namespace brume::app
{

namespace
{

/// The truth of lit media: steps are halved until the picture changes by no more than this (largest and
/// mean of a third of the change), at most so often, and no shorter than a part of a voxel's edge.
constexpr double settled_largest = 1e-3;
constexpr double settled_mean = 5e-5;
constexpr int most_halvings = 5;
constexpr double shortest_step = 1.0 / 16.0;
constexpr int check_pixels = 8; ///< along each side
constexpr double check_tolerance = 1e-3;

/// Where VTK's CPU mapper leaves a ray: 255 of 32767 of its fixed-point opacity.
constexpr double fixed_point_leaves_below = 255.0 / 32767.0;

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

std::string two_digits(double value)
{
  std::ostringstream out;
  out << std::setprecision(2) << value;
  return out.str();
}

/// Runs render() once to warm up and `repetitions` times for the clock.
template <class Render>
Timing time_renders(int repetitions, const Render& render)
{
  Timing timing;
  timing.repetitions = repetitions;
  timing.warm_up = render();
  std::vector<double> seconds;
  for (int i = 0; i < repetitions; ++i)
  {
    InterruptionWatch::check("compare");
    seconds.push_back(render());
  }
  timing.median = median(seconds);
  timing.min = *std::min_element(seconds.begin(), seconds.end());
  timing.max = *std::max_element(seconds.begin(), seconds.end());
  return timing;
}

/// The picture in the 256 levels of a frame buffer.
Picture in_8_bits(const Picture& picture)
{
  const Bitmap bitmap = to_bitmap(picture);
  Picture result{ picture.width, picture.height, {} };
  for (unsigned char byte : bitmap.rgb)
  {
    result.rgb.push_back(byte / 255.0f);
  }
  return result;
}

}

struct ComparisonMeasure::TrueFilm
{
  Film film;
  ReferenceStatistics statistics;
  double tolerance;
  int refinement_levels = 0;
};

ComparisonMeasure::ComparisonMeasure(const VolumeScene& scene, double step, int repetitions)
  : Scene(scene)
  , LeftOut(left_out_by_stock(scene.options))
  , Step(step)
  , Repetitions(repetitions)
{
  if (not_drawn_by_stock(scene.options, scene.input).empty())
  {
    this->Stock = stock_scene(scene);
    set_up(this->Stock, this->StockMapper);
  }
  set_up(scene, this->Mapper);
  this->Mapper->AutoAdjustSampleDistancesOff();
  this->Mapper->SetSampleDistance(step);
  this->Surfaces = draw_meshes(scene);
  this->Mapper->SetSurfaceDepth(this->Surfaces.depth);
  this->StockMapper->SetSurfaceDepth(this->Surfaces.depth);
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(this);
  observer->SetCallback(
    [](vtkObject* caller, unsigned long, void* self, void*)
    {
      if (ProgressBar* bar = static_cast<ComparisonMeasure*>(self)->Bar)
      {
        bar->update(static_cast<vtkAlgorithm*>(caller)->GetProgress());
      }
      if (InterruptionWatch::requested())
      {
        static_cast<vtkAlgorithm*>(caller)->AbortExecuteOn();
      }
    });
  this->Mapper->AddObserver(vtkCommand::ProgressEvent, observer);
}

bool ComparisonMeasure::plain() const
{
  return this->LeftOut.empty() && !this->Scene.medium;
}

ComparisonMeasure::~ComparisonMeasure()
{
  this->Scene.volume->SetMapper(nullptr);
  if (this->Stock.volume)
  {
    this->Stock.volume->SetMapper(nullptr);
  }
}

Picture ComparisonMeasure::over(const Film& film) const
{
  return { film.width, film.height,
    over_scene(film, this->Scene, this->Surfaces) };
}

ComparisonMeasure::TrueFilm ComparisonMeasure::true_film(
  vtkBrumeRayMarchMapper* mapper, vtkVolume* volume, const char* task)
{
  const brume::Scene* scene = mapper->UpdateScene(
    volume, this->Scene.camera, this->Scene.lights, this->Scene.width(), this->Scene.height());
  if (!scene)
  {
    throw Failure(this->Scene.options.input, "it cannot be drawn", "see brume info");
  }
  ReferenceSettings settings;
  settings.threads = this->Scene.options.threads;
  TrueFilm truth{ Film(this->Scene.width(), this->Scene.height()), {}, settings.tolerance };
  for (int pieces = 1; pieces < settings.most_pieces; pieces *= 2)
  {
    ++truth.refinement_levels;
  }
  ProgressBar bar(task, !this->Scene.options.quiet);
  truth.statistics = render_reference(*scene, settings, truth.film,
    [&](double done)
    {
      bar.update(done);
      return !InterruptionWatch::requested();
    });
  bar.clear();
  InterruptionWatch::check("compare");
  return truth;
}

Truth ComparisonMeasure::measure_truth()
{
  if (!this->plain())
  {
    return this->truth_by_march();
  }
  const TrueFilm found = this->true_film(this->Mapper, this->Scene.volume, "computing the truth");
  Truth truth;
  truth.method =
    "Brume's integrator in double precision: each stretch of a ray inside one voxel cell is cut into "
    "1, 2, 4, … pieces until the pixel changes by no more than " +
    nlohmann::json(found.tolerance).dump() +
    " of white. About a third of the last change remains as its error.";
  truth.refinement_levels = found.refinement_levels;
  truth.remaining_mean = found.statistics.mean_change / 3.0;
  truth.remaining_largest = found.statistics.largest_change / 3.0;
  truth.seconds = found.statistics.seconds;
  truth.picture = this->over(found.film);
  this->TruePicture = this->StockTruth = truth.picture;
  return truth;
}

ImageErrors ComparisonMeasure::check_march()
{
  this->Mapper->SetSurfaceDepth({});
  const Film film = this->march(check_pixels, check_pixels);
  const brume::Scene* scene = this->Mapper->UpdateScene(this->Scene.volume, this->Scene.camera,
    this->Scene.lights, check_pixels, check_pixels);
  ReferenceSettings settings;
  settings.threads = this->Scene.options.threads;
  settings.tolerance = check_tolerance;
  Film reference(check_pixels, check_pixels);
  ProgressBar bar("checking the truth", !this->Scene.options.quiet);
  render_reference(*scene, settings, reference,
    [&](double done)
    {
      bar.update(done);
      return !InterruptionWatch::requested();
    });
  bar.clear();
  InterruptionWatch::check("compare");
  this->Mapper->SetSurfaceDepth(this->Surfaces.depth);
  const double black[3] = { 0.0, 0.0, 0.0 };
  const auto picture = [&](const Film& light)
  { return Picture{ check_pixels, check_pixels, over_background(light, black) }; };
  return brume::measure(picture(film), picture(reference));
}

void ComparisonMeasure::simulate_all(double step, double shadow_step)
{
  this->Mapper->SetTolerance(0.0);
  this->Mapper->GetEffectPlan()->ForceNothing();
  this->Mapper->SetShadowMethod(vtkBrumeRayMarchMapper::RayShadows);
  this->Mapper->SetShadowSampleDistance(shadow_step);
  this->Mapper->SetSampleDistance(step);
}

void ComparisonMeasure::simulate_as_asked()
{
  this->Mapper->SetTolerance(this->Scene.options.tolerance);
  apply(this->Scene.options.medium, this->Mapper);
  this->Mapper->SetSampleDistance(this->Step);
}

Truth ComparisonMeasure::truth_by_march()
{
  const auto start = std::chrono::steady_clock::now();
  // Through one density rays go cell by cell; else their steps get as short as the others.
  const bool by_cells = this->Scene.options.density() && !this->Scene.input.sparse;
  const bool quiet = this->Scene.options.quiet;
  double step = this->Step;
  const auto march_with = [&](int level)
  {
    ProgressBar bar("computing the truth, steps halved " + std::to_string(level) + " times", !quiet);
    this->Bar = &bar;
    this->simulate_all(step, by_cells ? 0.0 : step);
    const Picture picture = this->over(this->march());
    this->Bar = nullptr;
    return picture;
  };
  Truth truth;
  truth.picture = march_with(0);
  for (;;)
  {
    step *= 0.5;
    const Picture finer = march_with(++truth.refinement_levels);
    const ImageErrors change = brume::measure(truth.picture, finer);
    truth.picture = finer;
    truth.remaining_mean = change.mean_absolute / 3.0;
    truth.remaining_largest = change.largest / 3.0;
    if ((truth.remaining_largest <= settled_largest && truth.remaining_mean <= settled_mean) ||
      truth.refinement_levels >= most_halvings || step <= shortest_step * this->Scene.voxel_edge)
    {
      break;
    }
  }
  const ImageErrors check = this->check_march();
  truth.method =
    "Single scattering of every light: Brume's ray march with shadows by rays, its steps halved until "
    "the picture changes by no more than " +
    nlohmann::json(3.0 * settled_largest).dump() +
    " of white, or to 1/16 of a voxel's edge; about a third of the last change remains as its error. "
    "Brume's integrator in double precision, which shares no arithmetic with it, was run for " +
    std::to_string(check_pixels * check_pixels) + " pixels spread over the view: they differ by " +
    two_digits(check.mean_absolute) + " of white in the mean and by " + two_digits(check.largest) +
    " at most.";
  truth.remaining_mean = std::max(truth.remaining_mean, check.mean_absolute);
  truth.remaining_largest = std::max(truth.remaining_largest, check.largest);
  truth.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  this->simulate_as_asked();
  this->TruePicture = truth.picture;
  return truth;
}

Picture ComparisonMeasure::fixed_step(int placement, double leave_below)
{
  const bool plain = this->plain();
  const brume::Scene* scene = (plain ? this->Mapper : this->StockMapper)
                                ->UpdateScene(plain ? this->Scene.volume : this->Stock.volume,
                                  this->Scene.camera, this->Scene.lights, this->Scene.width(),
                                  this->Scene.height());
  Film film(this->Scene.width(), this->Scene.height());
  ProgressBar bar("measuring where the error comes from", !this->Scene.options.quiet);
  render_fixed_step(*scene, this->Step, static_cast<SamplePlacement>(placement), leave_below,
    this->Scene.options.threads, film,
    [&](double done)
    {
      bar.update(done);
      return !InterruptionWatch::requested();
    });
  bar.clear();
  InterruptionWatch::check("compare");
  return this->over(film);
}

ComparisonEntry ComparisonMeasure::measure(const MapperName& mapper)
{
  ComparisonEntry entry;
  entry.mapper = mapper.name;
  entry.title = mapper.title;
  entry.class_name = mapper.class_name;
  if (mapper.kind == MapperKind::RayMarch)
  {
    this->measure_ray_march(entry);
  }
  else
  {
    this->measure_stock(entry, mapper.kind);
  }
  entry.against_truth = brume::measure(entry.picture, this->TruePicture);
  return entry;
}

void ComparisonMeasure::measure_ray_march(ComparisonEntry& entry)
{
  Film film;
  nlohmann::json statistics;
  entry.timing = time_renders(this->Repetitions,
    [&]
    {
      film = this->march();
      const auto now = nlohmann::json::parse(this->Mapper->GetStatistics());
      if (statistics.is_null())
      {
        entry.timing.prepare = now["seconds_prepare"];
        statistics = now;
      }
      return now["seconds"].get<double>();
    });
  entry.timing.prepare = statistics["seconds_prepare"];
  entry.statistics = statistics.dump(2);
  entry.picture = this->over(film);
  this->Threads = statistics["threads"];
  this->Simd = statistics["simd"];
  this->Films["raymarch"] = film;

  this->find_causes(entry);
}

Film ComparisonMeasure::march()
{
  return this->march(this->Scene.width(), this->Scene.height());
}

Film ComparisonMeasure::march(int width, int height)
{
  Film film(width, height);
  if (!this->Mapper->RenderFilm(this->Scene.volume, this->Scene.camera, this->Scene.lights, film))
  {
    InterruptionWatch::check("compare");
    throw Failure(this->Scene.options.input, "it cannot be drawn", "see brume info");
  }
  return film;
}

void ComparisonMeasure::find_causes(ComparisonEntry& entry)
{
  if (this->plain())
  {
    const Picture exact = this->fixed_step(static_cast<int>(SamplePlacement::Middle), 0.0);
    entry.contributions.push_back({ "step",
      "The same step in double precision, a sample in the middle of each, against the truth.",
      brume::measure(exact, this->TruePicture) });
    entry.contributions.push_back({ "single precision, tables, rays left early",
      "The picture against the same step in double precision.",
      brume::measure(entry.picture, exact) });
    return;
  }
  const auto statistics = nlohmann::json::parse(entry.statistics);
  this->Mapper->SetSampleDistance(0.25 * this->Step);
  entry.contributions.push_back({ "step",
    "The picture against the same mapper's with a quarter of the step.",
    brume::measure(entry.picture, this->over(this->march())) });
  this->Mapper->SetSampleDistance(this->Step);
  const std::string method = statistics.value("shadow_method", "none");
  if (method == "volume" || method == "functions")
  {
    this->Mapper->SetShadowMethod(vtkBrumeRayMarchMapper::RayShadows);
    this->Mapper->SetShadowSampleDistance(0.0);
    entry.contributions.push_back({ "shadows",
      "The picture against the same mapper's with shadows by rays, the steps alike.",
      brume::measure(entry.picture, this->over(this->march())) });
    apply(this->Scene.options.medium, this->Mapper);
  }
}

void ComparisonMeasure::measure_stock(ComparisonEntry& entry, MapperKind kind)
{
  entry.left_out = this->LeftOut;
  if (this->StockTruth.rgb.empty())
  {
    this->StockTruth = this->over(
      this->true_film(this->StockMapper, this->Stock.volume, "computing the truth of what VTK knows")
        .film);
  }
  StockRenderer renderer(this->Stock, kind, this->Step);
  entry.timing =
    time_renders(this->Repetitions, [&] { return renderer.render(); });
  entry.timing.prepare = std::max(0.0, entry.timing.warm_up - entry.timing.median);
  const bool fixed = kind == MapperKind::FixedPoint;
  entry.picture = fixed ? this->over(renderer.film()) : renderer.picture();
  const Picture frame = renderer.frame();
  this->Films[entry.mapper] = renderer.film();
  entry.statistics =
    nlohmann::json{ { "mapper", entry.mapper }, { "device", renderer.device() } }.dump(2);

  const Picture middle = this->fixed_step(static_cast<int>(SamplePlacement::Middle), 0.0);
  const Picture placed = this->fixed_step(
    static_cast<int>(fixed ? SamplePlacement::FromNearPlane : SamplePlacement::FromEntry), 0.0);
  if (!this->plain())
  {
    entry.contributions.push_back({ "what it leaves out",
      "The truth of what of the scene VTK's own mappers know against that of the whole scene.",
      brume::measure(this->StockTruth, this->TruePicture) });
  }
  entry.contributions.push_back({ "step",
    this->plain()
      ? "The same step in double precision, a sample in the middle of each, against the truth."
      : "The same step in double precision, a sample in the middle of each, against the truth of what "
        "VTK's own mappers know.",
    brume::measure(middle, this->StockTruth) });
  entry.contributions.push_back({ "ray start",
    fixed ? "Samples at whole steps from the camera's near plane, the last one not cut, against "
            "samples in the middle of steps; both in double precision."
          : "Samples at whole steps from where the ray enters, the last one not cut, against samples "
            "in the middle of steps; both in double precision.",
    brume::measure(placed, middle) });
  const bool shaded = this->Stock.volume->GetProperty()->GetShade() != 0;
  if (fixed)
  {
    const Picture left = this->fixed_step(
      static_cast<int>(SamplePlacement::FromNearPlane), fixed_point_leaves_below);
    entry.contributions.push_back({ "rays left early",
      "Rays ended where less than 255/32767 passes, against rays to the end; both in double "
      "precision.",
      brume::measure(left, placed) });
    entry.contributions.push_back(
      { shaded ? "fixed point, tables, shading at voxels" : "fixed point and tables",
        shaded ? "The picture against its own samples in double precision: 15-bit arithmetic, values "
                 "rounded to table entries, and light computed at voxels for a limited set of "
                 "directions and interpolated."
               : "The picture against its own samples in double precision: 15-bit arithmetic, and "
                 "values rounded to table entries.",
        brume::measure(entry.picture, left) });
    entry.contributions.push_back({ "display (not in the table's figures)",
      "The window's frame against the mapper's own image: the quad that shows it resamples by up to "
      "half a pixel, and the frame has 8 bits.",
      brume::measure(frame, entry.picture) });
    return;
  }
  entry.contributions.push_back({ "8-bit frame", "The truth rounded to 8 bits against the truth.",
    brume::measure(in_8_bits(this->StockTruth), this->StockTruth) });
  entry.contributions.push_back({ "textures, tables and the frame's 8 bits",
    "The picture against its own samples in double precision.",
    brume::measure(entry.picture, placed) });
}

}
