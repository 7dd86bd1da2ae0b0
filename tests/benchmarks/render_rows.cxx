#include "rows.h"

#include "vtkCamera.h"
#include "vtkLightCollection.h"
#include "vtkVolume.h"
#include "vtkVolumeMapper.h"
#include "vtkVolumeProperty.h"

#include <cmath>
#include <cstdio>
#include <limits>

namespace benchmarks
{

namespace
{

using brume::ImageErrors;
using brume::app::MapperKind;
using brume::app::StockRenderer;

constexpr double default_tolerance = 0.004;

std::string text(const char* format, double value)
{
  char buffer[80];
  std::snprintf(buffer, sizeof(buffer), format, value);
  return buffer;
}

/// Brume and VTK's CPU mapper, drawing the same scene in turns.
struct Pair
{
  std::unique_ptr<Subject> brume;
  std::unique_ptr<StockRenderer> stock;

  Repetition repeat()
  {
    Repetition one;
    one.seconds = this->brume->render();
    one.other = this->stock->render();
    one.figure = one.other / one.seconds;
    return one;
  }
};

void want_display(const Options& options)
{
  if (!options.no_display.empty())
  {
    throw Skipped("no display for VTK's mapper: " + options.no_display);
  }
}

std::unique_ptr<StockRenderer> stock_at(const Scene& scene, double voxels)
{
  return std::make_unique<StockRenderer>(
    scene.volume(), MapperKind::FixedPoint, voxels * scene.volume().voxel_edge);
}

/// Loosens the tolerance as far as the picture stays as near to the truth as `bound`, and leaves
/// the mapper with it. Looks at 1/2, 1/2√2, 1/4 … of white.
bool find_tolerance(Subject& subject, Scene& scene, const ImageErrors& bound)
{
  for (double tolerance = 0.5; tolerance > 5e-5; tolerance *= std::sqrt(0.5))
  {
    subject.mapper()->SetTolerance(tolerance);
    subject.render();
    if (no_larger(brume::measure(subject.picture(), scene.truth()), bound))
    {
      return true;
    }
  }
  return false;
}

void remark_subject(Row& row, const Subject& subject, const ImageErrors& errors)
{
  const nlohmann::json& s = subject.statistics();
  std::string words =
    "Brume: " + in_words(errors) + ", step " + text("%.4g", s["step_in_voxels"]) + " voxels";
  if (s.value("step_chosen_by", "") == "tolerance")
  {
    words += " by a tolerance of " + text("%.3g", s["tolerance"]);
  }
  row.remark(words);
}

enum class Steps
{
  Own,       ///< by the loosest tolerance that is as near to the truth as the stock picture
  Half,      ///< half a voxel, both
  Tolerance, ///< both within the default tolerance, if the stock mapper can
};

using GetScene = std::function<Scene&()>;

void prepare_pair(Pair& pair, const Options& options, const GetScene& get, Steps steps, Row& row)
{
  want_display(options);
  Scene& scene = get();
  const bool shaded = scene.volume().volume->GetProperty()->GetShade() != 0;
  double stock_step = 0.5;
  ImageErrors stock_errors;
  if (steps == Steps::Tolerance)
  {
    double best = std::numeric_limits<double>::infinity();
    bool met = false;
    std::string tried;
    for (double step = 0.5; step >= 1.0 / 32.0 && !met; step *= 0.5)
    {
      auto stock = stock_at(scene, step);
      stock->render();
      const ImageErrors errors = brume::measure(stock->picture(), scene.truth());
      tried += (tried.empty() ? "" : ", ") + text("1/%.0f: ", 1.0 / step) +
               text("%.3g", 255.0 * errors.largest);
      met = errors.largest <= default_tolerance;
      if (errors.largest < best)
      {
        best = errors.largest;
        stock_step = step;
      }
    }
    row.remark("stock's largest error by step in voxels: " + tried + " (1.02 is asked for)");
    if (!met)
    {
      row.remark("it never meets the tolerance; timed at its best");
    }
  }
  pair.stock = stock_at(scene, stock_step);
  pair.stock->render();
  stock_errors = brume::measure(pair.stock->picture(), scene.truth());
  row.other = "VTK's CPU mapper, step " + text("%.4g", stock_step) + " voxels";

  const double fixed = steps == Steps::Half ? 0.5 * scene.volume().voxel_edge : 0.0;
  pair.brume = std::make_unique<Subject>(scene, fixed, options.threads);
  pair.brume->mapper()->SetTolerance(default_tolerance);
  pair.brume->render();
  const double prepare = pair.brume->prepare_seconds();
  if (steps == Steps::Own && !find_tolerance(*pair.brume, scene, stock_errors))
  {
    row.remark("no tolerance down to 0.00005 gives errors as small; timed there");
  }
  pair.brume->render();
  const ImageErrors errors = brume::measure(pair.brume->picture(), scene.truth());
  remark_subject(row, *pair.brume, errors);
  row.remark("stock: " + in_words(stock_errors));
  row.remark("Brume's preparation before a first picture: " + text("%.3g s", prepare));
  if (shaded)
  {
    row.remark(
      "both against Brume's shaded truth: the stock mapper's shading is defined differently");
  }
}

}

void add_render_rows(Scenes& scenes, std::vector<Row>& rows)
{
  const Options& options = scenes.options();
  const auto add =
    [&](int number, const char* name, const char* what, double target, GetScene get, Steps steps)
  {
    Row row;
    row.number = number;
    row.name = name;
    row.what = what;
    row.unit = "×";
    row.target = target;
    row.repetitions = options.quick ? 1 : steps == Steps::Tolerance ? 3 : options.repetitions;
    auto pair = std::make_shared<Pair>();
    row.prepare = [=, &options](Row& self) { prepare_pair(*pair, options, get, steps, self); };
    row.repeat = [pair] { return pair->repeat(); };
    rows.push_back(row);
  };
  const auto ball = [&](bool shaded)
  {
    return [&scenes, shaded]() -> Scene& { return scenes.ball(shaded); };
  };
  const auto brain = [&](bool shaded)
  {
    return [&scenes, shaded]() -> Scene&
    {
      if (scenes.options().brain.empty())
      {
        throw Skipped("no brain scan: scripts/fetch-brain gets it, --brain FILE names it");
      }
      return scenes.input(scenes.options().brain, shaded);
    };
  };
  const auto head = [&](bool shaded)
  {
    return [&scenes, shaded]() -> Scene& { return scenes.input("sample:head-ct", shaded); };
  };

  add(1, "ball-own-steps", "ball, own steps, errors no larger", 10, ball(false), Steps::Own);
  add(2, "ball-half-voxel", "ball, ½ voxel both", 4, ball(false), Steps::Half);
  add(3,
    "ball-shaded-own-steps",
    "ball shaded, own steps, errors no larger",
    10,
    ball(true),
    Steps::Own);
  add(4, "ball-shaded-half-voxel", "ball shaded, ½ voxel both", 4, ball(true), Steps::Half);
  add(5,
    "ball-tolerance",
    "ball, both within the default tolerance",
    20,
    ball(false),
    Steps::Tolerance);
  add(6, "brain-own-steps", "brain scan, own steps, errors no larger", 5, brain(false), Steps::Own);
  add(7,
    "brain-shaded-own-steps",
    "brain scan shaded, own steps, errors no larger",
    5,
    brain(true),
    Steps::Own);
  add(8, "head-own-steps", "head CT, own steps, errors no larger", 5, head(false), Steps::Own);
  add(9,
    "head-shaded-own-steps",
    "head CT shaded, own steps, errors no larger",
    5,
    head(true),
    Steps::Own);

  Row mip;
  mip.number = 10;
  mip.name = "ball-maximum-intensity";
  mip.what = "ball, maximum intensity, ½ voxel both";
  mip.unit = "×";
  mip.target = 5;
  mip.repetitions = options.quick ? 1 : options.repetitions;
  auto pair = std::make_shared<Pair>();
  mip.prepare = [pair, &scenes](Row& row)
  {
    want_display(scenes.options());
    Scene& scene = scenes.ball(false);
    pair->brume =
      std::make_unique<Subject>(scene, 0.5 * scene.volume().voxel_edge, scenes.options().threads);
    pair->brume->mapper()->SetBlendModeToMaximumIntensity();
    vtkObject::SetGlobalWarningDisplay(0); // it warns of a setting that it does not follow
    try
    {
      pair->brume->render();
    }
    catch (const std::runtime_error&)
    {
      vtkObject::SetGlobalWarningDisplay(1);
      throw Skipped("not supported yet: the mapper draws nothing");
    }
    vtkObject::SetGlobalWarningDisplay(1);
    for (const auto& ignored : pair->brume->statistics()["ignored_settings"])
    {
      if (ignored.get<std::string>().find("BlendMode") != std::string::npos)
      {
        throw Skipped("not supported: the mapper ignores " + ignored.get<std::string>());
      }
    }
    pair->stock = stock_at(scene, 0.5);
    pair->stock->mapper()->SetBlendModeToMaximumIntensity();
    pair->stock->render();
    row.other = "VTK's CPU mapper, the same step";
    row.remark("the two pictures differ by " +
               in_words(brume::measure(pair->brume->picture(), pair->stock->picture())));
  };
  mip.repeat = [pair] { return pair->repeat(); };
  rows.push_back(mip);
}

}
