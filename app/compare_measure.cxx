#include "compare_measure.h"

#include "command.h"
#include "interruption.h"
#include "progress.h"
#include "stock_renderer.h"

#include "Analysis/image_errors.h"
#include "Transport/reference.h"

#include "vtkBrumeRayMarchMapper.h"

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
#include <vector>

namespace brume::app
{

namespace
{

/// Where VTK's CPU mapper leaves a ray: 255 of 32767 of its fixed-point opacity.
constexpr double fixed_point_leaves_below = 255.0 / 32767.0;

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
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

ComparisonMeasure::ComparisonMeasure(const VolumeScene& scene, double step, int repetitions)
  : Scene(scene)
  , Step(step)
  , Repetitions(repetitions)
{
  this->Mapper->SetInputDataObject(scene.input.data());
  this->Mapper->SetTolerance(scene.options.tolerance);
  this->Mapper->SetNumberOfThreads(scene.options.threads);
  this->Mapper->AutoAdjustSampleDistancesOff();
  this->Mapper->SetSampleDistance(step);
  apply(scene.options.modes, this->Mapper, scene.volume->GetProperty());
  this->Mapper->SetMaskInput(scene.mask);
  this->Mapper->SetMaskTypeToBinary();
  vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback(
    [](vtkObject* caller, unsigned long, void*, void*)
    {
      if (InterruptionWatch::requested())
      {
        static_cast<vtkAlgorithm*>(caller)->AbortExecuteOn();
      }
    });
  this->Mapper->AddObserver(vtkCommand::ProgressEvent, observer);
  scene.volume->SetMapper(this->Mapper);
  vtkBrumeVolumeMapper::ResetClippingRange(scene.volume, scene.camera);
}

ComparisonMeasure::~ComparisonMeasure()
{
  this->Scene.volume->SetMapper(nullptr);
}

Picture ComparisonMeasure::over(const Film& film) const
{
  return { film.width, film.height,
    over_background(film, this->Scene.options.background.data()) };
}

Truth ComparisonMeasure::measure_truth()
{
  const brume::Scene* scene = this->Mapper->UpdateScene(this->Scene.volume, this->Scene.camera,
    this->Scene.lights, this->Scene.width(), this->Scene.height());
  if (!scene)
  {
    throw Failure(this->Scene.options.input, "it cannot be drawn", "see brume info");
  }
  Film film(this->Scene.width(), this->Scene.height());
  ReferenceSettings settings;
  settings.threads = this->Scene.options.threads;
  ProgressBar bar("computing the truth", !this->Scene.options.quiet);
  const ReferenceStatistics reference = render_reference(*scene, settings, film,
    [&](double done)
    {
      bar.update(done);
      return !InterruptionWatch::requested();
    });
  bar.clear();
  InterruptionWatch::check("compare");
  Truth truth;
  truth.method =
    "Brume's integrator in double precision: each stretch of a ray inside one voxel cell is cut into "
    "1, 2, 4, … pieces until the pixel changes by no more than " +
    nlohmann::json(settings.tolerance).dump() +
    " of white. About a third of the last change remains as its error.";
  for (int pieces = 1; pieces < settings.most_pieces; pieces *= 2)
  {
    ++truth.refinement_levels;
  }
  truth.remaining_mean = reference.mean_change / 3.0;
  truth.remaining_largest = reference.largest_change / 3.0;
  truth.seconds = reference.seconds;
  truth.picture = this->over(film);
  this->TruePicture = truth.picture;
  return truth;
}

Picture ComparisonMeasure::fixed_step(int placement, double leave_below)
{
  const brume::Scene* scene = this->Mapper->UpdateScene(this->Scene.volume, this->Scene.camera,
    this->Scene.lights, this->Scene.width(), this->Scene.height());
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
  Film film(this->Scene.width(), this->Scene.height());
  nlohmann::json statistics;
  entry.timing = time_renders(this->Repetitions,
    [&]
    {
      if (!this->Mapper->RenderFilm(
            this->Scene.volume, this->Scene.camera, this->Scene.lights, film))
      {
        InterruptionWatch::check("compare");
        throw Failure(this->Scene.options.input, "it cannot be drawn", "see brume info");
      }
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

  const Picture exact = this->fixed_step(static_cast<int>(SamplePlacement::Middle), 0.0);
  entry.contributions.push_back({ "step",
    "The same step in double precision, a sample in the middle of each, against the truth.",
    brume::measure(exact, this->TruePicture) });
  entry.contributions.push_back({ "single precision, tables, rays left early",
    "The picture against the same step in double precision.",
    brume::measure(entry.picture, exact) });
}

void ComparisonMeasure::measure_stock(ComparisonEntry& entry, MapperKind kind)
{
  StockRenderer renderer(this->Scene, kind, this->Step);
  entry.timing =
    time_renders(this->Repetitions, [&] { return renderer.render(); });
  entry.timing.prepare = std::max(0.0, entry.timing.warm_up - entry.timing.median);
  entry.picture = renderer.picture();
  const Picture frame = renderer.frame();
  this->Films[entry.mapper] = renderer.film();
  entry.statistics =
    nlohmann::json{ { "mapper", entry.mapper }, { "device", renderer.device() } }.dump(2);

  const Picture middle = this->fixed_step(static_cast<int>(SamplePlacement::Middle), 0.0);
  const bool fixed = kind == MapperKind::FixedPoint;
  const Picture placed = this->fixed_step(
    static_cast<int>(fixed ? SamplePlacement::FromNearPlane : SamplePlacement::FromEntry), 0.0);
  entry.contributions.push_back({ "step",
    "The same step in double precision, a sample in the middle of each, against the truth.",
    brume::measure(middle, this->TruePicture) });
  entry.contributions.push_back({ "ray start",
    fixed ? "Samples at whole steps from the camera's near plane, the last one not cut, against "
            "samples in the middle of steps; both in double precision."
          : "Samples at whole steps from where the ray enters, the last one not cut, against samples "
            "in the middle of steps; both in double precision.",
    brume::measure(placed, middle) });
  const bool shaded = this->Scene.volume->GetProperty()->GetShade() != 0;
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
    brume::measure(in_8_bits(this->TruePicture), this->TruePicture) });
  entry.contributions.push_back({ "textures, tables and the frame's 8 bits",
    "The picture against its own samples in double precision.",
    brume::measure(entry.picture, placed) });
}

}
