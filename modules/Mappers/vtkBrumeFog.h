/**
 * @class   vtkBrumeFog
 * @brief   fog without bounds: a prop that is drawn over all that a renderer shows
 *
 * Homogeneous fog, or fog in layers that thins out upward:
 *
 * @code
 * vtkNew<vtkBrumeFog> fog;
 * fog->SetExtinction(0.002); // per world unit: half of the light is gone after 350
 * fog->SetFalloff(0.02);     // thins out to 1/e in 50
 * renderer->AddViewProp(fog);
 * @endcode
 *
 * The extinction coefficient at a place of the world is
 *
 *     σt = extinction · e^(−falloff · (height − base height)),
 *
 * the height being measured along the sky's Up (z without a sky). The fog dims what is behind it and
 * scatters the light of the renderer's lights and of its sky, both in closed form, without steps
 * (docs/theory/fog.md). It begins at the viewer's eye and has no far plane: pixels that show no
 * surface look through all of it.
 *
 * With volumes whose mappers are Brume's it is drawn as one, in front of them, in them, between and
 * behind them: of volumes in composite mode with CombineVolumes on, the first in the renderer's order
 * and those of the same mapper's class are drawn together with the fog, whether they overlap or not.
 * They throw their shadows on the fog inside of their boxes, and the fog dims the light that gets to
 * them. Their shadows on the fog outside of their boxes are left out. Other volumes, and those of other
 * mappers, are drawn over or under the fog, in the renderer's order.
 *
 * One fog to a renderer: further ones are drawn over the picture by themselves.
 *
 * The fog needs no window: RenderFilm() draws it alone, vtkBrumeVolumeMapper::SetFog() with volumes.
 *
 * Values that are not finite are refused with a warning and the old ones kept; others are clamped.
 */
#ifndef vtkBrumeFog_h
#define vtkBrumeFog_h

#include "vtkBrumeMappersModule.h"
#include "vtkProp.h"

#include <functional> // for std::function
#include <memory>     // for std::unique_ptr
#include <vector>     // for std::vector

class vtkBrumeSky;
class vtkCamera;
class vtkLightCollection;
class vtkRenderer;

namespace brume
{
struct Film;
struct Fog;
}

class VTKBRUMEMAPPERS_EXPORT vtkBrumeFog : public vtkProp
{
public:
  static vtkBrumeFog* New();
  vtkTypeMacro(vtkBrumeFog, vtkProp);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Extinction coefficient at the base height, absorption and scattering together, per world unit,
   * for R, G and B; one number is for all three. Default 0.001. Negative values are set to 0.
   */
  void SetExtinction(double red, double green, double blue);
  void SetExtinction(const double rgb[3]) { this->SetExtinction(rgb[0], rgb[1], rgb[2]); }
  void SetExtinction(double every) { this->SetExtinction(every, every, every); }
  vtkGetVector3Macro(Extinction, double);
  ///@}

  ///@{
  /**
   * Single-scattering albedo, the part of the light taken from a ray that is sent on in another
   * direction, for R, G and B. Default 1, 1, 1: nothing is absorbed. Range 0 to 1; values outside
   * are clamped.
   */
  void SetAlbedo(double red, double green, double blue);
  void SetAlbedo(const double rgb[3]) { this->SetAlbedo(rgb[0], rgb[1], rgb[2]); }
  void SetAlbedo(double every) { this->SetAlbedo(every, every, every); }
  vtkGetVector3Macro(Albedo, double);
  ///@}

  ///@{
  /**
   * Adds a part to the phase function, as vtkBrumeMedium has them. A weight that is not positive is
   * refused with a warning; the anisotropy is clamped to ±0.9999. No lobe, the default, is isotropic.
   */
  void AddIsotropicLobe(double weight = 1.0);
  void AddRayleighLobe(double weight = 1.0);
  void AddHenyeyGreensteinLobe(double weight, double anisotropy);
  void AddSchlickLobe(double weight, double anisotropy);
  void RemoveAllLobes();
  int GetNumberOfLobes() const;
  ///@}

  ///@{
  /**
   * One number for the phase function: setting it puts one Henyey–Greenstein lobe of this g in the
   * place of all lobes, or none for 0; got is the mean of cos θ. Default 0. Clamped to ±0.9999.
   */
  void SetAnisotropy(double anisotropy);
  double GetAnisotropy() const;
  ///@}

  ///@{
  /**
   * How fast the fog thins out upward: per world unit, by a factor e^(−falloff). Default 0: the same
   * everywhere. Negative values are set to 0; for fog that thickens upward turn the sky's Up round.
   *
   * Without falloff there is fog all the way to lights at infinity and to the sky: they light it
   * undimmed. With falloff they are dimmed by the layers above a place; a light at or under the
   * horizon then does not light it, and the ground's light does not get up through ever denser
   * layers.
   */
  void SetFalloff(double falloff);
  vtkGetMacro(Falloff, double);
  ///@}

  ///@{
  /**
   * The height at which the extinction is Extinction, in world units along Up. Default 0.
   */
  void SetBaseHeight(double height);
  vtkGetMacro(BaseHeight, double);
  ///@}

  ///@{
  /**
   * Light from all around, and the direction upward. Where the fog is drawn as one with volumes, its
   * sky, if it has one, lights them all. Default null: no such light; upward is z.
   */
  virtual void SetSky(vtkBrumeSky* sky);
  vtkBrumeSky* GetSky();
  ///@}

  ///@{
  /**
   * Threads that render. Default 0: as many as the machine has processors. Range 0 to 1024; values
   * outside are clamped. The picture is the same, bit for bit, for every number.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, 1024);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

#ifndef __VTK_WRAP__
  /**
   * Draws the fog alone, without a window: the camera's view, lit by `lights` (null: a headlight). The
   * film's size is the picture's. The fog ends at surfaces whose depth is given as
   * vtkBrumeVolumeMapper::SetSurfaceDepth() takes it; empty: none. `progress`, if there is one, is told the
   * part that is done, in [0, 1], in the calling thread, and returns whether to go on. Returns false where
   * it ended the render, and after a vtkErrorMacro where nothing was drawn.
   */
  bool RenderFilm(vtkCamera* camera,
    vtkLightCollection* lights,
    brume::Film& film,
    const std::vector<float>& surface_depth = {},
    const std::function<bool(double)>& progress = {});

  /**
   * The settings as Transport has them.
   */
  void FillFog(brume::Fog& fog) const;
#endif

  /**
   * Draws into the renderer's frame, at its turn among the volumes. Called by VTK.
   */
  int RenderVolumetricGeometry(vtkViewport* viewport) override;

  /**
   * Null: fog has no bounds. Cameras are fitted to the other props.
   */
  double* GetBounds() VTK_SIZEHINT(6) override { return nullptr; }

  /**
   * The sky's changes count, too.
   */
  vtkMTimeType GetRedrawMTime() override;

  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkBrumeFog();
  ~vtkBrumeFog() override;

private:
  vtkBrumeFog(const vtkBrumeFog&) = delete;
  void operator=(const vtkBrumeFog&) = delete;

  friend class vtkBrumeVolumeMapper;

  void AddLobe(int function, double weight, double anisotropy);
  void DrawAlone(vtkRenderer* renderer);

  double Extinction[3] = { 0.001, 0.001, 0.001 };
  double Albedo[3] = { 1.0, 1.0, 1.0 };
  double Falloff = 0.0;
  double BaseHeight = 0.0;
  int NumberOfThreads = 0;

  struct Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
