#include "compare_measure.h"

#include "command.h"
#include "cost_paths.h"
#include "interruption.h"
#include "progress.h"
#include "render_timing.h"
#include "scene_truth.h"
#include "stock_renderer.h"
#include "stock_scene.h"

#include "Transport/reference.h"

#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <vector>

namespace brume::app
{

namespace
{

/// Where VTK's CPU mapper leaves a ray: 255 of 32767 of its fixed-point opacity.
constexpr double fixed_point_leaves_below = 255.0 / 32767.0;

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

Picture ComparisonMeasure::over_stock(const Film& film) const
{
  return { film.width, film.height, over_scene(film, this->Scene, this->StockSurfaces) };
}

ComparisonMeasure::ComparisonMeasure(
  const VolumeScene& scene, double step, int repetitions, bool paths)
  : Scene(scene)
  , LeftOut(left_out_by_stock(scene.options))
  , March(scene, "compare")
  , Step(step)
  , Repetitions(repetitions)
{
  if (not_drawn_by_stock(scene.options, scene.input).empty())
  {
    this->Stock = stock_scene(scene);
    set_up(this->Stock, this->StockMapper);
  }
  simulate_as_asked(this->March, step);
  if (paths)
  {
    this->Paths = std::make_unique<ComparePaths>(scene, this->March.surfaces());
  }
  this->StockSurfaces =
    this->Stock.volume && scene.sky ? draw_meshes(this->Stock) : this->March.surfaces();
  this->StockMapper->SetSurfaceDepth(this->StockSurfaces.depth);
}

bool ComparisonMeasure::plain() const
{
  return only_absorbs(this->Scene);
}

ComparisonMeasure::~ComparisonMeasure()
{
  if (this->Stock.volume)
  {
    this->Stock.volume->SetMapper(nullptr);
  }
}

Truth ComparisonMeasure::measure_truth()
{
  Truth truth = this->plain() ? truth_by_quadrature(this->March).truth
    : this->Paths && is_truth_by_paths(this->Scene)
    ? this->truth_by_paths()
    : truth_by_march(this->March, this->Step).truth;
  this->TruePicture = truth.picture;
  if (this->plain())
  {
    this->StockTruth = truth.picture;
  }
  return truth;
}

Truth ComparisonMeasure::truth_by_paths()
{
  std::string text;
  const Film film = this->Paths->truth(text);
  this->March.take_volume();
  const auto statistics = nlohmann::json::parse(text);
  const int scatterings = statistics["maximum_scatterings"];
  // Of errors that are normally distributed the mean size is √(2/π) of the root mean square.
  constexpr double mean_of_rms = 0.79788456;
  Truth truth;
  truth.method = "Brume's path tracer, without bias: " +
    (scatterings > 0 ? "up to " + std::to_string(scatterings) : std::string("any number of")) +
    " scatterings, " + std::to_string(statistics["samples_per_pixel"].get<int>()) +
    " paths through each pixel. Its error is noise, by its own estimate: the mean, and what 99.9 % of "
    "pixels are expected to be below.";
  truth.remaining_mean =
    statistics["rms_error"].is_null() ? 0.0 : mean_of_rms * statistics["rms_error"].get<double>();
  truth.remaining_largest =
    statistics["estimated_error"].is_null() ? 0.0 : statistics["estimated_error"].get<double>();
  truth.seconds = statistics["seconds"];
  truth.picture = this->March.over(film);
  return truth;
}

Picture ComparisonMeasure::fixed_step(int placement, double leave_below)
{
  const bool plain = this->plain();
  const brume::Scene* scene = (plain ? this->March.mapper() : this->StockMapper.Get())
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
  return plain ? this->March.over(film) : this->over_stock(film);
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
  else if (mapper.kind == MapperKind::PathTrace)
  {
    this->measure_paths(entry);
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
  entry.timing = time_renders(this->Repetitions, "compare",
    [&]
    {
      film = this->March.draw();
      const auto now = nlohmann::json::parse(this->March.mapper()->GetStatistics());
      if (statistics.is_null())
      {
        entry.timing.prepare = now["seconds_prepare"];
        statistics = now;
      }
      return now["seconds"].get<double>();
    });
  entry.timing.prepare = statistics["seconds_prepare"];
  entry.statistics = statistics.dump(2);
  entry.picture = this->March.over(film);
  this->Threads = statistics["threads"];
  this->Simd = statistics["simd"];
  this->Films["raymarch"] = film;

  this->find_causes(entry);
}

void ComparisonMeasure::measure_paths(ComparisonEntry& entry)
{
  Film film;
  nlohmann::json statistics;
  entry.timing = time_renders(this->Repetitions, "compare",
    [&]
    {
      std::string text;
      film = this->Paths->draw(0, text);
      statistics = nlohmann::json::parse(text);
      return statistics["seconds"].get<double>();
    });
  entry.timing.prepare = statistics["seconds_prepare"];
  entry.statistics = statistics.dump(2);
  entry.picture = this->March.over(film);
  this->Films["pathtrace"] = film;
  std::string text;
  const Film other = this->Paths->draw(1, text);
  entry.contributions.push_back({ "noise",
    "The picture against another one of other random numbers: √2 of the noise of one.",
    brume::measure(entry.picture, this->March.over(other)) });
  this->March.take_volume();
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
  this->March.mapper()->SetSampleDistance(0.25 * this->Step);
  entry.contributions.push_back({ "step",
    "The picture against the same mapper's with a quarter of the step.",
    brume::measure(entry.picture, this->March.over(this->March.draw())) });
  this->March.mapper()->SetSampleDistance(this->Step);
  const std::string method = statistics.value("shadow_method", "none");
  if (method == "volume" || method == "functions")
  {
    this->March.mapper()->SetShadowMethod(vtkBrumeRayMarchMapper::RayShadows);
    this->March.mapper()->SetShadowSampleDistance(0.0);
    entry.contributions.push_back({ "shadows",
      "The picture against the same mapper's with shadows by rays, the steps alike.",
      brume::measure(entry.picture, this->March.over(this->March.draw())) });
    apply(this->Scene.options.medium, this->March.mapper());
  }
}

void ComparisonMeasure::measure_stock(ComparisonEntry& entry, MapperKind kind)
{
  entry.left_out = this->LeftOut;
  if (this->StockTruth.rgb.empty())
  {
    this->StockTruth = this->over_stock(
      quadrature(this->Scene, this->StockMapper, this->Stock.volume,
        "computing the truth of what VTK knows", "compare")
        .film);
  }
  StockRenderer renderer(this->Stock, kind, this->Step);
  entry.timing =
    time_renders(this->Repetitions, "compare", [&] { return renderer.render(); });
  entry.timing.prepare = std::max(0.0, entry.timing.warm_up - entry.timing.median);
  const bool fixed = kind == MapperKind::FixedPoint;
  entry.picture = fixed ? this->over_stock(renderer.film()) : renderer.picture();
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
