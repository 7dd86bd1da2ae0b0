/**
 * @class   vtkBrumeSmartVolumeMapper
 * @brief   keeps a promise: an error or a time, by whichever method meets it
 *
 * As vtkSmartVolumeMapper chooses between VTK's mappers, this one chooses between ray march
 * (vtkBrumeRayMarchMapper) and path tracing (vtkBrumePathTraceMapper), and their settings, for each
 * picture:
 *
 * @code
 * vtkNew<vtkBrumeSmartVolumeMapper> mapper;
 * mapper->SetInputConnection(reader->GetOutputPort());
 * mapper->SetMedium(medium);
 * mapper->SetTolerance(0.01); // 99.9 % of the pixels within a hundredth of white of the truth
 * volume->SetMapper(mapper);
 * @endcode
 *
 * The truth is light scattered any number of times, with exact integrals along each ray. Where
 * nothing scatters, steps alone make errors, and the ray march chooses those. Where matter scatters
 * light, a few rays of the picture are traced by paths and marched (single scattering, octaves): a
 * march that is within the tolerance on them is taken, else paths are traced, more of them where
 * there is more noise, until 99.9 % of the pixels are expected to be within the tolerance. That can
 * take long: GetStatistics() and the progress tell how long. With a TimeBudget the picture is the
 * best that the time allows.
 *
 * A march that does as well with fewer rays than pixels, two or four pixels apart, has these, and is
 * scaled up: `image_sample_distance` in the statistics tells.
 *
 * Some scenes are not comparable, as paths do not draw them: other blend modes than composite,
 * gradient shading, silver lining, powder, effects that are forced, fog in which paths have no end
 * (vtkBrumePathTraceMapper). They are marched,
 * with the march's own estimate, and GetStatistics() tells why.
 *
 * GetStatistics() has, beside what the mapper of the method tells, `method`: what was chosen and
 * why, what was expected of it and what it took, and what was turned down. docs/user/accuracy.md
 * has it all.
 */
#ifndef vtkBrumeSmartVolumeMapper_h
#define vtkBrumeSmartVolumeMapper_h

#include "vtkBrumeMappersModule.h"
#include "vtkBrumeVolumeMapper.h"

#include <memory> // for std::unique_ptr

namespace brume
{
struct MethodChoice;
}

class VTKBRUMEMAPPERS_EXPORT vtkBrumeSmartVolumeMapper : public vtkBrumeVolumeMapper
{
public:
  static vtkBrumeSmartVolumeMapper* New();
  vtkTypeMacro(vtkBrumeSmartVolumeMapper, vtkBrumeVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Seconds that a picture may take, with all that is prepared for it. It then takes between 0.8
   * and 1.2 of them, or less where it is as good as can be before that or meets the Tolerance: a
   * Tolerance of 0 asks for the best picture of the time. Budgets too short for any picture of this
   * size are met by one with fewer rays, scaled up. Default 0: no limit. Negative values are set to
   * 0.
   */
  vtkSetClampMacro(TimeBudget, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TimeBudget, double);
  ///@}

  ///@{
  /**
   * Chooses one of all pictures of the same noise, where paths are traced. Default 1. Without a
   * TimeBudget the same seed gives the same picture if the same method is chosen, which near its
   * limit depends on how fast the machine is.
   */
  vtkSetMacro(Seed, unsigned int);
  vtkGetMacro(Seed, unsigned int);
  ///@}

protected:
  vtkBrumeSmartVolumeMapper();
  ~vtkBrumeSmartVolumeMapper() override;
  bool RenderScene(brume::Scene& scene, brume::Film& film) override;

  double TimeBudget = 0.0;
  unsigned int Seed = 1;

private:
  vtkBrumeSmartVolumeMapper(const vtkBrumeSmartVolumeMapper&) = delete;
  void operator=(const vtkBrumeSmartVolumeMapper&) = delete;

  struct Internals;
  struct Picture;
  void March(Picture& picture);
  void MarchWithin(Picture& picture);
  void Trace(Picture& picture);

  std::unique_ptr<Internals> Internal;
};

#endif
