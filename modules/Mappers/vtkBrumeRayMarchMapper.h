/**
 * @class   vtkBrumeRayMarchMapper
 * @brief   marches rays through a volume on the CPU; a drop-in for VTK's ray casters
 *
 * With a plain vtkVolumeProperty the picture is the one that VTK's ray-cast mappers draw, free of
 * their step and table errors. In COMPOSITE_BLEND: emission and absorption by transfer functions,
 * σt = −ln(1 − opacity) / ScalarOpacityUnitDistance, gradient opacity, and shading by the
 * renderer's lights. Each step is a stretch of constant extinction and source, sampled at its
 * middle, and the last step of a ray is cut where the volume ends; halving the step changes the
 * picture by no more than its error. Maximum, minimum and average intensity, additive and
 * isosurface blending, cropping, clipping planes, masks, several components and 2D transfer
 * functions are there as in VTK.
 *
 * The settings have the names that they have in vtkFixedPointVolumeRayCastMapper and
 * vtkOpenGLGPUVolumeRayCastMapper. docs/user/drop-in.md tells of each what it does here, and
 * docs/theory has the formulas.
 */
#ifndef vtkBrumeRayMarchMapper_h
#define vtkBrumeRayMarchMapper_h

#include "vtkBrumeMappersModule.h"
#include "vtkBrumeVolumeMapper.h"

#include <memory> // for std::unique_ptr
#include <string> // for std::string
#include <vector> // for std::vector

class vtkContourValues;
class vtkRenderWindow;
class vtkVolumeProperty;

