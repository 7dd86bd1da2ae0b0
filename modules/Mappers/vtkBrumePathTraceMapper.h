/**
 * @class   vtkBrumePathTraceMapper
 * @brief   the truth: light in a medium scattered any number of times, by unbiased path tracing
 *
 * Takes the place of vtkBrumeRayMarchMapper where the picture is to be right rather than soon:
 *
 * @code
 * vtkNew<vtkBrumePathTraceMapper> mapper;
 * mapper->SetInputConnection(reader->GetOutputPort());
 * mapper->SetMedium(medium);
 * mapper->SetSamplesPerPixel(256);
 * volume->SetMapper(mapper);
 * @endcode
 *
 * Each pixel is the mean of many paths through its centre, which scatter where chance has them
 * collide with matter (null-collision tracking with bounds brick by brick), look for a light there,
 * and go on by the phase function until they leave the matter. The expectation is the solution of the
 * radiative transfer equation: nothing is clamped or cut off, but for what fog
 * without bounds needs (docs/theory/paths.md). What is left is noise,
 * and the film's error plane tells how much: three standard errors a pixel. docs/theory/paths.md has
 * the derivations.
 *
 * A picture stops at SamplesPerPixel, at the Tolerance (when 99.9 % of its pixels are expected to be
 * within it) or at the TimeBudget, whichever comes first. The same Seed gives the same picture, bit for
 * bit, for every number of threads.
 *
 * An environment map lights media as it is, not by directional lights in its place
 * (vtkBrumeSky::NumberOfEnvironmentLights).
 *
 * What is not simulated, and told in the statistics: octaves (all scatterings are followed), gradient
 * shading (the phase function holds), silver lining and powder (no physics). A vtkBrumeFog scatters
 * as often as the volumes do, and they throw shadows on it; one without falloff is an error with light
 * from infinity (directional lights, sky), of which it has no end, unless MaximumScatterings is 1, and
 * with an albedo of 1, unless there is a MaximumScatterings. Composite mode alone. Input, cropping, masks, clipping, several volumes and surfaces are those of
 * vtkBrumeVolumeMapper.
 */
#ifndef vtkBrumePathTraceMapper_h
#define vtkBrumePathTraceMapper_h

#include "vtkBrumeMappersModule.h"
#include "vtkBrumeVolumeMapper.h"

#include <memory> // for std::unique_ptr

class VTKBRUMEMAPPERS_EXPORT vtkBrumePathTraceMapper : public vtkBrumeVolumeMapper
{
public:
  static vtkBrumePathTraceMapper* New();
  vtkTypeMacro(vtkBrumePathTraceMapper, vtkBrumeVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Paths through each pixel, at the most. Four times as many halve the noise. Default 64. Range 1 to
   * VTK_INT_MAX; values outside are clamped.
   */
  vtkSetClampMacro(SamplesPerPixel, int, 1, VTK_INT_MAX);
  vtkGetMacro(SamplesPerPixel, int);
  ///@}

  ///@{
  /**
   * For windows: paths through each pixel that one render adds to those of the renders before it, up
   * to SamplesPerPixel. While nothing changes, neither the camera nor the scene nor the picture's
   * size, each Render() of the window brings a picture with less noise, after n renders bit for bit
   * the one of n times as many samples; the first one after a change begins anew.
   * TimeBudget ends a render, too, and later ones go on; Tolerance ends none, and the statistics tell
   * when it is met. Default 0: off, each render makes the
   * whole picture by itself. Range 0 to VTK_INT_MAX; values outside are clamped.
   *
   * @code
   * mapper->SetSamplesPerRender(4);
   * do
   * {
   *   window->Render();
   * } while (mapper->GetRenderedSamplesPerPixel() < mapper->GetSamplesPerPixel());
   * @endcode
   */
  vtkSetClampMacro(SamplesPerRender, int, 0, VTK_INT_MAX);
  vtkGetMacro(SamplesPerRender, int);
  ///@}

  /**
   * Paths through each pixel of the last picture; 0 before one.
   */
  vtkGetMacro(RenderedSamplesPerPixel, int);

  ///@{
  /**
   * Scatterings of a path, at the most. Default 0: any number. 1 gives single scattering, what
   * vtkBrumeRayMarchMapper draws without octaves.
   */
  vtkSetClampMacro(MaximumScatterings, int, 0, VTK_INT_MAX);
  vtkGetMacro(MaximumScatterings, int);
  ///@}

  ///@{
  /**
   * Seconds that the paths of a picture may take; at least one path a pixel is traced. Default 0: no
   * limit. Negative values are set to 0. With a limit the number of paths, and so the noise, is
   * the machine's.
   */
  vtkSetClampMacro(TimeBudget, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TimeBudget, double);
  ///@}

  ///@{
  /**
   * Chooses one of all pictures of the same noise. Default 1.
   */
  vtkSetMacro(Seed, unsigned int);
  vtkGetMacro(Seed, unsigned int);
  ///@}

protected:
  vtkBrumePathTraceMapper();
  ~vtkBrumePathTraceMapper() override;
  bool RenderScene(brume::Scene& scene, brume::Film& film) override;
  void AppendIgnoredSettings(vtkVolume* volume, std::vector<std::string>& names) override;

  int SamplesPerPixel = 64;
  int SamplesPerRender = 0;
  int RenderedSamplesPerPixel = 0;
  int MaximumScatterings = 0;
  double TimeBudget = 0.0;
  unsigned int Seed = 1;

private:
  vtkBrumePathTraceMapper(const vtkBrumePathTraceMapper&) = delete;
  void operator=(const vtkBrumePathTraceMapper&) = delete;

  struct Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
