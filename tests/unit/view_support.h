// Scenes and pictures for the tests of `brume view`.
#pragma once

#include "command.h"
#include "scene_file.h"
#include "volume_scene.h"

#include "view/viewer.h"

#include "vtkBrumeRayMarchMapper.h"

#include "vtkCamera.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkVolume.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

using namespace brume::app;
using nlohmann::ordered_json;

inline bool overlap(const Box& a, const Box& b)
{
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

/// A ball of 24³ voxels in a file, brighter toward +x.
inline std::string ball_file()
{
  static const std::string path = BRUME_TEST_OUTPUT "/view-ball.nrrd";
  std::ofstream file(path, std::ios::binary);
  file << "NRRD0004\ntype: float\ndimension: 3\nsizes: 24 24 24\nspacings: 1 1 1\n"
          "endian: little\nencoding: raw\n\n";
  for (int k = 0; k < 24; ++k)
    for (int j = 0; j < 24; ++j)
      for (int i = 0; i < 24; ++i)
      {
        const double r = std::hypot(i - 11.5, j - 11.5, k - 11.5);
        const float v = r < 10.0 ? 100.0f + 5.0f * static_cast<float>(i) : 0.0f;
        file.write(reinterpret_cast<const char*>(&v), sizeof v);
      }
  return path;
}

inline ordered_json ball_scene()
{
  return { { "input", ball_file() }, { "quiet", true }, { "preset", "grey" } };
}

inline Viewer::Settings settings_of(std::vector<MapperKind> mappers)
{
  Viewer::Settings settings;
  settings.mappers = std::move(mappers);
  return settings;
}

inline const KeepGoing go_on = [](double) { return true; };

inline void finish(Viewer& viewer)
{
  viewer.draft(go_on);
  while (!viewer.finished())
  {
    ASSERT_TRUE(viewer.refine(go_on));
  }
}

/// The largest difference of two pictures of one size.
inline double difference(const brume::Picture& a, const brume::Picture& b)
{
  EXPECT_EQ(a.rgb.size(), b.rgb.size());
  double most = 0.0;
  for (std::size_t i = 0; i < std::min(a.rgb.size(), b.rgb.size()); ++i)
  {
    most = std::max(most, double(std::abs(a.rgb[i] - b.rgb[i])));
  }
  return most;
}

/// What `brume render` draws of a scene.
inline brume::Picture rendered(const ordered_json& scene)
{
  const ParsedScene parsed(scene);
  const VolumeScene volume = make_volume_scene(parsed.options());
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  set_up(volume, mapper);
  brume::Film film(volume.width(), volume.height());
  EXPECT_TRUE(mapper->RenderFilm(volume.volume, volume.camera, volume.lights, film));
  return { film.width, film.height, over_background(film, volume.options.background.data()) };
}
