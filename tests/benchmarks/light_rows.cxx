// Light in a medium: against emission and absorption, and against OpenVDB's vdb_render.
#include "rows.h"

#include "vdb_peer.h"

#include "vtkBrumeMedium.h"
#include "vtkBrumeRayMarchMapper.h"

#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkImageData.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

namespace benchmarks
{

namespace
{

constexpr double cloud_extinction = 12.0; ///< per unit; the cloud's cube is 2 wide

/// A cloud of noise, 256³ floats in [0, 1], under a sun.
struct LitCloud
{
  vtkSmartPointer<vtkImageData> image;
  vtkNew<vtkVolume> volume;
  vtkNew<vtkCamera> camera;
  vtkNew<vtkLightCollection> lights;
  vtkNew<vtkLight> sun;
  vtkNew<vtkBrumeMedium> medium;
  vtkNew<vtkBrumeRayMarchMapper> plain; ///< the same extinction by a transfer function
  vtkNew<vtkBrumeRayMarchMapper> lit;
  brume::Film film;
  int frames = 0;

  LitCloud(const Options& options, const SceneOfCloud& cloud)
    : image(cloud.image)
    , film(options.resolution, options.resolution)
  {
    cloud.aim(this->camera);
    this->sun->SetLightTypeToSceneLight();
    this->sun->SetPosition(1.0, -0.4, 0.6);
    this->sun->SetFocalPoint(0.0, 0.0, 0.0);
    this->lights->AddItem(this->sun);
    this->medium->SetExtinction(cloud_extinction);
    vtkNew<vtkPiecewiseFunction> opacity;
    vtkNew<vtkColorTransferFunction> colour;
    for (int i = 0; i <= 256; ++i)
    {
      opacity->AddPoint(i / 256.0, -std::expm1(-cloud_extinction * i / 256.0));
    }
    colour->AddRGBPoint(0.0, 0.5, 0.5, 0.6);
    colour->AddRGBPoint(1.0, 1.0, 1.0, 1.0);
    this->volume->GetProperty()->SetScalarOpacity(opacity);
    this->volume->GetProperty()->SetColor(colour);
    this->volume->GetProperty()->SetScalarOpacityUnitDistance(1.0);
    this->volume->GetProperty()->SetInterpolationTypeToLinear();
    for (vtkBrumeRayMarchMapper* mapper : { this->plain.Get(), this->lit.Get() })
    {
      mapper->SetInputData(this->image);
      mapper->SetNumberOfThreads(options.threads);
    }
    this->lit->SetMedium(this->medium);
  }

  void fix_step(double step)
  {
    for (vtkBrumeRayMarchMapper* mapper : { this->plain.Get(), this->lit.Get() })
    {
      mapper->AutoAdjustSampleDistancesOff();
      mapper->SetSampleDistance(step);
    }
  }

  /// Seconds of a frame, all that is made for it included; the camera moves a little every time.
  double draw(vtkBrumeRayMarchMapper* mapper)
  {
    this->camera->Azimuth(0.05 * (++this->frames % 2 ? 1 : -1));
    this->volume->SetMapper(mapper);
    if (!mapper->RenderFilm(this->volume, this->camera, this->lights, this->film))
    {
      throw std::runtime_error("the cloud could not be drawn");
    }
    this->statistics = nlohmann::json::parse(mapper->GetStatistics());
    return this->statistics["seconds"].get<double>() +
      this->statistics["seconds_prepare"].get<double>();
  }

  nlohmann::json statistics;
};

Row moved_row(const Options& options, bool light, bool own_steps)
{
  Row row;
  row.name = std::string("light-moved-") + (light ? "light" : "camera") +
    (own_steps ? "-own-steps" : "");
  row.what = std::string("256³ cloud under a sun, 512²: a frame after the ") +
    (light ? "light" : "camera") + " moved, against emission and absorption, " +
    (own_steps ? "steps by the default tolerance" : "both at ½ voxel");
  row.unit = "×";
  row.target = light ? 4.0 : 1.5;
  row.at_least = false;
  row.other = "emission and absorption";
  row.repetitions = options.quick ? 1 : 9;
  auto cloud = std::make_shared<std::unique_ptr<LitCloud>>();
  row.prepare = [=](Row& r)
  {
    const SceneOfCloud scene(options.quick ? 48 : 256);
    *cloud = std::make_unique<LitCloud>(options, scene);
    if (!own_steps)
    {
      (*cloud)->fix_step(0.5 * scene.voxel());
    }
    (*cloud)->draw((*cloud)->plain);
    (*cloud)->draw((*cloud)->lit);
    const nlohmann::json& s = (*cloud)->statistics;
    char text[200];
    std::snprintf(text, sizeof(text),
      "shadows: %s, nodes %.2f voxels apart, %.1f MB; step %.2f voxels; first frame %.2f s",
      s["shadow_method"].get<std::string>().c_str(),
      s["shadow_step"].get<double>() / scene.voxel(), s["light_bytes"].get<double>() / 1e6,
      s["step_in_voxels"].get<double>(), s["seconds_prepare"].get<double>());
    r.remark(text);
  };
  row.repeat = [=]
  {
    LitCloud& c = **cloud;
    if (light)
    {
      c.sun->SetPosition(1.0, -0.4 + 1e-3 * c.frames, 0.6);
    }
    Repetition one;
    one.seconds = c.draw(c.lit);
    one.other = c.draw(c.plain);
    one.figure = one.seconds / one.other;
    return one;
  };
  return row;
}

/// The same VDB, medium, light and step: seconds of the two, and their errors against shadow rays at
/// ⅛ voxel.
Row peer_row(const Options& options)
{
  Row row;
  row.name = "light-vdb-render";
  row.what = "256³ cloud as a VDB, single scattering, 512², step ½ voxel: against vdb_render";
  row.unit = "×";
  row.target = 20.0;
  row.other = "vdb_render, shadow step 1 voxel";
  row.repetitions = 1; // a picture of vdb_render's takes about a minute
  auto peer = std::make_shared<std::unique_ptr<VdbPeer>>();
  row.prepare = [=](Row& r)
  {
    const SceneOfCloud scene(options.quick ? 48 : 256);
    *peer = std::make_unique<VdbPeer>(scene, cloud_extinction, options.resolution,
      options.threads, options.quick);
    for (const std::string& remark : (*peer)->compare())
    {
      r.remark(remark);
    }
  };
  row.repeat = [=]
  {
    Repetition one;
    one.seconds = (*peer)->draw();
    one.other = (*peer)->draw_peer();
    one.figure = one.other / one.seconds;
    return one;
  };
  return row;
}

}

void add_light_rows(Scenes& scenes, std::vector<Row>& rows)
{
  const Options& options = scenes.options();
  for (const bool own : { false, true })
  {
    rows.push_back(moved_row(options, false, own));
    rows.push_back(moved_row(options, true, own));
  }
  rows.push_back(peer_row(options));
}

}
