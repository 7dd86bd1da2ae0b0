// A made-up comparison for the tests of what is written from one: a soft ball, drawn by mappers
// whose errors are known by construction.
#pragma once

#include "Analysis/comparison.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sample
{

inline brume::Picture ball(int width, int height)
{
  brume::Picture picture{ width, height, {} };
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x)
    {
      const double u = (2.0 * x + 1.0 - width) / height;
      const double v = (2.0 * y + 1.0 - height) / height;
      const double r = std::hypot(u, v) + 0.06 * std::sin(9 * u) * std::cos(7 * v);
      const double density = std::max(0.0, 1.0 - r * r / 0.7);
      const double opacity = 1.0 - std::exp(-3.0 * density);
      const double light = 0.55 + 0.35 * (u * -0.5 + v * 0.8);
      picture.rgb.push_back(static_cast<float>(opacity * light * 1.1));
      picture.rgb.push_back(static_cast<float>(opacity * light * (0.75 + 0.2 * density)));
      picture.rgb.push_back(static_cast<float>(opacity * light * (0.5 + 0.4 * density)));
    }
  }
  return picture;
}

/// The picture with a reproducible disturbance of about `amount`, where there is something.
inline brume::Picture disturbed(brume::Picture picture, double amount, double shift)
{
  std::uint32_t state = 12345;
  for (float& value : picture.rgb)
  {
    state = state * 1664525u + 1013904223u;
    const double noise = (state >> 8) / 8388608.0 - 1.0;
    value += static_cast<float>((noise * amount + shift) * (value > 0.001f ? value : 0.f));
  }
  return picture;
}

inline brume::ComparisonEntry entry(const std::string& mapper, const std::string& title,
  const std::string& class_name, const brume::Picture& picture, const brume::Picture& truth,
  double median)
{
  brume::ComparisonEntry entry;
  entry.mapper = mapper;
  entry.title = title;
  entry.class_name = class_name;
  entry.picture = picture;
  entry.timing = { median, 0.97 * median, 1.06 * median, 5, 1.3 * median, 0.4 * median };
  entry.against_truth = brume::measure(picture, truth);
  return entry;
}

inline brume::Comparison comparison(int width, int height)
{
  brume::Comparison c;
  const brume::Picture truth = ball(width, height);
  c.scene.input = "sample:head-ct";
  c.scene.dimensions = { 256, 256, 160 };
  c.scene.spacing = { 0.8, 0.8, 1.25 };
  c.scene.unit = "mm";
  c.scene.preset = "ct-soft-tissue";
  c.scene.width = width;
  c.scene.height = height;
  c.scene.step = 0.4;
  c.scene.step_voxels = 0.5;
  c.scene.opacity_unit_distance = 1.0;
  c.scene.camera = { { 0, -420, 60 }, { 0, 0, 0 }, { 0, 0, 1 }, 30.0, false, 1.0 };
  c.scene.lights = { "headlight, white, intensity 1" };
  c.scene.interpolation = "linear";
  c.scene.matched = { { "sample distance", "0.4 mm (0.5 voxels)", "all mappers" },
    { "automatic sample distances", "off", "stock mappers" },
    { "image sample distance", "1", "vtk-fixed-point, vtk-gpu" },
    { "threads", "2", "CPU mappers" } };

  brume::ComparisonEntry brume = entry("raymarch", "Brume ray march", "vtkBrumeRayMarchMapper",
    disturbed(truth, 0.004, 0.0005), truth, 0.0812);
  brume.contributions = {
    { "float arithmetic", "the same rays in float instead of double",
      brume::measure(disturbed(truth, 0.0002, 0.0), truth) },
    { "step", "the step halved until nothing changes, everything else kept",
      brume::measure(disturbed(truth, 0.0036, 0.0004), truth) },
  };
  brume.statistics = R"({"mapper": "raymarch", "seconds": 0.0812, "samples": 41234567,
    "rays": 262144, "threads": 2, "simd": "AVX2", "radiometric": true, "non_finite_voxels": 0,
    "effects": [
      {"name": "emission and absorption", "on": true, "reason": "asked for by the transfer functions", "error_bound": 0},
      {"name": "shading", "on": false, "reason": "the property turns it off", "error_bound": 0},
      {"name": "multiple scattering", "on": false, "reason": "no medium: the property holds no albedo", "error_bound": 0.00012}
    ]})";
  brume::ComparisonEntry stock = entry("vtk-fixed-point", "VTK fixed point",
    "vtkFixedPointVolumeRayCastMapper", disturbed(truth, 0.012, -0.006), truth, 0.154);
  stock.contributions = {
    { "step", "the same step in double precision", brume::measure(disturbed(truth, 0.0036, 0.0004), truth) },
    { "ray start", "rays begin a fraction of a step later",
      brume::measure(disturbed(truth, 0.005, 0.0), truth) },
    { "fixed point and 8-bit tables", "what is left when the others are taken away",
      brume::measure(disturbed(truth, 0.008, -0.006), truth) },
  };
  brume::ComparisonEntry gpu = entry("vtk-gpu", "VTK GPU (llvmpipe)",
    "vtkOpenGLGPUVolumeRayCastMapper", disturbed(truth, 0.03, 0.01), truth, 0.43);
  brume.against_reference = brume::measure(brume.picture, stock.picture);
  gpu.against_reference = brume::measure(gpu.picture, stock.picture);
  c.entries = { brume, stock, gpu };

  c.truth = { "Double-precision quadrature of every ray, two Gauss-Legendre points a cell, "
              "refined until two levels agree.",
    3, 0.0000031, 0.00011, 41.2, truth };
  c.machine = { "Intel Xeon (Sapphire Rapids), 2 cores", 2, "AVX2", "Debian GNU/Linux 12", "0.1.0",
    "9.1.0" };
  c.command_line = "brume compare sample:head-ct --output head --resolution 512,512";
  c.date = "2024-05-01 12:00 UTC";
  return c;
}

}
