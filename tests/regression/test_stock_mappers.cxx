// The drop-in: the same volume, property, lights and camera drawn by VTK's own mappers, live, at
// steps of half a voxel. Errors are in levels of an 8-bit screen (1/255).
//
// vtkFixedPointVolumeRayCastMapper is read from its ray-cast image, before its display quad, which
// resamples it by up to half a pixel; it computes in 15 bits and counts whole steps from the near
// plane, so that a ray's first and last steps reach out of the volume by up to a step.
#include "../support/vtk_scenes.h"

#include "vtkBrumeRayMarchMapper.h"

#include "Transport/reference.h"

#include <glm/ext/matrix_transform.hpp>

#include "vtkFixedPointRayCastImage.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkOpenGLGPUVolumeRayCastMapper.h"
#include "vtkLight.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <iostream>
#include <string>
#include <vector>

using namespace vtk_scenes;
using brume::Film;

namespace
{

constexpr int size = 120;

struct Case
{
  const char* name;
  vtkSmartPointer<vtkImageData> image;
  bool nearest = false;
  bool shade = false;
  bool gradient = false;
  bool parallel = false;
  double opacity = 0.3;
  double mean = 0.2;  ///< levels, fixed point: twice what was measured, as all of these
  double p999 = 2.5;
  double gpu_mean = 0.2; ///< levels, GPU
  double gpu_p999 = 3.0;
};

struct Errors
{
  double mean = 0.0;
  double p999 = 0.0;
};

/// Of red, green and blue over black.
Errors errors_of(const std::vector<double>& a, const std::vector<double>& b)
{
  std::vector<double> all;
  Errors result;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    all.push_back(255.0 * std::abs(a[i] - b[i]));
    result.mean += all.back() / a.size();
  }
  std::sort(all.begin(), all.end());
  result.p999 = all[std::size_t(0.999 * (all.size() - 1))];
  return result;
}

struct Window
{
  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  vtkSmartPointer<vtkVolume> volume;

  explicit Window(const Case& c)
    : volume(volume_of(c.opacity))
  {
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetSize(size, size);
    window->AddRenderer(renderer);
    vtkVolumeProperty* property = volume->GetProperty();
    if (c.nearest)
    {
      property->SetInterpolationTypeToNearest();
    }
    if (c.shade)
    {
      property->ShadeOn();
      property->SetAmbient(0.2);
      property->SetDiffuse(0.7);
      property->SetSpecular(0.3);

      property->SetSpecularPower(12.0);
      // VTK's lights have no ambient light by themselves: its GPU mapper then takes white, as Brume
      // does, and its CPU mapper none. Say it, and all agree.
      vtkNew<vtkLight> light;
      light->SetLightTypeToHeadlight();
      light->SetAmbientColor(1, 1, 1);
      renderer->AddLight(light);
    }
    if (c.gradient)
    {
      vtkNew<vtkPiecewiseFunction> gradient;
      gradient->AddPoint(0, 0.0);
      gradient->AddPoint(12, 1.0);
      property->SetGradientOpacity(gradient);
    }
    vtkCamera* camera = renderer->GetActiveCamera();
    const double centre[3] = { 15.5, 14.0, 16.5 };
    look_at(camera, centre, 90.0);
    camera->SetParallelProjection(c.parallel);
    camera->SetParallelScale(22.0);
  }
  void render(vtkVolumeMapper* mapper, const Case& c)
  {
    mapper->SetInputData(c.image);
    volume->SetMapper(mapper);
    renderer->AddVolume(volume);
    renderer->ResetCameraClippingRange();
    window->Render();
  }
};

std::vector<double> brume_picture(const Case& c)
{
  Window w(c);
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  mapper->SetAutoAdjustSampleDistances(0);
  mapper->SetSampleDistance(0.5);
  w.render(mapper, c);
  Film film(size, size);
  EXPECT_TRUE(mapper->RenderFilm(
    w.volume, w.renderer->GetActiveCamera(), w.renderer->GetLights(), film));
  std::vector<double> picture;
  for (std::size_t i = 0; i < film.size(); ++i)
    for (int ch = 0; ch < 3; ++ch)
      picture.push_back(film.radiance[ch][i]);
  return picture;
}

/// What double precision makes of the samples that vtkFixedPointVolumeRayCastMapper takes.
std::vector<double> from_near_plane(const Case& c)
{
  Window w(c);
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  w.render(mapper, c);
  Film film(size, size);
  const brume::Scene* scene = mapper->UpdateScene(
    w.volume, w.renderer->GetActiveCamera(), w.renderer->GetLights(), size, size);
  brume::Scene moved = *scene;
  if (c.nearest)
  {
    // It takes the voxel before a place, not the nearest: the picture is half a voxel off.
    moved.volumes[0].data_from_index =
      moved.volumes[0].data_from_index * glm::translate(glm::dmat4(1.0), glm::dvec3(0.5));
  }
  brume::render_fixed_step(
    moved, 0.5, brume::SamplePlacement::FromNearPlane, 0.0, 0, film);
  std::vector<double> picture;
  for (std::size_t i = 0; i < film.size(); ++i)
    for (int ch = 0; ch < 3; ++ch)
      picture.push_back(film.radiance[ch][i]);
  return picture;
}

