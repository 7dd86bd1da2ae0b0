// Pictures that must not change by themselves. Each is compared in linear float with its baseline
// below tests/baselines; BRUME_UPDATE_BASELINES=1 in the environment writes the baselines anew
// (look at them, and say in the commit why they changed).
#include "../support/vtk_scenes.h"

#include "vtkBrumeRayMarchMapper.h"

#include "film_io.h"

#include "vtkMatrix3x3.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <string>

using namespace vtk_scenes;
using brume::Film;

namespace
{

constexpr int size = 96;

/// Above what another SIMD target or compiler changes (1e-4, shaded), a tenth of what a 5 % change
/// of extinction does at the least.
constexpr float pixel_threshold = 5e-4f;
constexpr double mean_threshold = 2e-5;

OIIO::ImageBuf buffer(const Film& film)
{
  OIIO::ImageBuf buf(OIIO::ImageSpec(film.width, film.height, 6, OIIO::TypeDesc::FLOAT));
  for (int y = 0; y < film.height; ++y)
    for (int x = 0; x < film.width; ++x)
    {
      const std::size_t i = std::size_t(y) * film.width + x;
      const float pixel[6] = { film.radiance[0][i], film.radiance[1][i], film.radiance[2][i],
        film.transmittance[0][i], film.transmittance[1][i], film.transmittance[2][i] };
      buf.setpixel(x, y, pixel);
    }
  return buf;
}

OIIO::ImageBufAlgo::CompareResults compare(const Film& a, const Film& b)
{
  return OIIO::ImageBufAlgo::compare(buffer(a), buffer(b), pixel_threshold, pixel_threshold);
}

struct Picture
{
  const char* name;
  int type = VTK_UNSIGNED_CHAR;
  bool cells = false;
  bool shade = false;
  bool gradient = false;
  bool parallel = false;
  bool rgba = false;
};

/// `extinction` scales it, through the unit distance.
Film draw(const Picture& p, double extinction = 1.0)
{
  auto data = p.rgba ? image(
                         24, 22, 26, VTK_UNSIGNED_CHAR,
                         [](int i, int j, int k, int c)
                         {
                           return c == 3 ? ball(i / 11.5 - 1, j / 10.5 - 1, k / 12.5 - 1)
                                         : 128 + 120 * std::sin(0.3 * (c == 0 ? i : c == 1 ? j : k));
                         },
                         4)
                     : ball_image(p.type, 28, p.cells);
  data->SetSpacing(1.0, 1.2, 0.9);
  auto volume = volume_of(0.35);
  vtkVolumeProperty* property = volume->GetProperty();
  property->SetScalarOpacityUnitDistance(2.0 / extinction);
  property->SetIndependentComponents(!p.rgba);
  property->SetShade(p.shade);
  property->SetSpecular(0.3);
  property->SetSpecularPower(15);
  if (p.gradient)
  {
    vtkNew<vtkPiecewiseFunction> gradient;
    gradient->AddPoint(0, 0.1);
    gradient->AddPoint(15, 1.0);
    property->SetGradientOpacity(gradient);
  }
  volume->RotateX(20);
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  mapper->SetInputData(data);
  mapper->SetAutoAdjustSampleDistances(0);
  mapper->SetSampleDistance(0.5);
  volume->SetMapper(mapper);
  vtkNew<vtkCamera> camera;
  look_at(camera, volume->GetCenter(), 75.0);
  camera->SetParallelProjection(p.parallel);
  camera->SetParallelScale(20.0);
  vtkBrumeVolumeMapper::ResetClippingRange(volume, camera);
  Film film(size, size);
  EXPECT_TRUE(mapper->RenderFilm(volume, camera, nullptr, film));
  return film;
}

class Baseline : public testing::TestWithParam<Picture>
{
};

TEST_P(Baseline, IsUnchanged)
{
  const std::string path = std::string(BRUME_TEST_BASELINES) + "/" + GetParam().name + ".exr";
  const Film film = draw(GetParam());
  if (std::getenv("BRUME_UPDATE_BASELINES"))
  {
    brume::write_exr(film, path);
    std::cout << "wrote " << path << "\n";
  }
  const Film baseline = brume::read_exr(path);
  ASSERT_EQ(baseline.width, film.width);
  ASSERT_EQ(baseline.height, film.height);
  const auto results = compare(film, baseline);
  EXPECT_EQ(results.nfail, 0u) << "worst " << results.maxerror << " at " << results.maxx << ", "
                               << results.maxy;
  EXPECT_LE(results.meanerror, mean_threshold);
  if (results.nfail > 0)
  {
    brume::write_exr(film, std::string(BRUME_TEST_OUTPUT) + "/" + GetParam().name + ".exr");
  }
}

// The thresholds can fail: 5 % more extinction is not the same picture.
TEST_P(Baseline, ShowsFivePercentMoreExtinction)
{
  const auto results = compare(draw(GetParam(), 1.05), draw(GetParam()));
  EXPECT_GT(results.nfail, 100u);
  EXPECT_GT(results.meanerror, 10 * mean_threshold);
}

INSTANTIATE_TEST_SUITE_P(Pictures, Baseline,
  testing::Values(Picture{ "ball" }, Picture{ "ball-cells-parallel", VTK_SHORT, true, false, false, true },
    Picture{ "ball-shaded", VTK_FLOAT, false, true }, Picture{ "ball-gradient", VTK_UNSIGNED_SHORT, false, false, true },
    Picture{ "ball-rgba", VTK_UNSIGNED_CHAR, false, false, false, false, true }),
  [](const testing::TestParamInfo<Picture>& info)
  {
    std::string name = info.param.name;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
  });

}
