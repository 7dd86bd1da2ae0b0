/**
 * @class   vtkBrumeSky
 * @brief   light from all around: sky, ground, and an environment map
 *
 * Lights the media that mappers draw, beside the renderer's lights. Sky and ground are two even
 * halves of the sphere, dimmed by the matter above and below a place. An environment map becomes
 * directional lights, which cast shadows; vtkBrumePathTraceMapper takes it as it is.
 *
 * @code
 * vtkNew<vtkBrumeSky> sky;
 * sky->SetSkyRadiance(0.2, 0.3, 0.5);
 * mapper->SetSky(sky);
 * @endcode
 *
 * It is not drawn: the background is the renderer's. A sky may serve any number of mappers. Values
 * that are not finite are refused with a warning and the old ones kept.
 */
#ifndef vtkBrumeSky_h
#define vtkBrumeSky_h

#include "vtkBrumeMediumModule.h"
#include "vtkObject.h"

#include <memory> // for std::unique_ptr
#include <string> // for std::string
#include <vector> // for std::vector

class vtkImageData;

namespace brume
{
struct Light;
struct PlacedEnvironment;
struct Sky;
}

class VTKBRUMEMEDIUM_EXPORT vtkBrumeSky : public vtkObject
{
public:
  static vtkBrumeSky* New();
  vtkTypeMacro(vtkBrumeSky, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Radiance of the half of the sphere around Up, R, G, B. Default 0, 0, 0. A white surface under
   * an open sky of radiance 1 has the radiance 1. Negative values are set to 0.
   */
  void SetSkyRadiance(double red, double green, double blue);
  void SetSkyRadiance(const double rgb[3]) { this->SetSkyRadiance(rgb[0], rgb[1], rgb[2]); }
  vtkGetVector3Macro(SkyRadiance, double);
  ///@}

  ///@{
  /**
   * Radiance of the other half, as the ground sends it up. Default 0, 0, 0. Negative values are set
   * to 0.
   */
  void SetGroundRadiance(double red, double green, double blue);
  void SetGroundRadiance(const double rgb[3]) { this->SetGroundRadiance(rgb[0], rgb[1], rgb[2]); }
  vtkGetVector3Macro(GroundRadiance, double);
  ///@}

  ///@{
  /**
   * The direction away from the ground in the world; any length, made 1. Default 0, 0, 1. A vector
   * of length 0 is refused with a warning.
   */
  void SetUp(double x, double y, double z);
  void SetUp(const double direction[3]) { this->SetUp(direction[0], direction[1], direction[2]); }
  vtkGetVector3Macro(Up, double);
  ///@}

  ///@{
  /**
   * Radiance from all directions, seen from the scene: a latitude–longitude image of one slice, its
   * point scalars R, G, B (linear; further components are not read), rows from the bottom up. The
   * last row is at Up, the first one opposite, the columns go all round. Seen from inside, with
   * Up upward, the picture is upright and not mirrored. With Up = z the middle of the map lies
   * toward +y and what is right of it toward +x; with Up = y, toward −z and +x; for another Up all
   * that is turned the shortest way from z. Values that are negative or not finite count as 0.
   * Default null: none. vtkBrumeEnvironmentReader reads one.
   */
  virtual void SetEnvironmentMap(vtkImageData* map);
  vtkImageData* GetEnvironmentMap();
  ///@}

  ///@{
  /**
   * Turns the map about Up, by the right hand, in degrees. Default 0.
   */
  void SetEnvironmentRotation(double degrees);
  vtkGetMacro(EnvironmentRotation, double);
  ///@}

  ///@{
  /**
   * How many directional lights the map becomes: the sphere is cut into so many regions of about
   * the same energy (median cut, Debevec 2005), each a light at its middle that has all of the
   * region's irradiance. More are closer to the map and take longer. Fewer come out where fewer
   * pixels are above 0. Default 16. Range 1 to 1024; values outside are clamped.
   */
  vtkSetClampMacro(NumberOfEnvironmentLights, int, 1, 1024);
  vtkGetMacro(NumberOfEnvironmentLights, int);
  ///@}

#ifndef __VTK_WRAP__
  /**
   * Sky and ground as Transport has them.
   */
  void FillSky(brume::Sky& sky) const;

  /**
   * Adds the lights of the environment map. They are kept while the map and the settings stay.
   * Returns an empty string, or what is wrong with the map and what to do.
   */
  std::string AppendEnvironmentLights(std::vector<brume::Light>& lights);

  /**
   * The environment map itself, for integrators that need no lights in its place: the lights that
   * AppendEnvironmentLights added last are taken off the list again. Null: there is none.
   */
  std::shared_ptr<const brume::PlacedEnvironment> TakeEnvironment(
    std::vector<brume::Light>& lights);
#endif

  /**
   * The map's own changes count, too.
   */
  vtkMTimeType GetMTime() override;

protected:
  vtkBrumeSky();
  ~vtkBrumeSky() override;

private:
  vtkBrumeSky(const vtkBrumeSky&) = delete;
  void operator=(const vtkBrumeSky&) = delete;

  double SkyRadiance[3] = { 0.0, 0.0, 0.0 };
  double GroundRadiance[3] = { 0.0, 0.0, 0.0 };
  double Up[3] = { 0.0, 0.0, 1.0 };
  double EnvironmentRotation = 0.0;
  int NumberOfEnvironmentLights = 16;

  struct Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
