#include "painter.h"

#include "stock_renderer.h"
#include "stock_scene.h"

#include "command.h"

#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"
#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkPolyData.h"
#include "vtkVolume.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace brume::app
{

namespace
{

/// Drafts have fewer rays, as the mappers' own settings allow; whole pictures are those of `brume
/// compare`: steps of half a voxel or --sample-distance. What VTK's mappers do not know of the
/// scene is left out (stock_scene.h).
class StockPainter : public Painter
{
public:
  explicit StockPainter(MapperKind kind)
    : Kind(kind)
  {
  }

  void set_scene(const VolumeScene& scene) override;
  bool draft(int width, int height, double seconds, const KeepGoing& go) override;
  bool refine(int width, int height, const KeepGoing& go) override;
  bool finished() const override { return this->Finished; }
  const Shot& shot() const override { return this->Shown; }

private:
  void set_distance(double pixels);
  /// False where it was ended.
  bool draw(int width, int height, double distance, const KeepGoing& go);

  MapperKind Kind;
  VolumeScene Scene;
  std::unique_ptr<StockRenderer> Renderer; ///< of the scene and a size
  Shot Shown;
  bool Finished = false;
  double Distance = 4.0;       ///< pixels between a draft's rays
  double SecondsOfWhole = 0.0; ///< guessed by the last draft; 0 before
};

void StockPainter::set_distance(double pixels)
{
  const auto distance = static_cast<float>(pixels);
  if (auto* gpu = vtkGPUVolumeRayCastMapper::SafeDownCast(this->Renderer->mapper()))
  {
    gpu->SetImageSampleDistance(distance);
  }
  else
  {
    vtkFixedPointVolumeRayCastMapper::SafeDownCast(this->Renderer->mapper())
      ->SetImageSampleDistance(distance);
  }
}

bool StockPainter::draw(int width, int height, double distance, const KeepGoing& go)
{
  const std::string cannot = not_drawn_by_stock(this->Scene.options, this->Scene.input);
  if (!cannot.empty())
  {
    throw Failure(
      this->Kind == MapperKind::Gpu ? "vtk-gpu" : "vtk-fixed-point", cannot, "see Brume's picture");
  }
  if (!this->Renderer || this->Scene.width() != width || this->Scene.height() != height)
  {
    this->Renderer.reset();
    this->Scene.options.resolution = { width, height };
    const double step = this->Scene.options.sample_distance.value_or(0.5 * this->Scene.voxel_edge);
    this->Renderer = std::make_unique<StockRenderer>(this->Scene, this->Kind, step);
  }
  fit_clipping_range(this->Scene);
  this->set_distance(distance);
  const KeepGoing& asked = go;
  this->Renderer->set_abort([&asked] { return !asked(0.0); });
  const auto start = std::chrono::steady_clock::now();
  this->Renderer->render();
  if (this->Renderer->aborted())
  {
    return false;
  }
  this->Shown.seconds =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  // The exact picture of the CPU mapper is the volume alone.
  const bool exact = distance <= 1.0 && this->Scene.meshes.empty();
  this->Shown.picture = exact ? this->Renderer->picture() : this->Renderer->frame();
  this->Shown.failure.clear();
  this->Shown.effects.clear();
  return true;
}

void StockPainter::set_scene(const VolumeScene& scene)
{
  this->Renderer.reset(); // it holds on to the scene
  this->Scene = stock_scene(scene);
}

bool StockPainter::draft(int width, int height, double seconds, const KeepGoing& go)
{
  this->Finished = false;
  if (this->SecondsOfWhole > 0.0)
  {
    this->Distance = std::clamp(std::ceil(std::sqrt(this->SecondsOfWhole / seconds)), 1.0, 10.0);
  }
  if (!this->draw(width, height, this->Distance, go))
  {
    return false;
  }
  this->SecondsOfWhole = this->Shown.seconds * this->Distance * this->Distance;
  this->Shown.whole = false;
  this->Shown.draft = true;
  this->Shown.state = "draft";
  return true;
}

bool StockPainter::refine(int width, int height, const KeepGoing& go)
{
  if (this->Finished || !this->draw(width, height, 1.0, go))
  {
    return false;
  }
  this->Finished = true;
  this->Shown.whole = true;
  this->Shown.draft = false;
  this->Shown.state = "whole";
  return true;
}

}

std::unique_ptr<Painter> make_stock_painter(MapperKind kind)
{
  return std::make_unique<StockPainter>(kind);
}

}
