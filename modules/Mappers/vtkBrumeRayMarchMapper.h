/**
 * @class   vtkBrumeRayMarchMapper
 * @brief   marches rays through a volume on the CPU; a drop-in for VTK's composite mode
 *
 * With a plain vtkVolumeProperty the picture is the one that VTK's ray-cast mappers draw in
 * COMPOSITE_BLEND, free of their step and table errors: emission and absorption by transfer
 * functions, σt = −ln(1 − opacity) / ScalarOpacityUnitDistance, gradient opacity, and shading by the
 * renderer's lights. Each step is a stretch of constant extinction and source, sampled at its
 * middle, and the last step of a ray is cut where the volume ends; halving the step changes the
 * picture by no more than its error.
 *
 * docs/user/drop-in.md has what of VTK's mappers is honoured, and docs/theory/optics.md the formulas.
 */
#ifndef vtkBrumeRayMarchMapper_h
#define vtkBrumeRayMarchMapper_h

#include "vtkBrumeMappersModule.h"
#include "vtkBrumeVolumeMapper.h"

#include <memory> // for std::unique_ptr

class VTKBRUMEMAPPERS_EXPORT vtkBrumeRayMarchMapper : public vtkBrumeVolumeMapper
{
public:
  static vtkBrumeRayMarchMapper* New();
  vtkTypeMacro(vtkBrumeRayMarchMapper, vtkBrumeVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether the step is chosen by the tolerance. On, the default: the longest of 2, 1, ½, … and
   * 1/32 of the smallest voxel edge with which the estimated error is within three quarters of Tolerance;
   * the choice is made from up to 256 rays of the first picture and kept while data, property and
   * tolerance stay. Off: SampleDistance.
   */
  vtkSetClampMacro(AutoAdjustSampleDistances, vtkTypeBool, 0, 1);
  vtkGetMacro(AutoAdjustSampleDistances, vtkTypeBool);
  vtkBooleanMacro(AutoAdjustSampleDistances, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Distance between samples when AutoAdjustSampleDistances is off, in the data's coordinates (the
   * unit of its spacing). Default 1. Values that are not positive are refused with a warning.
   */
  virtual void SetSampleDistance(double distance);
  vtkGetMacro(SampleDistance, double);
  ///@}

protected:
  vtkBrumeRayMarchMapper();
  ~vtkBrumeRayMarchMapper() override;

  bool RenderScene(brume::Scene& scene, brume::Film& film) override;

private:
  vtkBrumeRayMarchMapper(const vtkBrumeRayMarchMapper&) = delete;
  void operator=(const vtkBrumeRayMarchMapper&) = delete;

  vtkTypeBool AutoAdjustSampleDistances = 1;
  double SampleDistance = 1.0;

  struct Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
