// A made-up study for the tests of what is written from one: three steps, one octave and a stock mapper,
// whose errors are known by construction.
#pragma once

#include "Analysis/study.h"

#include <algorithm>
#include <cmath>

namespace sample
{

/// A picture of 30 × 30 pixels of 0.5, in thirds of optical depths 0.2, 1 and 5 from left to right.
inline brume::Picture plain_truth()
{
  return { 30, 30, std::vector<float>(3 * 30 * 30, 0.5f) };
}

inline brume::StudyPoint point(const std::string& knob,
  const std::string& setting,
  double seconds,
  const brume::Picture& picture,
  const std::string& settings = "{}")
{
  brume::StudyPoint p;
  p.knob = knob;
  p.setting = setting;
  p.settings = settings;
  p.mapper = "raymarch";
  p.timing = { seconds, 0.9 * seconds, 1.2 * seconds, 3, seconds, 0.1 };
  p.picture = picture;
  return p;
}

/// The truth with an error of this size everywhere.
inline brume::Picture off_by(double error)
{
  brume::Picture picture = plain_truth();
  for (float& value : picture.rgb)
  {
    value += static_cast<float>(error);
  }
  return picture;
}

inline brume::Study study()
{
  brume::Study s;
  s.scene.input = "sample:cloud";
  s.scene.width = s.scene.height = 30;
  s.truth.kind = "quadrature";
  s.truth.truth.method = "Double-precision quadrature.";
  s.truth.truth.remaining_mean = 1e-6;
  s.truth.truth.remaining_largest = 1e-5;
  s.truth.truth.picture = plain_truth();
  s.truth.noise.rms = s.truth.noise.mean = 1e-6;
  s.truth.noise.percentile_999 = s.truth.noise.largest = 1e-5;
  std::vector<float> transmittance;
  brume::Picture half_in_cores = plain_truth();
  for (int y = 0; y < 30; ++y)
  {
    for (int x = 0; x < 30; ++x)
    {
      const double depth = x < 10 ? 0.2 : x < 20 ? 1.0 : 5.0;
      transmittance.push_back(static_cast<float>(std::exp(-depth)));
      for (int c = 0; c < 3 && x >= 20; ++c)
      {
        half_in_cores.rgb[3 * (30 * y + x) + c] = 0.25f;
      }
    }
  }
  const std::vector<float> film[3] = { transmittance, transmittance, transmittance };
  s.depths = brume::classes_by_depth(film, s.truth.truth.picture);
  s.outlines = brume::classes_by_outline(film, s.truth.truth.picture);
  s.knobs = { { "step", "step", "The length of steps.", "" }, { "octaves", "octaves", "", "" },
    { "stock", "VTK", "", "" } };
  s.points = { point("step", "4 voxels", 0.1, off_by(0.04), R"({"step_in_voxels": 4})"),
    point("step", "1 voxel", 0.3, off_by(0.01)), point("step", "1/4 voxel", 1.2, off_by(0.001)),
    point("octaves", "1", 0.5, half_in_cores), point("stock", "CPU 1 voxel", 0.6, off_by(0.02)) };
  s.points[2].finest = true;
  s.points[4].mapper = "vtk-fixed-point";
  s.points[4].stock = true;
  s.machine = { "Some processor", 2, "AVX2", "Some system", "0.1.0", "9.1.0" };
  s.command_line = "brume cost sample:cloud --output cost";
  s.date = "2024-05-01 12:00 UTC";
  for (brume::StudyPoint& p : s.points)
  {
    brume::measure_point(p, s);
  }
  brume::finish(s);
  return s;
}

}
