// VTK's own mappers as painters of viewports.
#pragma once

#include "painter.h"

namespace brume::app
{

/// Drafts have fewer rays, as the mappers' own settings allow; whole pictures are those of `brume
/// compare`: steps of half a voxel or --sample-distance. What VTK's mappers do not know of the scene is
/// left out (stock_scene.h).
class StockPainter : public Painter
{
public:
  explicit StockPainter(MapperKind kind);
  ~StockPainter() override;

  void set_scene(const VolumeScene& scene) override;
  bool draft(int width, int height, double seconds, const KeepGoing& go) override;
  bool refine(int width, int height, const KeepGoing& go) override;
  bool finished() const override;
  const Shot& shot() const override;

private:
  struct Internals;
  std::unique_ptr<Internals> Internal;
};

}
