// Kinds of `brume generate`: phantoms, shapes, particles and smoke.
#include "generators.h"

#include "command.h"
#include "option_checks.h"

#include "vtkBrumePhantomSource.h"
#include "vtkBrumeSmokeSource.h"

#include "vtkNew.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <memory>

namespace brume::app
{

namespace
{

Make declare_head_ct(CLI::App& command)
{
  struct Options
  {
    double noise = 10.0;
    double edge = 2.0;
  };
  auto o = std::make_shared<Options>();
  command
    .add_option(
      "--noise", o->noise, "Standard deviation of the scanner's noise, HU, 0 to 1000 [10]")
    ->check(number("0 to 1000 HU", [](double v) { return v >= 0 && v <= 1000; }))
    ->type_name("HU");
  command
    .add_option(
      "--edge", o->edge, "Width over which a tissue passes into the next, voxels, 0.1 to 10 [2]")
    ->check(number("0.1 to 10 voxels", [](double v) { return v >= 0.1 && v <= 10; }))
    ->type_name("VOXELS");
  return [o](const GeneratorRequest& request)
  {
    vtkNew<vtkBrumePhantomSource> source;
    source->SetSize(request.size);
    source->SetSeed(request.seed);
    source->SetNoiseLevel(o->noise);
    source->SetEdgeWidth(o->edge);
    Input input = run_source(source, request);
    input.length_unit = "mm";
    input.value_unit = "HU";
    input.patient_axes = true;
    input.backgrounds["Hounsfield"] = -1000; // air
    return input;
  };
}

Make declare_smoke(CLI::App& command)
{
  struct Options
  {
    double width = 4.0;
    double rise = 1.2;
    double air = 300.0;
    double source = 1900.0;
  };
  auto o = std::make_shared<Options>();
  command
    .add_option("--width", o->width, "Width of the plume's box, metres; it is twice as high [4]")
    ->check(number("0.01 to 1e6 metres", [](double v) { return v >= 0.01 && v <= 1e6; }))
    ->type_name("M");
  command.add_option("--rise", o->rise, "How fast the turbulence rises, metres a second [1.2]")
    ->check(number("a speed of at most 1e6", [](double v) { return std::abs(v) <= 1e6; }))
    ->type_name("M/S");
  const auto kelvin = number("a temperature above 0 K", [](double v) { return v > 0 && v <= 1e6; });
  command.add_option("--air-temperature", o->air, "Temperature of the air around, kelvin [300]")
    ->check(kelvin)
    ->type_name("K");
  command.add_option("--source-temperature", o->source, "Temperature of the source, kelvin [1900]")
    ->check(kelvin)
    ->type_name("K");
  return [o](const GeneratorRequest& request)
  {
    if (o->source < o->air)
    {
      throw Failure("--source-temperature",
        "the source is colder than the air",
        "give it at least --air-temperature",
        BadCall);
    }
    vtkNew<vtkBrumeSmokeSource> source;
    source->SetSize(request.size);
    source->SetSeed(request.seed);
    source->SetTime(request.time);
    source->SetWidth(o->width);
    source->SetRise(o->rise);
    source->SetAirTemperature(o->air);
    source->SetSourceTemperature(o->source);
    Input input = run_source(source, request);
    input.length_unit = "m";
    input.backgrounds["temperature"] = o->air;
    return input;
  };
}

}

std::vector<Generator> shape_generators()
{
  return {
    { "head-ct",
      "a head as a CT scanner sees it, in Hounsfield units",
      256,
      Moves::No,
      declare_head_ct },
    { "smoke",
      "a plume of hot smoke of 8 m, density from 0 to 1 and temperature in kelvin",
      256,
      Moves::Yes,
      declare_smoke },
  };
}

}
