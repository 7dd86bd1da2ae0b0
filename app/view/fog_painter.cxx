#include "fog_painter.h"

#include "command.h"
#include "mesh_scene.h"

#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkVolume.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace brume::app
{

namespace
{

class FogPainter : public Painter
{
public:
  explicit FogPainter(MapperKind kind)
    : Kind(kind)
  {
    this->Ear->SetClientData(&this->Error);
    this->Ear->SetCallback([](vtkObject*, unsigned long, void* data, void* text)
      { *static_cast<std::string*>(data) = static_cast<const char*>(text); });
  }

  ~FogPainter() override { this->stop_listening(); }

  void set_scene(const VolumeScene& scene) override
  {
    this->stop_listening();
    this->Scene = scene;
    if (!scene.fog)
    {
      throw Failure("--fog-extinction",
        "without fog there is nothing to draw but surfaces",
        "turn the fog up, or open a volume");
    }
    scene.fog->SetNumberOfThreads(scene.options.threads);
    scene.fog->AddObserver(vtkCommand::ErrorEvent, this->Ear);
  }

  bool draft(int width, int height, double seconds, const KeepGoing& go) override
  {
    this->Finished = false;
    if (this->SecondsPerPixel > 0.0)
    {
      const double wanted = std::sqrt(this->SecondsPerPixel * width * height / seconds);
      this->Divisor = std::clamp(static_cast<int>(std::ceil(wanted)), 1, 16);
    }
    const int w = (width + this->Divisor - 1) / this->Divisor;
    const int h = (height + this->Divisor - 1) / this->Divisor;
    if (!this->draw(w, h, true, go))
    {
      return false;
    }
    this->SecondsPerPixel = this->Shown.seconds / (double(w) * h);
    this->Shown.whole = this->Divisor == 1;
    this->Shown.draft = true;
    this->Shown.state = "draft";
    return true;
  }

  bool refine(int width, int height, const KeepGoing& go) override
  {
    if (this->Finished || !this->draw(width, height, false, go))
    {
      return false;
    }
    this->Shown.whole = this->Finished = true;
    this->Shown.draft = false;
    this->Shown.state = "fog in closed form";
    return true;
  }

  bool finished() const override { return this->Finished; }
  const Shot& shot() const override { return this->Shown; }

private:
  /// The fog is the scene's, and may outlive this.
  void stop_listening()
  {
    if (this->Scene.fog)
    {
      this->Scene.fog->RemoveObserver(this->Ear);
    }
  }

  /// False where `go` ended it.
  bool draw(int width, int height, bool draft, const KeepGoing& go)
  {
    if (!is_own(this->Kind))
    {
      throw Failure(this->Kind == MapperKind::Gpu ? "vtk-gpu" : "vtk-fixed-point",
        "VTK's own mappers draw no fog",
        "see Brume's picture");
    }
    if (!go(0.0))
    {
      return false;
    }
    const auto start = std::chrono::steady_clock::now();
    this->Scene.options.resolution = { width, height };
    fit_clipping_range(this->Scene);
    const SurfacePicture surfaces = this->Meshes.draw(this->Scene, draft);
    const auto film = std::make_shared<Film>(width, height);
    this->Error.clear();
    bool ended = false;
    const auto progress = [&](double done)
    {
      ended = ended || !go(done);
      return !ended;
    };
    if (!this->Scene.fog->RenderFilm(
          this->Scene.camera, this->Scene.lights, *film, surfaces.depth, progress))
    {
      if (ended)
      {
        return false;
      }
      throw Failure("--fog-extinction", "the fog cannot be drawn", words_of_vtk(this->Error));
    }
    this->Shown.picture = { width, height, over_scene(*film, this->Scene, surfaces) };
    this->Shown.film = film;
    this->Shown.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ShownEffect fog;
    fog.name = "fog";
    fog.on = true;
    fog.reason = "the scene has fog, and no volume";
    fog.milliseconds = 1e3 * this->Shown.seconds;
    this->Shown.effects = { fog };
    return true;
  }

  MapperKind Kind;
  VolumeScene Scene;
  MeshStage Meshes;
  Shot Shown;
  vtkNew<vtkCallbackCommand> Ear;
  std::string Error;
  double SecondsPerPixel = 0.0; ///< of the last draft; 0 before
  int Divisor = 4;              ///< pixels of a draft's edge
  bool Finished = false;
};

}

std::unique_ptr<Painter> make_fog_painter(MapperKind kind)
{
  return std::make_unique<FogPainter>(kind);
}

}
