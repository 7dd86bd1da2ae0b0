// A viewer's tiles on VTK's window.
#pragma once

#include "viewer.h"

#include <memory>
#include <vector>

class vtkCamera;
class vtkRenderer;
class vtkRenderWindow;

namespace brume::app
{

/// A renderer for each tile, with its bitmap behind whatever else the renderer draws.
class WindowTiles
{
public:
  explicit WindowTiles(vtkRenderWindow* window);
  ~WindowTiles();
  WindowTiles(const WindowTiles&) = delete;
  WindowTiles& operator=(const WindowTiles&) = delete;

  /// Takes on the tiles that are others than at the last call, without drawing the window. Their
  /// bitmaps must stay until the next call. Pictures share the camera.
  /// Whether there were any.
  bool take(const std::vector<Tile>& tiles, vtkCamera* camera);

  /// Of the first tile: where the cutting tools stand. There must be one.
  vtkRenderer* first() const;

private:
  struct Shown;
  vtkRenderWindow* Window;
  std::vector<std::unique_ptr<Shown>> Tiles;
};

}
