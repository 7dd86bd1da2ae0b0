#include "stock_renderer.h"

#include "command.h"
#include "interruption.h"
#include "mesh_scene.h"
#include "prompt_window.h"

#include "vtkActor.h"
#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkFixedPointRayCastImage.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkOpenGLGPUVolumeRayCastMapper.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkPolyData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeMapper.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace brume::app
{

struct StockRenderer::Internals
{
  using Clock = std::chrono::steady_clock;

  const VolumeScene* Scene = nullptr;
  MapperKind Kind = MapperKind::FixedPoint;
  vtkNew<vtkImageData> Image;
  vtkNew<vtkVolume> Volume;
  vtkNew<vtkRenderer> Renderer;
  vtkSmartPointer<vtkRenderWindow> Window = make_prompt_window();
  vtkSmartPointer<vtkFixedPointVolumeRayCastMapper> FixedPoint;
  vtkSmartPointer<vtkOpenGLGPUVolumeRayCastMapper> Gpu;
  Clock::time_point Start;
  double Seconds = 0.0;
  std::string Error;
  std::function<bool()> Abort = [] { return InterruptionWatch::requested(); };
  bool Heard = false; ///< set_abort() was called
  bool Aborted = false;

  /// The stock mappers do not all know an image's direction, so it goes into the prop's matrix.
  void place_volume()
  {
    vtkImageData* image = this->Scene->input.image;
    this->Image->ShallowCopy(image);
    const double* origin = image->GetOrigin();
    this->Image->SetOrigin(0.0, 0.0, 0.0);
    vtkNew<vtkMatrix3x3> identity;
    this->Image->SetDirectionMatrix(identity);
    vtkNew<vtkMatrix4x4> matrix;
    for (int row = 0; row < 3; ++row)
    {
      for (int column = 0; column < 3; ++column)
      {
        matrix->SetElement(row, column, image->GetDirectionMatrix()->GetElement(row, column));
      }
      matrix->SetElement(row, 3, origin[row]);
    }
    this->Volume->SetUserMatrix(matrix);
    this->Volume->SetProperty(this->Scene->volume->GetProperty());
  }

  /// VTK's CPU mapper gives one row to each thread in turn, to this one first. Where nobody asked to be heard
  /// nothing waits: its time is measured as it is.
  void tell_rows()
  {
    if (this->FixedPoint && this->Heard)
    {
      int size[2];
      this->FixedPoint->GetRayCastImage()->GetImageInUseSize(size);
      const int threads = this->FixedPoint->GetNumberOfThreads();
      const int own = (size[1] + threads - 1) / threads;
      share_rows(this->Window, own, size[1] - own);
    }
  }

  void observe(vtkObject* object)
  {
    vtkNew<vtkCallbackCommand> observer;
    observer->SetClientData(this);
    observer->SetCallback(
      [](vtkObject*, unsigned long event, void* data, void* text)
      {
        auto* self = static_cast<Internals*>(data);
        if (event == vtkCommand::VolumeMapperRenderStartEvent)
        {
          self->Start = Clock::now();
          self->tell_rows();
        }
        else if (event == vtkCommand::VolumeMapperRenderEndEvent)
        {
          self->Seconds = std::chrono::duration<double>(Clock::now() - self->Start).count();
          share_rows(self->Window, 0, 0);
        }
        else if (event == vtkCommand::AbortCheckEvent)
        {
          if (self->Abort())
          {
            self->Aborted = true;
            self->Window->SetAbortRender(1);
          }
        }
        else if (self->Error.empty())
        {
          self->Error = text ? static_cast<const char*>(text) : "unknown error";
          std::replace(self->Error.begin(), self->Error.end(), '\n', ' ');
        }
      });
    object->AddObserver(vtkCommand::ErrorEvent, observer);
    object->AddObserver(vtkCommand::AbortCheckEvent, observer);
    object->AddObserver(vtkCommand::VolumeMapperRenderStartEvent, observer);
    object->AddObserver(vtkCommand::VolumeMapperRenderEndEvent, observer);
  }
};

StockRenderer::StockRenderer(const VolumeScene& scene, MapperKind kind, double step)
  : Internal(std::make_unique<Internals>())
{
  Internals& in = *this->Internal;
  in.Scene = &scene;
  in.Kind = kind;
  in.place_volume();
  if (kind == MapperKind::FixedPoint)
  {
    in.FixedPoint = vtkSmartPointer<vtkFixedPointVolumeRayCastMapper>::New();
    in.FixedPoint->SetInputData(in.Image);
    in.FixedPoint->AutoAdjustSampleDistancesOff();
    in.FixedPoint->SetSampleDistance(static_cast<float>(step));
    in.FixedPoint->SetInteractiveSampleDistance(static_cast<float>(step));
    in.FixedPoint->SetImageSampleDistance(1.0f);
    in.FixedPoint->SetIntermixIntersectingGeometry(!scene.meshes.empty());
    if (scene.options.threads > 0)
    {
      in.FixedPoint->SetNumberOfThreads(scene.options.threads);
    }
    in.Volume->SetMapper(in.FixedPoint);
    in.observe(in.FixedPoint);
  }
  else
  {
    in.Gpu = vtkSmartPointer<vtkOpenGLGPUVolumeRayCastMapper>::New();
    in.Gpu->SetInputData(in.Image);
    in.Gpu->AutoAdjustSampleDistancesOff();
    in.Gpu->SetSampleDistance(static_cast<float>(step));
    in.Gpu->SetImageSampleDistance(1.0f);
    in.Gpu->UseJitteringOff();
    in.Gpu->SetMaskInput(scene.mask);
    in.Gpu->SetMaskTypeToBinary();
    in.Volume->SetMapper(in.Gpu);
    in.observe(in.Gpu);
  }
  apply(scene.options.modes, this->mapper(), in.Volume->GetProperty());
  apply_cropping_of_voxels(cropping_of_voxels(scene), in.Image, this->mapper()); // the image lost its place
  in.observe(in.Window);
  in.Window->SetOffScreenRendering(1);
  in.Window->SetMultiSamples(0);
  in.Window->SetAlphaBitPlanes(1);
  in.Window->SetSize(scene.width(), scene.height());
  in.Window->AddRenderer(in.Renderer);
  double background[3];
  std::copy(scene.options.background.begin(), scene.options.background.end(), background);
  in.Renderer->SetBackground(background);
  in.Renderer->SetActiveCamera(scene.camera);
  // VTK 9.1 computes the aspect, by which the CPU mapper draws, only where the size is another than the
  // last, which a new renderer has from whatever was in its memory before: often one like it.
  in.Renderer->SetAspect(double(scene.width()) / scene.height(), 1.0);
  in.Renderer->AutomaticLightCreationOff();
  in.Renderer->SetLightCollection(scene.lights);
  for (vtkPolyData* mesh : scene.meshes)
  {
    in.Renderer->AddActor(actor_of(mesh));
  }
  in.Renderer->AddVolume(in.Volume);
}

StockRenderer::~StockRenderer() = default;

void StockRenderer::set_abort(std::function<bool()> abort)
{
  this->Internal->Abort = std::move(abort);
  this->Internal->Heard = true;
}

bool StockRenderer::aborted() const
{
  return this->Internal->Aborted;
}

double StockRenderer::render()
{
  Internals& in = *this->Internal;
  const auto start = Internals::Clock::now();
  in.Aborted = false;
  in.Window->Render();
  InterruptionWatch::check(in.Scene->options.input.c_str());
  in.Window->WaitForCompletion();
  if (in.Kind == MapperKind::Gpu)
  {
    in.Seconds = std::chrono::duration<double>(Internals::Clock::now() - start).count();
  }
  if (!in.Error.empty())
  {
    throw Failure(in.Kind == MapperKind::Gpu ? "vtk-gpu" : "vtk-fixed-point", in.Error,
      "leave this mapper out with --mappers");
  }
  return in.Seconds;
}

Picture StockRenderer::frame()
{
  Internals& in = *this->Internal;
  Picture picture;
  picture.width = in.Scene->width();
  picture.height = in.Scene->height();
  vtkNew<vtkUnsignedCharArray> bytes;
  in.Window->GetPixelData(0, 0, picture.width - 1, picture.height - 1, 0, bytes);
  picture.rgb.reserve(static_cast<std::size_t>(bytes->GetNumberOfValues()));
  for (vtkIdType i = 0; i < bytes->GetNumberOfValues(); ++i)
  {
    picture.rgb.push_back(bytes->GetValue(i) / 255.0f);
  }
  return picture;
}

Picture StockRenderer::picture()
{
  Internals& in = *this->Internal;
  if (in.Kind == MapperKind::Gpu)
  {
    return this->frame();
  }
  return { in.Scene->width(), in.Scene->height(),
    over_background(this->film(), in.Scene->options.background.data()) };
}

Film StockRenderer::film()
{
  Internals& in = *this->Internal;
  Film film(in.Scene->width(), in.Scene->height());
  if (in.Kind == MapperKind::FixedPoint)
  {
    // Premultiplied colour and opacity, 15 bits each, of the part of the viewport that is in use.
    vtkFixedPointRayCastImage* image = in.FixedPoint->GetRayCastImage();
    int memory[2];
    int used[2];
    int origin[2];
    image->GetImageMemorySize(memory);
    image->GetImageInUseSize(used);
    image->GetImageOrigin(origin);
    for (int y = 0; y < used[1]; ++y)
    {
      for (int x = 0; x < used[0]; ++x)
      {
        const unsigned short* pixel =
          image->GetImage() + 4 * (static_cast<std::size_t>(y) * memory[0] + x);
        const int px = x + origin[0];
        const int py = y + origin[1];
        if (px < 0 || py < 0 || px >= film.width || py >= film.height)
        {
          continue;
        }
        const std::size_t i = static_cast<std::size_t>(py) * film.width + px;
        for (int c = 0; c < 3; ++c)
        {
          film.radiance[c][i] = pixel[c] / 32767.0f;
          film.transmittance[c][i] = 1.0f - pixel[3] / 32767.0f;
        }
      }
    }
    return film;
  }
  double background[3];
  in.Renderer->GetBackground(background);
  in.Renderer->SetBackground(0.0, 0.0, 0.0);
  in.Renderer->SetBackgroundAlpha(0.0);
  in.Window->Render();
  vtkNew<vtkUnsignedCharArray> bytes;
  in.Window->GetRGBACharPixelData(0, 0, film.width - 1, film.height - 1, 0, bytes);
  for (std::size_t i = 0; i < film.size(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      film.radiance[c][i] = bytes->GetValue(static_cast<vtkIdType>(4 * i) + c) / 255.0f;
      film.transmittance[c][i] =
        1.0f - bytes->GetValue(static_cast<vtkIdType>(4 * i) + 3) / 255.0f;
    }
  }
  in.Renderer->SetBackground(background);
  in.Window->Render();
  return film;
}

int StockRenderer::threads() const
{
  return this->Internal->FixedPoint ? this->Internal->FixedPoint->GetNumberOfThreads() : 1;
}

vtkVolumeMapper* StockRenderer::mapper()
{
  return vtkVolumeMapper::SafeDownCast(this->Internal->Volume->GetMapper());
}

namespace
{

/// The name of the device that a window draws with.
std::string device_of(vtkRenderWindow* window)
{
  const char* text = window->ReportCapabilities();
  const std::string all = text ? text : "";
  const std::string key = "OpenGL renderer string:";
  const std::size_t at = all.find(key);
  if (at == std::string::npos)
  {
    return {};
  }
  const std::size_t begin = all.find_first_not_of(' ', at + key.size());
  return all.substr(begin, all.find('\n', begin) - begin);
}

}

std::string StockRenderer::device()
{
  return device_of(this->Internal->Window);
}

bool opengl_is_fast()
{
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetSize(16, 16);
  window->Render();
  const std::string device = device_of(window);
  for (const char* software : { "llvmpipe", "softpipe", "swrast", "Software" })
  {
    if (device.find(software) != std::string::npos)
    {
      return false;
    }
  }
  return !device.empty();
}

}
