// The mapper that keeps an error or a time, in a study.
#pragma once

#include "cost_setting.h"

#include "vtkNew.h"

class vtkBrumeSmartVolumeMapper;

namespace brume::app
{

/// Draws one scene by an error or a time.
class CostSmart
{
public:
  /// `surfaces`: the scene's. Both must outlive it.
  CostSmart(const VolumeScene& scene, const SurfacePicture& surfaces);
  ~CostSmart();

  /// A picture of this tolerance (a fraction of white); its seconds are the render alone.
  CostRender within(double tolerance, const Watch& watch);
  /// The best picture of so many seconds; its seconds are all that it took, preparations and all.
  CostRender of_time(double seconds, const Watch& watch);

private:
  CostRender draw(const Watch& watch);

  const VolumeScene& Scene;
  const SurfacePicture& Surfaces;
  Watch Whole;
  vtkNew<vtkBrumeSmartVolumeMapper> Mapper;
};

}
