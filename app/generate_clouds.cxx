// Kinds of `brume generate`: clouds and fog.
#include "generators.h"

#include "option_checks.h"

#include "vtkBrumeCloudSource.h"
#include "vtkBrumeFogSource.h"

#include "vtkNew.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <memory>

namespace brume::app
{

namespace
{

Make declare_cumulus(CLI::App& command)
{
  struct Options
  {
    double width = 2000.0;
    double detail = 160.0;
    int octaves = 5;
    double offset = 0.12;
    double crispness = 4.0;
    double warp = 50.0;
    double warp_size = 300.0;
    std::string wind = "4,1,1.5";
  };
  auto o = std::make_shared<Options>();
  const auto metres = number("1 to 1e6 metres", [](double v) { return v >= 1.0 && v <= 1e6; });
  command
    .add_option("--width", o->width, "Width of the cloud's box, metres; it is 0.6 as high [2000]")
    ->check(metres)
    ->type_name("M");
  command.add_option("--detail-size", o->detail, "Size of the largest bulges, metres [160]")
    ->check(metres)
    ->type_name("M");
  command.add_option("--octaves", o->octaves, "Octaves of noise, 1 to 8 [5]")
    ->check(number("a whole number from 1 to 8", [](double v) { return v >= 1 && v <= 8; }))
    ->type_name("N");
  command
    .add_option(
      "--offset", o->offset, "How much cloud there is where the noise is 0, 0 to 1 [0.12]")
    ->check(number("a number from 0 to 1", [](double v) { return v >= 0 && v <= 1; }))
    ->type_name("X");
  command
    .add_option(
      "--crispness", o->crispness, "How fast density climbs behind the edge, 0.1 to 100 [4]")
    ->check(number("a number from 0.1 to 100", [](double v) { return v >= 0.1 && v <= 100; }))
    ->type_name("X");
  command
    .add_option("--warp",
      o->warp,
      "How far eddies push the cloud about, metres; 0 is none, at most 0.06 width [50]")
    ->check(number("0 metres or more", [](double v) { return v >= 0; }))
    ->type_name("M");
  command.add_option("--warp-size", o->warp_size, "Size of these eddies, metres [300]")
    ->check(metres)
    ->type_name("M");
  command.add_option("--wind", o->wind, "Wind that carries the noise, metres a second [4,1,1.5]")
    ->check(numbers(
      "three speeds with commas between", { 3 }, [](double v) { return std::abs(v) <= 1e6; }))
    ->type_name("X,Y,Z");
  return [o](const GeneratorRequest& request)
  {
    vtkNew<vtkBrumeCloudSource> source;
    source->SetSparse(request.sparse);
    source->SetSize(request.size);
    source->SetSeed(request.seed);
    source->SetTime(request.time);
    source->SetWidth(o->width);
    source->SetDetailSize(o->detail);
    source->SetOctaves(o->octaves);
    source->SetOffset(o->offset);
    source->SetCrispness(o->crispness);
    source->SetWarpAmplitude(o->warp);
    source->SetWarpSize(o->warp_size);
    source->SetWind(split_numbers(o->wind).data());
    Input input = run_source(source, request);
    input.length_unit = "m";
    return input;
  };
}

Make declare_fog(CLI::App& command)
{
  struct Options
  {
    std::string kind = "valley";
  };
  auto o = std::make_shared<Options>();
  command
    .add_option("--kind",
      o->kind,
      "homogeneous, height (thinner the higher, in swathes) or valley (in the hollows of hills) "
      "[valley]")
    ->check(one_of({ "homogeneous", "height", "valley" }))
    ->type_name("KIND");
  return [o](const GeneratorRequest& request)
  {
    vtkNew<vtkBrumeFogSource> source;
    source->SetKind(o->kind == "homogeneous" ? vtkBrumeFogSource::KindHomogeneous
        : o->kind == "height"                ? vtkBrumeFogSource::KindHeight
                                             : vtkBrumeFogSource::KindValley);
    source->SetSparse(request.sparse);
    source->SetSize(request.size);
    source->SetSeed(request.seed);
    source->SetTime(request.time);
    Input input = run_source(source, request);
    input.length_unit = "m";
    return input;
  };
}

}

std::vector<Generator> cloud_generators()
{
  return {
    { "cumulus",
      "a cumulus of 2 km with its flat base, density from 0 to 1",
      256,
      Moves::Yes,
      declare_cumulus },
    { "fog",
      "a bank of fog of 4 km, density from 0 to 1",
      256,
      Moves::Yes,
      declare_fog },
  };
}

}