std::vector<double> fixed_point_picture(const Case& c)
{
  Window w(c);
  vtkNew<vtkFixedPointVolumeRayCastMapper> mapper;
  mapper->SetAutoAdjustSampleDistances(0);
  mapper->SetSampleDistance(0.5);
  mapper->SetImageSampleDistance(1.0);
  w.render(mapper, c);
  vtkFixedPointRayCastImage* image = mapper->GetRayCastImage();
  int memory[2], used[2], origin[2];
  image->GetImageMemorySize(memory);
  image->GetImageInUseSize(used);
  image->GetImageOrigin(origin);
  std::vector<double> picture(3 * size * size, 0.0);
  for (int y = 0; y < used[1]; ++y)
    for (int x = 0; x < used[0]; ++x)
      for (int ch = 0; ch < 3; ++ch)
        picture[3 * ((y + origin[1]) * size + x + origin[0]) + ch] =
          image->GetImage()[4 * (y * memory[0] + x) + ch] / 32767.0;
  return picture;
}

std::vector<double> gpu_picture(const Case& c)
{
  Window w(c);
  vtkNew<vtkOpenGLGPUVolumeRayCastMapper> mapper;
  mapper->SetAutoAdjustSampleDistances(0);
  mapper->SetSampleDistance(0.5);
  mapper->UseJitteringOff();
  w.render(mapper, c);
  vtkNew<vtkUnsignedCharArray> pixels;
  w.window->GetPixelData(0, 0, size - 1, size - 1, 0, pixels);
  std::vector<double> picture;
  for (vtkIdType i = 0; i < pixels->GetNumberOfValues(); ++i)
    picture.push_back(pixels->GetValue(i) / 255.0);
  return picture;
}

std::vector<Case> cases()
{
  std::vector<Case> all;
  const auto add = [&](const char* name, int type) -> Case&
  {
    all.push_back(Case());
    all.back().name = name;
    all.back().image = ball_image(type);
    return all.back();
  };
  add("uint8", VTK_UNSIGNED_CHAR);
  add("uint16", VTK_UNSIGNED_SHORT);
  add("float", VTK_FLOAT);
  add("parallel", VTK_UNSIGNED_CHAR).parallel = true;
  Case& opaque = add("opaque", VTK_UNSIGNED_CHAR);
  opaque.opacity = 0.99;
  opaque.mean = 0.3; // 15 bits of opacity a step: many steps of high opacity add up their rounding
  opaque.p999 = 5.0;
  Case& nearest = add("nearest", VTK_UNSIGNED_CHAR);
  nearest.nearest = true;
  nearest.gpu_mean = 0.35; // the border of a voxel is a jump: half a step of it is another colour
  nearest.gpu_p999 = 9.0;
  Case& gradient = add("gradient opacity", VTK_UNSIGNED_CHAR);
  gradient.gradient = true;
  gradient.gpu_p999 = 5.0; // its gradients are differences of the interpolated field
  Case& shaded = add("shaded", VTK_UNSIGNED_CHAR);
  shaded.shade = true;
  shaded.mean = 0.4; // shades at voxels, with normals of 8 bits of direction, and interpolates that
  shaded.p999 = 26.0;
  shaded.gpu_mean = 0.45; // as for gradient opacity, and normals turn fast where the ball is flat
  shaded.gpu_p999 = 18.0;
  return all;
}

TEST(DropIn, DrawsWhatFixedPointDraws)
{
  for (const Case& c : cases())
  {
    SCOPED_TRACE(c.name);
    // With nearest voxels it is half a voxel off, so that only its own samples can be compared.
    const std::vector<double> stock = fixed_point_picture(c);
    const Errors e = errors_of(c.nearest ? from_near_plane(c) : brume_picture(c), stock);
    std::cout << c.name << ": mean " << e.mean << ", p99.9 " << e.p999 << " of 255\n";
    EXPECT_LE(e.mean, c.mean);
    EXPECT_LE(e.p999, c.p999);
    const Errors same_samples = errors_of(from_near_plane(c), stock);
    EXPECT_LE(same_samples.mean, c.mean);
    EXPECT_LE(same_samples.p999, c.p999);
  }
}

TEST(DropIn, DrawsWhatTheGPUDraws)
{
  for (const Case& c : cases())
  {
    SCOPED_TRACE(c.name);
    const Errors e = errors_of(brume_picture(c), gpu_picture(c));
    std::cout << c.name << ": mean " << e.mean << ", p99.9 " << e.p999 << " of 255\n";
    EXPECT_LE(e.mean, c.gpu_mean);
    EXPECT_LE(e.p999, c.gpu_p999);
  }
}

}
