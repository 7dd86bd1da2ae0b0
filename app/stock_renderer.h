// VTK's own mappers, drawn in a window that nobody sees.
#pragma once

#include "mapper_names.h"
#include "volume_scene.h"

#include "Analysis/picture.h"
#include "Transport/film.h"

#include <functional>
#include <memory>

class vtkVolumeMapper;

namespace brume::app
{

/// Whether OpenGL runs on a graphics card here, and not in software. Needs a display.
bool opengl_is_fast();

/// Draws a scene (of what VTK knows: stock_scene.h) and its surfaces with one of VTK's stock mappers,
/// step and all settings fixed, no jitter. Needs a
/// display (private_display.h). The picture is read where it is most exact: from the ray-cast image
/// of 15 bits for the CPU mapper, from the frame of 8 bits for the GPU mapper.
class StockRenderer
{
public:
  /// `step` in world units. The scene must outlive the renderer. Throws Failure when VTK reports an
  /// error.
  StockRenderer(const VolumeScene& scene, MapperKind kind, double step);
  ~StockRenderer();

  /// Asked now and then during a render: true ends it. Default: an interruption of the program does,
  /// which render() then throws.
  void set_abort(std::function<bool()> abort);
  /// Whether the last render was ended so; its picture is none.
  bool aborted() const;

  /// One render; returns the seconds of the volume's render alone: for the CPU mapper from its own
  /// start and end events, for the GPU mapper the frame until the card has finished. Nothing of the
  /// frame is still being drawn when it returns.
  double render();

  /// The last render over the scene's background; of the CPU mapper the volume alone.
  Picture picture();
  /// The last render as light: the GPU mapper's is drawn once more over black, with the surfaces; the
  /// CPU mapper's holds the volume as far as the surfaces let see it.
  Film film();
  /// The frame as the window shows it, 8 bits.
  Picture frame();
  /// Threads of the CPU mapper; 1 for the GPU mapper, which is driven by one.
  int threads() const;
  /// Name of the OpenGL device.
  std::string device();
  /// VTK's mapper, for settings that a scene does not have.
  vtkVolumeMapper* mapper();

private:
  struct Internals;
  std::unique_ptr<Internals> Internal;
};

}
