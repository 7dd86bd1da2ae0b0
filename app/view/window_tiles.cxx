#include "window_tiles.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkTexture.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

namespace brume::app
{

struct WindowTiles::Shown
{
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkTexture> texture;
  vtkNew<vtkImageData> image;
  unsigned version = 0;

  Shown()
  {
    this->texture->SetInputData(this->image);
    this->texture->MipmapOff();
    this->renderer->SetBackgroundTexture(this->texture);
    this->renderer->TexturedBackgroundOn();
    this->renderer->AutomaticLightCreationOff();
  }

  void take(const Tile& tile, const int size[2], vtkCamera* camera)
  {
    this->version = tile.version;
    const Box& box = tile.box;
    this->renderer->SetViewport(double(box.x) / size[0],
      double(size[1] - box.y - box.height) / size[1],
      double(box.x + box.width) / size[0],
      double(size[1] - box.y) / size[1]);
    // A new renderer may take the aspect for known (stock_renderer.cxx).
    this->renderer->SetAspect(double(box.width) / box.height, 1.0);
    this->renderer->SetInteractive(tile.picture);
    this->renderer->SetActiveCamera(camera);
    vtkNew<vtkUnsignedCharArray> bytes;
    bytes->SetNumberOfComponents(3);
    bytes->SetNumberOfTuples(static_cast<vtkIdType>(tile.bitmap.rgb.size() / 3));
    std::copy(tile.bitmap.rgb.begin(), tile.bitmap.rgb.end(), bytes->GetPointer(0));
    this->image->SetDimensions(tile.bitmap.width, tile.bitmap.height, 1);
    this->image->GetPointData()->SetScalars(bytes);
    this->image->Modified();
    this->texture->SetInterpolate(
      tile.bitmap.width != box.width || tile.bitmap.height != box.height);
  }
};

WindowTiles::WindowTiles(vtkRenderWindow* window)
  : Window(window)
{
}

WindowTiles::~WindowTiles() = default;

bool WindowTiles::take(const std::vector<Tile>& tiles, vtkCamera* camera)
{
  bool changed = this->Tiles.size() != tiles.size();
  while (this->Tiles.size() > tiles.size())
  {
    this->Window->RemoveRenderer(this->Tiles.back()->renderer);
    this->Tiles.pop_back();
  }
  while (this->Tiles.size() < tiles.size())
  {
    this->Tiles.push_back(std::make_unique<Shown>());
    this->Window->AddRenderer(this->Tiles.back()->renderer);
  }
  const int* size = this->Window->GetSize();
  for (std::size_t i = 0; i < tiles.size(); ++i)
  {
    if (this->Tiles[i]->version != tiles[i].version)
    {
      this->Tiles[i]->take(tiles[i], size, camera);
      changed = true;
    }
  }
  return changed;
}

vtkRenderer* WindowTiles::first() const
{
  return this->Tiles.front()->renderer;
}

}
