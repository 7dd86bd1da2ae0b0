// The same volume drawn by Brume and by VTK's own mappers, in levels of an 8-bit screen.
#pragma once

#include "vtk_scenes.h"

#include "vtkBrumeRayMarchMapper.h"

#include "Transport/reference.h"

#include "vtkFixedPointRayCastImage.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkLight.h"
#include "vtkOpenGLGPUVolumeRayCastMapper.h"
#include "vtkPNGWriter.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

namespace stock_pictures
{

inline int size = 120; ///< pixels of a picture's edge; set before the first picture

/// A scene that every mapper is to draw alike.
struct Scene
{
  std::string name;
  vtkSmartPointer<vtkImageData> image;
  double step = 0.5;
  std::function<void(vtkVolume*)> volume = [](vtkVolume*) {};
  std::function<void(vtkVolumeMapper*)> mapper = [](vtkVolumeMapper*) {};
  std::function<void(vtkCamera*)> camera = [](vtkCamera* camera)
  {
    const double centre[3] = { 15.5, 14.0, 16.5 }; // of ball_image
    vtk_scenes::look_at(camera, centre, 90.0);
  };
  vtkSmartPointer<vtkImageData> mask; ///< of Brume and the GPU mapper
  bool binary = false;
  float blend = 1.0f;
};

/// Red, green and blue from the bottom left, 1 for white, over black.
using Picture = std::vector<double>;

struct Window
{
  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  vtkSmartPointer<vtkVolume> volume = vtk_scenes::volume_of(0.3);

