// Kinds of `brume generate`: clouds and fog.
#include "generator_settings.h"
#include "generators.h"

#include "vtkBrumeCloudSource.h"
#include "vtkBrumeFogSource.h"

#include "vtkNew.h"

namespace brume::app
{

namespace
{

/// What every field of matter is asked for.
template <class Source>
Input run_field(Source* source, const GeneratorRequest& request)
{
  source->SetSparse(request.sparse);
  source->SetSize(request.size);
  source->SetSeed(request.seed);
  source->SetTime(request.time);
  Input input = run_source(source, request);
  input.length_unit = "m";
  return input;
}

template <int Kind>
Make declare_cloud(CLI::App& command)
{
  using Source = vtkBrumeCloudSource;
  vtkNew<Source> defaults;
  defaults->SetKind(Kind);
  const bool one = Kind == Source::KindCumulus || Kind == Source::KindCumulonimbus;
  GeneratorSettings<Source> settings;
  settings.add(
    command,
    "--width",
    "Width of the box, metres",
    defaults->GetWidth(),
    "M",
    "1 to 1e6 metres",
    [](double v) { return v >= 1.0 && v <= 1e6; },
    [](Source* s, double v) { s->SetWidth(v); });
  const char* by_width = Kind == Source::KindCumulus ? "; 0: by the width" : "";
  settings.add(command,
    "--base-height",
    std::string("Height of the cloud's base, metres") + by_width,
    defaults->GetBaseHeight(),
    "M",
    "a height in metres",
    any_height,
    [](Source* s, double v) { s->SetBaseHeight(v); });
  settings.add(command,
    "--top-height",
    std::string("Height of its top, metres") + by_width,
    defaults->GetTopHeight(),
    "M",
    "a height in metres",
    any_height,
    [](Source* s, double v) { s->SetTopHeight(v); });
  if (!one)
  {
    settings.add(command,
      "--coverage",
      "Fraction of the ground under cloud, 0 to 1",
      defaults->GetCoverage(),
      "X",
      "a number from 0 to 1",
      fraction,
      [](Source* s, double v) { s->SetCoverage(v); });
  }
  settings.add(command,
    "--detail-size",
    "Size of the largest features, metres",
    defaults->GetDetailSize(),
    "M",
    "0.1 to 1e6 metres",
    positive_length,
    [](Source* s, double v) { s->SetDetailSize(v); });
  settings.add(command,
    "--octaves",
    "Octaves of noise, 1 to 8",
    defaults->GetOctaves(),
    "N",
    "a whole number from 1 to 8",
    one_to_eight,
    [](Source* s, double v) { s->SetOctaves(static_cast<int>(v)); });
  settings.add(command,
    "--offset",
    "How much cloud there is where the noise is 0, 0 to 1",
    defaults->GetOffset(),
    "X",
    "a number from 0 to 1",
    fraction,
    [](Source* s, double v) { s->SetOffset(v); });
  settings.add(
    command,
    "--crispness",
    "How fast density climbs behind the edge, 0.1 to 100",
    defaults->GetCrispness(),
    "X",
    "a number from 0.1 to 100",
    [](double v) { return v >= 0.1 && v <= 100.0; },
    [](Source* s, double v) { s->SetCrispness(v); });
  settings.add(
    command,
    "--warp",
    "How far eddies push the cloud about, metres; 0 is none",
    defaults->GetWarpAmplitude(),
    "M",
    "0 metres or more",
    [](double v) { return v >= 0.0; },
    [](Source* s, double v) { s->SetWarpAmplitude(v); });
  settings.add(command,
    "--warp-size",
    "Size of these eddies, metres",
    defaults->GetWarpSize(),
    "M",
    "0.1 to 1e6 metres",
    positive_length,
    [](Source* s, double v) { s->SetWarpSize(v); });
  settings.add_vector(command,
    "--wind",
    "Wind, metres a second [the kind's own]",
    "three speeds with commas between",
    [](Source* s, const double* v) { s->SetWind(v); });
  return [settings](const GeneratorRequest& request)
  {
    vtkNew<Source> source;
    source->SetKind(Kind);
    settings.apply(source);
    return run_field(source.Get(), request);
  };
}

template <int Kind>
Make declare_fog(CLI::App& command)
{
  using Source = vtkBrumeFogSource;
  vtkNew<Source> defaults;
  GeneratorSettings<Source> settings;
  settings.add(
    command,
    "--width",
    "Width of the box, metres",
    defaults->GetWidth(),
    "M",
    "1 to 1e6 metres",
    [](double v) { return v >= 1.0 && v <= 1e6; },
    [](Source* s, double v) { s->SetWidth(v); });
  if (Kind != Source::KindValley)
  {
    settings.add(command,
      "--base-height",
      "Height of the box's floor, metres",
      defaults->GetBaseHeight(),
      "M",
      "a height in metres",
      any_height,
      [](Source* s, double v) { s->SetBaseHeight(v); });
    settings.add(command,
      "--top-height",
      "Height of its ceiling, metres",
      defaults->GetTopHeight(),
      "M",
      "a height in metres",
      any_height,
      [](Source* s, double v) { s->SetTopHeight(v); });
  }
  if (Kind == Source::KindHeight)
  {
    settings.add(command,
      "--scale-height",
      "Height over which it thins to 1/e, metres",
      defaults->GetScaleHeight(),
      "M",
      "0.1 to 1e6 metres",
      positive_length,
      [](Source* s, double v) { s->SetScaleHeight(v); });
  }
  if (Kind != Source::KindHomogeneous)
  {
    settings.add(command,
      "--noise",
      "How much the noise takes at most, 0 to 1",
      defaults->GetNoise(),
      "X",
      "a number from 0 to 1",
      fraction,
      [](Source* s, double v) { s->SetNoise(v); });
    settings.add(command,
      "--detail-size",
      "Size of the noise's largest features, metres",
      defaults->GetDetailSize(),
      "M",
      "0.1 to 1e6 metres",
      positive_length,
      [](Source* s, double v) { s->SetDetailSize(v); });
    settings.add(command,
      "--octaves",
      "Octaves of noise, 1 to 8",
      defaults->GetOctaves(),
      "N",
      "a whole number from 1 to 8",
      one_to_eight,
      [](Source* s, double v) { s->SetOctaves(static_cast<int>(v)); });
    settings.add_vector(command,
      "--wind",
      "Wind that carries the noise, metres a second [1.5,0.5,0]",
      "three speeds with commas between",
      [](Source* s, const double* v) { s->SetWind(v); });
  }
  if (Kind == Source::KindValley)
  {
    const auto length = [](double v) { return v >= 0.0 && v <= 1e5; };
    settings.add(command,
      "--relief",
      "Height of the hills, metres",
      defaults->GetRelief(),
      "M",
      "0 to 1e5 metres",
      length,
      [](Source* s, double v) { s->SetRelief(v); });
    settings.add(command,
      "--coverage",
      "Fraction of the ground under fog, 0 to 1",
      defaults->GetCoverage(),
      "X",
      "a number from 0 to 1",
      fraction,
      [](Source* s, double v) { s->SetCoverage(v); });
    settings.add(
      command,
      "--softness",
      "Depth below its surface at which it is full, metres",
      defaults->GetSoftness(),
      "M",
      "0.1 to 1e5 metres",
      [](double v) { return v >= 0.1 && v <= 1e5; },
      [](Source* s, double v) { s->SetSoftness(v); });
    settings.add(command,
      "--sink",
      "How far it goes on under the ground, metres",
      defaults->GetSink(),
      "M",
      "0 to 1e5 metres",
      length,
      [](Source* s, double v) { s->SetSink(v); });
  }
  return [settings](const GeneratorRequest& request)
  {
    vtkNew<Source> source;
    source->SetKind(Kind);
    settings.apply(source);
    return run_field(source.Get(), request);
  };
}

}

std::vector<Generator> cloud_generators()
{
  using Cloud = vtkBrumeCloudSource;
  using Fog = vtkBrumeFogSource;
  return {
    { "cumulus",
      "a cumulus of 2 km with its flat base, density from 0 to 1",
      256,
      Moves::Yes,
      declare_cloud<Cloud::KindCumulus> },
    { "cumulus-field",
      "cumuli of all sizes over 6 km, density from 0 to 1",
      256,
      Moves::Yes,
      declare_cloud<Cloud::KindCumulusField> },
    { "stratus",
      "a grey sheet of cloud over 6 km, density from 0 to 1",
      256,
      Moves::Yes,
      declare_cloud<Cloud::KindStratus> },
    { "stratocumulus",
      "a layer of cells with gaps over 8 km, density from 0 to 1",
      256,
      Moves::Yes,
      declare_cloud<Cloud::KindStratocumulus> },
    { "cirrus",
      "streaks of ice over 12 km, density from 0 to 1",
      256,
      Moves::Yes,
      declare_cloud<Cloud::KindCirrus> },
    { "cumulonimbus",
      "a tower with an anvil over 20 km, density from 0 to 1",
      256,
      Moves::Yes,
      declare_cloud<Cloud::KindCumulonimbus> },
    { "even-fog",
      "a box of 4 km full of even fog, density 1",
      64,
      Moves::No,
      declare_fog<Fog::KindHomogeneous>,
      0.0,
      false },
    { "height-fog",
      "fog in swathes that thins with the height, density from 0 to 1",
      256,
      Moves::Yes,
      declare_fog<Fog::KindHeight> },
    { "valley-fog",
      "fog in the hollows of hills over 4 km, density from 0 to 1",
      256,
      Moves::Yes,
      declare_fog<Fog::KindValley> },
  };
}

}
