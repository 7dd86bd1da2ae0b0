// Kinds of `brume generate`: phantoms, shapes, particles and smoke.
#include "generator_settings.h"
#include "generators.h"

#include "command.h"

#include "vtkBrumeParticleSource.h"
#include "vtkBrumePhantomSource.h"
#include "vtkBrumeSignedDistanceSource.h"
#include "vtkBrumeSmokeSource.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkNew.h"

#include <cmath>
#include <fstream>

namespace brume::app
{

namespace
{

bool voxels(double v)
{
  return v >= 0.1 && v <= 10.0;
}
bool at_least_zero(double v)
{
  return v >= 0.0 && v <= 1e6;
}
bool above_zero(double v)
{
  return v > 0.0 && v <= 1e6;
}

/// A scan in Hounsfield units.
template <int Kind>
Make declare_scan(CLI::App& command)
{
  using Source = vtkBrumePhantomSource;
  vtkNew<Source> defaults;
  GeneratorSettings<Source> settings;
  settings.add(
    command,
    "--noise",
    "Standard deviation of the scanner's noise, HU, 0 to 1000",
    defaults->GetNoiseLevel(),
    "HU",
    "0 to 1000 HU",
    [](double v) { return v >= 0.0 && v <= 1000.0; },
    [](Source* s, double v) { s->SetNoiseLevel(v); });
  settings.add(command,
    "--edge",
    "Width over which a tissue passes into the next, voxels, 0.1 to 10",
    defaults->GetEdgeWidth(),
    "VOXELS",
    "0.1 to 10 voxels",
    voxels,
    [](Source* s, double v) { s->SetEdgeWidth(v); });
  return [settings](const GeneratorRequest& request)
  {
    vtkNew<Source> source;
    source->SetKind(Kind);
    source->SetSize(request.size);
    source->SetSeed(request.seed);
    settings.apply(source);
    Input input = run_source(source, request);
    input.length_unit = "mm";
    input.value_unit = "HU";
    input.patient_axes = true;
    input.backgrounds["Hounsfield"] = -1000; // air
    return input;
  };
}

/// A field whose optical depth along any ray is known.
template <int Kind>
Make declare_field(CLI::App& command)
{
  using Source = vtkBrumePhantomSource;
  vtkNew<Source> defaults;
  GeneratorSettings<Source> settings;
  auto water = std::make_shared<bool>(false);
  if (Kind == Source::KindSheppLogan)
  {
    command.add_flag("--water", *water, "Densities relative to water, in place of raised contrast");
  }
  else
  {
    settings.add(command,
      "--density",
      "The density, without a unit",
      defaults->GetDensity(),
      "X",
      "a number from 0 to 1e6",
      at_least_zero,
      [](Source* s, double v) { s->SetDensity(v); });
  }
  if (Kind == Source::KindBall || Kind == Source::KindSoftBall)
  {
    settings.add(
      command,
      "--radius",
      "Radius, world units, 0.001 to 1",
      defaults->GetRadius(),
      "R",
      "0.001 to 1",
      [](double v) { return v >= 1e-3 && v <= 1.0; },
      [](Source* s, double v) { s->SetRadius(v); });
  }
  if (Kind == Source::KindSlab)
  {
    settings.add(
      command,
      "--thickness",
      "Distance between its planes, world units, 0.001 to 4",
      defaults->GetThickness(),
      "D",
      "0.001 to 4",
      [](double v) { return v >= 1e-3 && v <= 4.0; },
      [](Source* s, double v) { s->SetThickness(v); });
    settings.add_vector(command,
      "--normal",
      "Their normal, of any length but 0 [0,0,1]",
      "three numbers with commas between",
      [](Source* s, const double* v) { s->SetNormal(v); });
  }
  if (Kind == Source::KindChecker)
  {
    settings.add(
      command,
      "--cells",
      "Cells along each axis, 1 to 1000",
      defaults->GetCells(),
      "N",
      "a whole number from 1 to 1000",
      [](double v) { return v >= 1.0 && v <= 1000.0 && v == std::floor(v); },
      [](Source* s, double v) { s->SetCells(static_cast<int>(v)); });
  }
  settings.add(command,
    "--edge",
    "Each voxel is the mean of a cube so wide, voxels, 0.1 to 10",
    defaults->GetEdgeWidth(),
    "VOXELS",
    "0.1 to 10 voxels",
    voxels,
    [](Source* s, double v) { s->SetEdgeWidth(v); });
  return [settings, water](const GeneratorRequest& request)
  {
    vtkNew<Source> source;
    source->SetKind(Kind);
    source->SetSize(request.size);
    source->SetRaisedContrast(!*water);
    settings.apply(source);
    return run_source(source, request);
  };
}

Make declare_smoke(CLI::App& command)
{
  using Source = vtkBrumeSmokeSource;
  vtkNew<Source> defaults;
  GeneratorSettings<Source> settings;
  settings.add(
    command,
    "--width",
    "Width of the plume's box, metres; it is twice as high",
    defaults->GetWidth(),
    "M",
    "0.01 to 1e6 metres",
    [](double v) { return v >= 0.01 && v <= 1e6; },
    [](Source* s, double v) { s->SetWidth(v); });
  settings.add(command,
    "--rise",
    "How fast the turbulence rises, metres a second",
    defaults->GetRise(),
    "M/S",
    "a speed of at most 1e6",
    any_height,
    [](Source* s, double v) { s->SetRise(v); });
  settings.add(command,
    "--air-temperature",
    "Temperature of the air around, kelvin",
    defaults->GetAirTemperature(),
    "K",
    "a temperature above 0 K",
    above_zero,
    [](Source* s, double v) { s->SetAirTemperature(v); });
  settings.add(command,
    "--source-temperature",
    "Temperature of the source, kelvin",
    defaults->GetSourceTemperature(),
    "K",
    "a temperature above 0 K",
    above_zero,
    [](Source* s, double v) { s->SetSourceTemperature(v); });
  return [settings](const GeneratorRequest& request)
  {
    vtkNew<Source> source;
    source->SetSize(request.size);
    source->SetSeed(request.seed);
    source->SetTime(request.time);
    settings.apply(source);
    if (source->GetSourceTemperature() < source->GetAirTemperature())
    {
      throw Failure("--source-temperature",
        "the source is colder than the air",
        "give it at least --air-temperature",
        BadCall);
    }
    source->SetSparse(request.sparse);
    GeneratorRequest part = request; // of the progress, too: two grids are two passes
    part.progress = [&request](double done) { request.progress(0.5 * done); };
    Input input = run_source(source, request.sparse && request.progress ? part : request);
    if (input.sparse)
    {
      vtkNew<Source> heat;
      settings.apply(heat);
      heat->SetSize(request.size);
      heat->SetSeed(request.seed);
      heat->SetTime(request.time);
      heat->SetSparse(true);
      heat->SetSparseQuantityToTemperature();
      part.progress = [&request](double done)
      {
        if (request.progress)
        {
          request.progress(0.5 + 0.5 * done);
        }
      };
      input.more_sparse.push_back(run_source(heat, part).sparse);
    }
    input.length_unit = "m";
    input.backgrounds["temperature"] = source->GetAirTemperature();
    return input;
  };
}

Make declare_particles(CLI::App& command)
{
  using Source = vtkBrumeParticleSource;
  vtkNew<Source> defaults;
  GeneratorSettings<Source> settings;
  settings.add(
    command,
    "--width",
    "Width of the box, metres",
    defaults->GetWidth(),
    "M",
    "0.01 to 1e6 metres",
    [](double v) { return v >= 0.01 && v <= 1e6; },
    [](Source* s, double v) { s->SetWidth(v); });
  settings.add(
    command,
    "--emitters",
    "How many emitters, 1 to 64",
    defaults->GetNumberOfEmitters(),
    "N",
    "a whole number from 1 to 64",
    [](double v) { return v >= 1.0 && v <= 64.0 && v == std::floor(v); },
    [](Source* s, double v) { s->SetNumberOfEmitters(static_cast<int>(v)); });
  settings.add(command,
    "--rate",
    "Particles a second of each emitter",
    defaults->GetRate(),
    "X",
    "a number from 0 to 1e6",
    at_least_zero,
    [](Source* s, double v) { s->SetRate(v); });
  settings.add(command,
    "--speed",
    "Their speed upwards at first, metres a second",
    defaults->GetSpeed(),
    "M/S",
    "a speed of at most 1e6",
    any_height,
    [](Source* s, double v) { s->SetSpeed(v); });
  settings.add(command,
    "--life",
    "How long a particle lives at most, seconds",
    defaults->GetLife(),
    "S",
    "a time above 0",
    above_zero,
    [](Source* s, double v) { s->SetLife(v); });
  settings.add(command,
    "--particle-radius",
    "Its first radius, metres",
    defaults->GetParticleRadius(),
    "M",
    "a length above 0",
    above_zero,
    [](Source* s, double v) { s->SetParticleRadius(v); });
  settings.add(command,
    "--growth",
    "How fast it grows, metres a second",
    defaults->GetGrowth(),
    "M/S",
    "0 or more",
    at_least_zero,
    [](Source* s, double v) { s->SetGrowth(v); });
  settings.add(command,
    "--density",
    "Density in a particle's middle at first",
    defaults->GetDensity(),
    "X",
    "0 or more",
    at_least_zero,
    [](Source* s, double v) { s->SetDensity(v); });
  settings.add(command,
    "--rise",
    "Speed at which particles rise, metres a second",
    defaults->GetRise(),
    "M/S",
    "a speed of at most 1e6",
    any_height,
    [](Source* s, double v) { s->SetRise(v); });
  settings.add(command,
    "--turbulence",
    "Speed of the eddies, metres a second",
    defaults->GetTurbulence(),
    "M/S",
    "0 or more",
    at_least_zero,
    [](Source* s, double v) { s->SetTurbulence(v); });
  settings.add(command,
    "--eddy-size",
    "Size of the largest eddies, metres",
    defaults->GetEddySize(),
    "M",
    "a length above 0",
    above_zero,
    [](Source* s, double v) { s->SetEddySize(v); });
  settings.add_vector(command,
    "--wind",
    "The steady wind, metres a second [0.5,0.15,0]",
    "three speeds with commas between",
    [](Source* s, const double* v) { s->SetWind(v); });
  return [settings](const GeneratorRequest& request)
  {
    vtkNew<Source> source;
    source->SetSparse(request.sparse);
    source->SetSize(request.size);
    source->SetSeed(request.seed);
    source->SetTime(request.time);
    settings.apply(source);
    Input input = run_source(source, request);
    input.length_unit = "m";
    return input;
  };
}

/// A whole text file, of at most a mebibyte.
std::string text_of(const std::string& path)
{
  constexpr std::streamsize Most = 1 << 20;
  std::ifstream in(path, std::ios::binary);
  std::string text(Most + 1, '\0');
  in.read(text.data(), Most + 1); // a device may have no end
  const std::streamsize count = in.gcount();
  if (count == 0)
  {
    throw Failure(path, "it cannot be read, or is empty", "name a file that describes a shape");
  }
  if (count > Most)
  {
    throw Failure(path, "it is longer than 1 MiB", "name a file that describes a shape");
  }
  text.resize(static_cast<std::size_t>(count));
  return text;
}

Make declare_shape(CLI::App& command)
{
  struct Options
  {
    std::string shape = "(smooth-unite 0.3 (sphere 1) (move 0 0 1.2 (box 0.5 0.5 0.5 0.1)))";
    std::string file;
    std::string bounds;
    bool distance = false;
    double edge = 2.0;
  };
  auto o = std::make_shared<Options>();
  CLI::Option* text =
    command
      .add_option("--shape",
        o->shape,
        "The shape, as nested lists: (sphere 1), (subtract (box 1 1 1) (torus 0.8 0.2)), … [a ball "
        "that runs into a box]")
      ->type_name("TEXT");
  command.add_option("--shape-file", o->file, "The same from a file")
    ->type_name("FILE")
    ->excludes(text);
  CLI::Option* edge =
    command
      .add_option(
        "--edge", o->edge, "Width over which the density passes from 1 to 0, voxels, 0 to 100 [2]")
      ->check(number("0 to 100 voxels", [](double v) { return v >= 0.0 && v <= 100.0; }))
      ->type_name("VOXELS");
  command
    .add_flag("--distance",
      o->distance,
      "The signed distance in place of a density: world units, negative inside; a level set in a "
      ".vdb")
    ->excludes(edge);
  command
    .add_option("--bounds",
      o->bounds,
      "The box of the volume, world units [the shape's own and 5 % more on each side]")
    ->check(numbers("six numbers with commas between", { 6 }, any_height))
    ->type_name("X0,X1,Y0,Y1,Z0,Z1");
  return [o](const GeneratorRequest& request)
  {
    vtkNew<vtkBrumeSignedDistanceSource> source;
    source->SetDescription((o->file.empty() ? o->shape : text_of(o->file)).c_str());
    source->SetQuantity(
      o->distance ? vtkBrumeSignedDistanceSource::Distance : vtkBrumeSignedDistanceSource::Density);
    source->SetSize(request.size);
    source->SetEdgeWidth(o->edge);
    if (!o->bounds.empty())
    {
      source->SetBounds(split_numbers(o->bounds).data());
    }
    source->SetSparse(request.sparse && (!o->distance || request.level_set));
    Input input = run_source(source, request);
    input.signed_distance = o->distance;
    return input;
  };
}

}

std::vector<Generator> shape_generators()
{
  using Phantom = vtkBrumePhantomSource;
  return {
    { "head-ct",
      "a head as a CT scanner sees it, in Hounsfield units",
      256,
      Moves::No,
      declare_scan<Phantom::KindHeadCT> },
    { "torso-ct",
      "a torso as a CT scanner sees it, in Hounsfield units",
      256,
      Moves::No,
      declare_scan<Phantom::KindTorsoCT> },
    { "smoke",
      "a plume of hot smoke of 8 m, density from 0 to 1 and temperature in kelvin",
      256,
      Moves::Yes,
      declare_smoke },
    { "particles",
      "a puffing fountain of mist of 6 m, density",
      128,
      Moves::Yes,
      declare_particles },
    { "shape",
      "what a text describes: spheres, boxes, … joined and cut; density or distance",
      128,
      Moves::No,
      declare_shape,
      0.0,
      false },
    { "shepp-logan",
      "the phantom of ten ellipsoids, density",
      256,
      Moves::No,
      declare_field<Phantom::KindSheppLogan>,
      0.0,
      false },
    { "constant",
      "one density everywhere",
      64,
      Moves::No,
      declare_field<Phantom::KindConstant>,
      0.0,
      false },
    { "ramp",
      "a density that rises along x",
      64,
      Moves::No,
      declare_field<Phantom::KindRamp>,
      0.0,
      false },
    { "ball",
      "a ball of one density",
      128,
      Moves::No,
      declare_field<Phantom::KindBall>,
      0.0,
      false },
    { "soft-ball",
      "a ball that thins outwards, density",
      128,
      Moves::No,
      declare_field<Phantom::KindSoftBall>,
      0.0,
      false },
    { "slab",
      "a plate of one density",
      128,
      Moves::No,
      declare_field<Phantom::KindSlab>,
      0.0,
      false },
    { "checker",
      "cubes of one density and of 0 by turns",
      128,
      Moves::No,
      declare_field<Phantom::KindChecker>,
      0.0,
      false },
  };
}

}