  explicit Window(const Scene& scene)
  {
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetSize(size, size);
    window->AddRenderer(renderer);
    // VTK's lights have no ambient light by themselves: its GPU mapper then takes white, as Brume
    // does, and its CPU mapper none. Say it, and all agree.
    vtkNew<vtkLight> light;
    light->SetLightTypeToHeadlight();
    light->SetAmbientColor(1, 1, 1);
    renderer->AddLight(light);
    scene.camera(renderer->GetActiveCamera());
    scene.volume(volume);
  }
  void render(vtkVolumeMapper* mapper, const Scene& scene)
  {
    mapper->SetInputData(scene.image);
    scene.mapper(mapper);
    volume->SetMapper(mapper);
    renderer->AddVolume(volume);
    renderer->ResetCameraClippingRange();
    window->Render();
  }
};

inline Picture of_film(const brume::Film& film)
{
  Picture picture;
  for (std::size_t i = 0; i < film.size(); ++i)
    for (int c = 0; c < 3; ++c)
      picture.push_back(film.radiance[c][i]);
  return picture;
}

inline void set_up(vtkBrumeRayMarchMapper* mapper, const Scene& scene)
{
  mapper->SetAutoAdjustSampleDistances(0);
  mapper->SetSampleDistance(scene.step);
  mapper->SetMaskInput(scene.mask);
  mapper->SetMaskBlendFactor(scene.blend);
  scene.binary ? mapper->SetMaskTypeToBinary() : mapper->SetMaskTypeToLabelMap();
}

inline Picture brume_picture(const Scene& scene)
{
  Window w(scene);
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  set_up(mapper, scene);
  w.render(mapper, scene);
  brume::Film film(size, size);
  EXPECT_TRUE(
    mapper->RenderFilm(w.volume, w.renderer->GetActiveCamera(), w.renderer->GetLights(), film));
  return of_film(film);
}

/// The scene in double precision: what Brume's mapper is measured against.
inline Picture reference_picture(const Scene& scene)
{
  Window w(scene);
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  set_up(mapper, scene);
  scene.mapper(mapper);
  mapper->SetInputData(scene.image);
  w.volume->SetMapper(mapper);
  w.renderer->AddVolume(w.volume);
  w.renderer->ResetCameraClippingRange();
  const brume::Scene* plain = mapper->UpdateScene(
    w.volume, w.renderer->GetActiveCamera(), w.renderer->GetLights(), size, size);
  EXPECT_NE(plain, nullptr);
  brume::Film film(size, size);
  brume::render_reference(*plain, brume::ReferenceSettings(), film);
  return of_film(film);
}

/// Read from its ray-cast image, before its display quad, which resamples it by up to half a pixel.
inline Picture fixed_point_picture(const Scene& scene)
{
  Window w(scene);
  vtkNew<vtkFixedPointVolumeRayCastMapper> mapper;
  mapper->SetAutoAdjustSampleDistances(0);
  mapper->SetSampleDistance(static_cast<float>(scene.step));
  mapper->SetImageSampleDistance(1.0);
  w.render(mapper, scene);
  vtkFixedPointRayCastImage* image = mapper->GetRayCastImage();
  int memory[2], used[2], origin[2];
  image->GetImageMemorySize(memory);
  image->GetImageInUseSize(used);
  image->GetImageOrigin(origin);
  Picture picture(3 * size * size, 0.0);
  for (int y = 0; y < used[1]; ++y)
    for (int x = 0; x < used[0]; ++x)
      for (int ch = 0; ch < 3; ++ch)
        picture[3 * ((y + origin[1]) * size + x + origin[0]) + ch] =
          image->GetImage()[4 * (y * memory[0] + x) + ch] / 32767.0;
  return picture;
}

inline Picture gpu_picture(const Scene& scene)
{
  Window w(scene);
  vtkNew<vtkOpenGLGPUVolumeRayCastMapper> mapper;
  mapper->SetAutoAdjustSampleDistances(0);
  mapper->SetSampleDistance(static_cast<float>(scene.step));
  mapper->UseJitteringOff();
  mapper->SetMaskInput(scene.mask);
  mapper->SetMaskBlendFactor(scene.blend);
  scene.binary ? mapper->SetMaskTypeToBinary() : mapper->SetMaskTypeToLabelMap();
  w.render(mapper, scene);
  vtkNew<vtkUnsignedCharArray> pixels;
  w.window->GetPixelData(0, 0, size - 1, size - 1, 0, pixels);
  Picture picture;
  for (vtkIdType i = 0; i < pixels->GetNumberOfValues(); ++i)
    picture.push_back(pixels->GetValue(i) / 255.0);
  return picture;
}

struct Errors
{
  double mean = 0.0;
  double p99 = 0.0;
  double p999 = 0.0;
};

/// In levels, over the channels of all pixels.
inline Errors errors_of(const Picture& a, const Picture& b)
{
  std::vector<double> all;
  Errors result;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    all.push_back(255.0 * std::abs(std::min(a[i], 1.0) - std::min(b[i], 1.0)));
    result.mean += all.back() / a.size();
  }
  std::sort(all.begin(), all.end());
  result.p99 = all[std::size_t(0.99 * (all.size() - 1))];
  result.p999 = all[std::size_t(0.999 * (all.size() - 1))];
  return result;
}

inline double brightest(const Picture& picture)
{
  return *std::max_element(picture.begin(), picture.end());
}

/// Pictures side by side in FOLDER/NAME.png, where BRUME_KEEP_PICTURES names a folder.
inline void keep(const std::string& name, const std::vector<Picture>& pictures)
{
  const char* folder = std::getenv("BRUME_KEEP_PICTURES");
  if (!folder)
  {
    return;
  }
  vtkNew<vtkImageData> image;
  const int count = static_cast<int>(pictures.size());
  image->SetDimensions(count * size, size, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  for (int n = 0; n < count; ++n)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        for (int c = 0; c < 3; ++c)
          static_cast<unsigned char*>(image->GetScalarPointer(n * size + x, y, 0))[c] =
            static_cast<unsigned char>(
              std::lround(255.0 * std::clamp(pictures[n][3 * (y * size + x) + c], 0.0, 1.0)));
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName((std::string(folder) + "/" + name + ".png").c_str());
  writer->SetInputData(image);
  writer->Write();
}

}
