// Brume's mappers as painters of viewports.
#pragma once

#include "painter.h"

namespace brume::app
{

/// Drafts and first whole pictures are ray marches. The path tracer then adds paths until the tolerance
/// is met; the smart mapper makes the picture that it promises.
class OwnPainter : public Painter
{
public:
  explicit OwnPainter(MapperKind kind);
  ~OwnPainter() override;

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