class VTKBRUMEMAPPERS_EXPORT vtkBrumeRayMarchMapper : public vtkBrumeVolumeMapper
{
public:
  static vtkBrumeRayMarchMapper* New();
  vtkTypeMacro(vtkBrumeRayMarchMapper, vtkBrumeVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether the mapper looks after quality and speed. On, the default:
   *
   * - Steps are chosen by the tolerance: the cheapest, of 4 to 1/32 of the smallest voxel edge, with
   *   which the estimated error is within three quarters of Tolerance (with a medium a quarter, and
   *   another for shadows), shorter only in the pixels that ask for it where these are few; the choice is made from 4096
   *   rays of the first picture's camera and kept while data, property, medium, lights and tolerance
   *   stay. Off: always the midpoint rule.
   * - The distance between rays is chosen by the time that VTK allocates to the volume, from
   *   vtkRenderWindow::SetDesiredUpdateRate: one ray a pixel where the last picture was fast
   * enough, fewer where it was not, within MinimumImageSampleDistance and
   * MaximumImageSampleDistance. The first picture, and each one with time enough (an interactor's
   * StillUpdateRate), is whole.
   *
   * Off: SampleDistance and ImageSampleDistance.
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

  ///@{
  /**
   * Whether, with AutoAdjustSampleDistances off, the distance between samples comes from the
   * spacing in place of SampleDistance: half the mean edge of a voxel for volumes of 100³ voxels
   * and more, and less, down to a hundredth of it, for smaller ones, as VTK has it. Default off.
   */
  vtkSetClampMacro(LockSampleDistanceToInputSpacing, vtkTypeBool, 0, 1);
  vtkGetMacro(LockSampleDistanceToInputSpacing, vtkTypeBool);
  vtkBooleanMacro(LockSampleDistanceToInputSpacing, vtkTypeBool);
  ///@}

  enum ShadowMethods
  {
    AutomaticShadows = 0,
    NoShadows,
    RayShadows,
    VolumeShadows,
    FunctionShadows
  };

  ///@{
  /**
   * How the light that reaches a place in a medium is found to be dimmed on its way. Without a medium
   * it means nothing.
   *
   * - Automatic, the default: the cheapest whose error is estimated to be within a quarter of the
   *   tolerance, by a few hundred rays; chosen anew when the medium changes.
   * - None: matter casts no shadows.
   * - Rays: a ray toward each light from each sample. Right, and dear.
   * - Volume: optical depths toward each light on a grid, kept while lights and medium stay.
   * - Functions: for each light a map of functions of depth. Little memory, soft shadows.
   */
  vtkSetClampMacro(ShadowMethod, int, AutomaticShadows, FunctionShadows);
  vtkGetMacro(ShadowMethod, int);
  void SetShadowMethodToAutomatic() { this->SetShadowMethod(AutomaticShadows); }
  void SetShadowMethodToNone() { this->SetShadowMethod(NoShadows); }
  void SetShadowMethodToRays() { this->SetShadowMethod(RayShadows); }
  void SetShadowMethodToVolume() { this->SetShadowMethod(VolumeShadows); }
  void SetShadowMethodToFunctions() { this->SetShadowMethod(FunctionShadows); }
  ///@}

  ///@{
  /**
   * The length of a shadow ray's step, or the distance between the nodes of a shadow volume or map,
   * in the data's coordinates. Default 0: chosen, with AutomaticShadows; else one voxel edge, and
   * rays through one density go cell by cell, which is exact. Values that are negative or not finite are refused
   * with a warning.
   */
  virtual void SetShadowSampleDistance(double distance);
  vtkGetMacro(ShadowSampleDistance, double);
  ///@}

  ///@{
  /**
   * Whether the plan of effects that was made for another view is good enough: for pictures that
   * move, whose next one is to be there at once. Without lit media plans hold for all views. Default
   * off: lit scenes are planned for each view.
   */
  vtkSetClampMacro(ReusePlan, vtkTypeBool, 0, 1);
  vtkGetMacro(ReusePlan, vtkTypeBool);
  vtkBooleanMacro(ReusePlan, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Pixels between rays, in a window, when AutoAdjustSampleDistances is off. 1, the default: one
   * ray a pixel. 2: a ray for 2 × 2 pixels, interpolated between them. ½: 2 × 2 rays for each
   * pixel, averaged; below 1 the nearest whole number of them is taken. Range 0.1 to 100; values
   * outside are clamped. Pictures without a window have one ray a pixel.
   */
  vtkSetClampMacro(ImageSampleDistance, float, 0.1f, 100.0f);
  vtkGetMacro(ImageSampleDistance, float);
  ///@}

  ///@{
  /**
   * The bounds of what AutoAdjustSampleDistances may choose. Defaults 1 and 10, range 0.1 to 100;
   * values outside are clamped. A minimum below 1 asks for several rays a pixel when there is time.
   */
  vtkSetClampMacro(MinimumImageSampleDistance, float, 0.1f, 100.0f);
  vtkGetMacro(MinimumImageSampleDistance, float);
  vtkSetClampMacro(MaximumImageSampleDistance, float, 0.1f, 100.0f);
  vtkGetMacro(MaximumImageSampleDistance, float);
  ///@}

  ///@{
  /**
   * Whether each ray begins a part of a step of its own further on, which turns the bands of steps
   * that are too long into noise. The parts depend on the pixel alone: the same scene gives the
   * same picture. Default off.
   */
  vtkSetClampMacro(UseJittering, vtkTypeBool, 0, 1);
  vtkGetMacro(UseJittering, vtkTypeBool);
  vtkBooleanMacro(UseJittering, vtkTypeBool);
  ///@}

  ///@{
  /**
   * The distance between rays with which a picture of the volume would take so many seconds, by the
   * last one, within the bounds above; and the seconds that it would take with one ray a pixel, 0
   * before the first. Without a volume: of the one that this mapper drew.
   */
  float ComputeRequiredImageSampleDistance(float desiredTime,
    vtkRenderer* renderer,
    vtkVolume* volume = nullptr);
  float GetEstimatedRenderTime(vtkRenderer* renderer, vtkVolume* volume = nullptr);
  ///@}

  /**
   * Whether the mapper can draw in this window with this property. Always: 1.
   */
  virtual int IsRenderSupported(vtkRenderWindow*, vtkVolumeProperty*) { return 1; }

  ///@{
  /**
   * Settings of the stock mappers that nothing here needs. A value other than the stock mapper's
   * default is kept, does nothing, and warns once, by name, at the next render.
   */
  vtkSetMacro(InteractiveSampleDistance, float);
  vtkGetMacro(InteractiveSampleDistance, float);
  vtkSetClampMacro(UseDepthPass, vtkTypeBool, 0, 1);
  vtkGetMacro(UseDepthPass, vtkTypeBool);
  vtkBooleanMacro(UseDepthPass, vtkTypeBool);
  vtkContourValues* GetDepthPassContourValues();
  vtkSetMacro(MaxMemoryInBytes, vtkIdType);
  vtkGetMacro(MaxMemoryInBytes, vtkIdType);
  vtkSetClampMacro(MaxMemoryFraction, float, 0.1f, 1.0f);
  vtkGetMacro(MaxMemoryFraction, float);
  vtkSetMacro(RenderToImage, vtkTypeBool);
  vtkGetMacro(RenderToImage, vtkTypeBool);
  vtkBooleanMacro(RenderToImage, vtkTypeBool);
  vtkSetMacro(DepthImageScalarType, int);
  vtkGetMacro(DepthImageScalarType, int);
  void SetDepthImageScalarTypeToUnsignedChar() { this->SetDepthImageScalarType(VTK_UNSIGNED_CHAR); }
  void SetDepthImageScalarTypeToUnsignedShort()
  {
    this->SetDepthImageScalarType(VTK_UNSIGNED_SHORT);
  }
  void SetDepthImageScalarTypeToFloat() { this->SetDepthImageScalarType(VTK_FLOAT); }
  vtkSetMacro(ClampDepthToBackface, vtkTypeBool);
  vtkGetMacro(ClampDepthToBackface, vtkTypeBool);
  vtkBooleanMacro(ClampDepthToBackface, vtkTypeBool);
  vtkSetMacro(ColorRangeType, int);
  vtkGetMacro(ColorRangeType, int);
  vtkSetMacro(ScalarOpacityRangeType, int);
  vtkGetMacro(ScalarOpacityRangeType, int);
  vtkSetMacro(GradientOpacityRangeType, int);
  vtkGetMacro(GradientOpacityRangeType, int);
  vtkSetStdStringFromCharMacro(Transfer2DYAxisArray);
  vtkGetCharFromStdStringMacro(Transfer2DYAxisArray);
  void SetPartitions(unsigned short x, unsigned short y, unsigned short z);
  ///@}

  enum TFRangeType
  {
    SCALAR = 0,
    NATIVE
  };

protected:
  vtkBrumeRayMarchMapper();
  ~vtkBrumeRayMarchMapper() override;

  bool RenderScene(brume::Scene& scene, brume::Film& film) override;
  double ChooseImageSampleDistance(vtkRenderer* renderer,
    vtkVolume* volume,
    double allocated) override;
  void AppendIgnoredSettings(vtkVolume* volume, std::vector<std::string>& names) override;

private:
  vtkBrumeRayMarchMapper(const vtkBrumeRayMarchMapper&) = delete;
  void operator=(const vtkBrumeRayMarchMapper&) = delete;

  double FixedStep();

  vtkTypeBool AutoAdjustSampleDistances = 1;
  double SampleDistance = 1.0;
  vtkTypeBool LockSampleDistanceToInputSpacing = 0;
  float ImageSampleDistance = 1.0f;
  float MinimumImageSampleDistance = 1.0f;
  float MaximumImageSampleDistance = 10.0f;
  vtkTypeBool ReusePlan = 0;
  vtkTypeBool UseJittering = 0;
  int ShadowMethod = AutomaticShadows;
  double ShadowSampleDistance = 0.0;

  float InteractiveSampleDistance = 2.0f;
  vtkTypeBool UseDepthPass = 0;
  vtkIdType MaxMemoryInBytes = 0;
  float MaxMemoryFraction = 0.75f;
  vtkTypeBool RenderToImage = 0;
  int DepthImageScalarType = VTK_FLOAT;
  vtkTypeBool ClampDepthToBackface = 0;
  int ColorRangeType = SCALAR;
  int ScalarOpacityRangeType = SCALAR;
  int GradientOpacityRangeType = SCALAR;
  std::string Transfer2DYAxisArray;
  unsigned short Partitions[3] = { 1, 1, 1 };

  struct Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
