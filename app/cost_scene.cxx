// The variants of a scene that a study draws.
#include "cost_knobs.h"
#include "cost_voxels.h"

#include "mesh_scene.h"
#include "private_display.h"
#include "stock_scene.h"

#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumePathTraceMapper.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSmartVolumeMapper.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkPolyData.h"
#include "vtkVolume.h"

#include <algorithm>

namespace brume::app
{

struct CostScene::Variant
{
  std::string name;
  std::unique_ptr<VolumeScene> scene;
  std::unique_ptr<CostMarch> march;
};

CostScene::CostScene(const VolumeScene& scene)
  : Scene(scene)
  , March(scene)
{
}

CostScene::~CostScene() = default;

CostPaths& CostScene::paths()
{
  if (!this->Paths)
  {
    this->Paths = std::make_unique<CostPaths>(this->Scene, this->March.march().surfaces());
  }
  return *this->Paths;
}

CostSmart& CostScene::smart()
{
  if (!this->Smart)
  {
    this->Smart = std::make_unique<CostSmart>(this->Scene, this->March.march().surfaces());
  }
  return *this->Smart;
}

bool CostScene::wants(const std::string& mapper) const
{
  return this->Mappers.empty() ||
    std::find(this->Mappers.begin(), this->Mappers.end(), mapper) != this->Mappers.end();
}

CostMarch& CostScene::smaller(int divisor)
{
  const std::string name = "1/" + std::to_string(divisor);
  for (const auto& variant : this->Variants)
  {
    if (variant->name == name)
    {
      return *variant->march;
    }
  }
  auto made = std::make_unique<Variant>();
  made->name = name;
  made->scene = std::make_unique<VolumeScene>(this->Scene);
  for (int& pixels : made->scene->options.resolution)
  {
    pixels = std::max(1, pixels / divisor);
  }
  made->march = std::make_unique<CostMarch>(*made->scene);
  this->Variants.push_back(std::move(made));
  return *this->Variants.back()->march;
}

CostMarch* CostScene::stored(VoxelStore store, std::string& reason)
{
  const std::string name = voxel_store_name(store);
  for (const auto& variant : this->Variants)
  {
    if (variant->name == name)
    {
      return variant->march.get();
    }
  }
  auto made = std::make_unique<Variant>();
  made->name = name;
  made->scene = with_voxels(this->Scene, store, reason);
  if (!made->scene)
  {
    return nullptr;
  }
  made->march = std::make_unique<CostMarch>(*made->scene);
  this->Variants.push_back(std::move(made));
  return this->Variants.back()->march.get();
}

const VolumeScene& CostScene::stock()
{
  if (!this->Stock)
  {
    this->Stock = std::make_unique<VolumeScene>(stock_scene(this->Scene));
    this->StockSurfaces =
      this->Scene.sky ? draw_meshes(*this->Stock) : this->March.march().surfaces();
  }
  return *this->Stock;
}

const SurfacePicture& CostScene::stock_surfaces()
{
  this->stock();
  return this->StockSurfaces;
}

const PrivateDisplay& CostScene::display()
{
  if (!this->Display)
  {
    this->Display = std::make_unique<PrivateDisplay>();
  }
  return *this->Display;
}

}
