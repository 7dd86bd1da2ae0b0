/**
 * @class   vtkBrumeVolumeMapper
 * @brief   what all of Brume's volume mappers share: a tolerance, statistics, and a way without a
 * window
 *
 * A vtkBrumeVolumeMapper takes the place of one of VTK's volume mappers:
 *
 * @code
 * vtkNew<vtkBrumeRayMarchMapper> mapper; // was: vtkFixedPointVolumeRayCastMapper
 * mapper->SetInputConnection(reader->GetOutputPort());
 * volume->SetMapper(mapper);
 * @endcode
 *
 * It reads the vtkVolumeProperty, the renderer's lights and camera and the prop's matrix as VTK's
 * mappers do, makes its picture on the CPU, and blends it into the frame. Opaque geometry that was
 * drawn before hides what is behind it. Input is a vtkImageData of any type, points or cells: of
 * one to four independent components, of two dependent ones (colour, opacity), or of four dependent
 * ones of unsigned char (red, green, blue, opacity). Or a vtkBrumeSparseVolume, which stays sparse.
 *
 * RenderFilm() and RenderImage() make the same picture with no window, no OpenGL and no display.
 *
 * Lengths (sample distance, opacity unit distance) are measured in the data's own coordinates,
 * before the prop's matrix, as in VTK. A setting of VTK's that is not followed
 * warns once, by name. docs/dev/units.md has all conventions.
 *
 * Events: vtkCommand::StartEvent, ProgressEvent (from the calling thread, GetProgress() in [0, 1])
 * and EndEvent around a render. A render stops, and draws nothing, when an observer calls
 * AbortExecuteOn() or when the render window's abort check asks for it.
 */
#ifndef vtkBrumeVolumeMapper_h
#define vtkBrumeVolumeMapper_h

#include "vtkBrumeMappersModule.h"
#include "vtkVolumeMapper.h"

#include <memory> // for std::unique_ptr
#include <string> // for std::string
#include <vector> // for std::vector

class vtkBrumeEffectPlan;
class vtkBrumeFog;
class vtkBrumeMedium;
class vtkBrumeSky;
class vtkCamera;
class vtkImageData;
class vtkLightCollection;
class vtkVolumeCollection;

namespace brume
{
struct Film;
struct Scene;
struct ViewFromVTK;
}

class VTKBRUMEMAPPERS_EXPORT vtkBrumeVolumeMapper : public vtkVolumeMapper
{
public:
  vtkTypeMacro(vtkBrumeVolumeMapper, vtkVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The largest error of a pixel that is accepted for speed, as a fraction of white: a quarter of
   * it for leaving rays early, the rest for steps. Default 0.004, about one level of an 8-bit
   * screen. Range 0 (exact as can be) to 1; values outside are clamped.
   */
  vtkSetClampMacro(Tolerance, double, 0.0, 1.0);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * Threads that render. Default 0: as many as the machine has processors. Range 0 to 1024; values
   * outside are clamped. The picture is the same, bit for bit, for every number.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, 1024);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * Whether surfaces are lit from both sides in renders without a renderer. In a renderer its own
   * TwoSidedLighting counts. Default on, as in vtkRenderer.
   */
  vtkSetMacro(TwoSidedLighting, vtkTypeBool);
  vtkGetMacro(TwoSidedLighting, vtkTypeBool);
  vtkBooleanMacro(TwoSidedLighting, vtkTypeBool);
  ///@}

  ///@{
  /**
   * A mask, as vtkGPUVolumeRayCastMapper has it: an image of one component of unsigned char over
   * the volume's own voxels. One of other dimensions is stretched over the volume and read at the
   * nearest of its voxels. Default null: none.
   */
  virtual void SetMaskInput(vtkImageData* mask);
  vtkImageData* GetMaskInput();
  ///@}

  enum
  {
    BinaryMaskType = 0,
    LabelMapMaskType
  };

  ///@{
  /**
   * What the mask's voxels say. Binary: 0 hides the voxel, anything else shows it. Label map, the
   * default: 0 draws with the volume's own functions, and a label with those of
   * vtkVolumeProperty::SetLabelColor, SetLabelScalarOpacity and SetLabelGradientOpacity, or the
   * volume's own where it has none (but no gradient opacity). Of independent components a label map
   * is ignored with a warning.
   */
  vtkSetClampMacro(MaskType, int, BinaryMaskType, LabelMapMaskType);
  vtkGetMacro(MaskType, int);
  void SetMaskTypeToBinary() { this->SetMaskType(BinaryMaskType); }
  void SetMaskTypeToLabelMap() { this->SetMaskType(LabelMapMaskType); }
  ///@}

  ///@{
  /**
   * How much of a label's colour and opacity is its own rather than the volume's. Default 1: its
   * own alone. Range 0 to 1; values outside are clamped.
   */
  vtkSetClampMacro(MaskBlendFactor, float, 0.0f, 1.0f);
  vtkGetMacro(MaskBlendFactor, float);
  ///@}

  ///@{
  /**
   * Whether volumes that overlap are drawn as one in composite mode, with the sum of their
   * extinctions: of a renderer's visible volumes whose mappers are of the same class and have this
   * on, those whose bounds meet. The first of them that is drawn in a frame draws all, with its
   * mapper's tolerance, threads and sampling; each keeps its own property, mask, cropping, clipping
   * planes and matrix. Off: this volume is blended over what is in the frame, as the stock mappers
   * do. Default on.
   */
  vtkSetMacro(CombineVolumes, vtkTypeBool);
  vtkGetMacro(CombineVolumes, vtkTypeBool);
  vtkBooleanMacro(CombineVolumes, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Whether opaque geometry of the renderer hides what is behind it. Default on.
   */
  vtkSetClampMacro(IntermixIntersectingGeometry, vtkTypeBool, 0, 1);
  vtkGetMacro(IntermixIntersectingGeometry, vtkTypeBool);
  vtkBooleanMacro(IntermixIntersectingGeometry, vtkTypeBool);
  ///@}

  ///@{
  /**
   * A brightness window over the finished picture: radiance becomes
   * radiance / window + (½ − level / window) · opacity, not below 0. Default window 1, level ½: as
   * it is. The window may be negative, which turns brightness round; 0 is refused with a warning.
   */
  virtual void SetFinalColorWindow(float window);
  vtkGetMacro(FinalColorWindow, float);
  vtkSetMacro(FinalColorLevel, float);
  vtkGetMacro(FinalColorLevel, float);
  ///@}

  ///@{
  /**
   * Whether ProgressEvent is sent. Default on. Renders can be aborted either way.
   */
  vtkSetMacro(ReportProgress, bool);
  vtkGetMacro(ReportProgress, bool);
  ///@}

  ///@{
  /**
   * Extinction coefficient per unit of length and of value, for input that is a density of matter:
   * the property's functions are not read then, values below 0 count as 0, and without a medium the
   * matter absorbs and does not emit. Default 0: values are classified by the property. Negative
   * values are set to 0. One component only.
   */
  vtkSetClampMacro(Extinction, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Extinction, double);
  ///@}

  ///@{
  /**
   * What the matter does with light: it then scatters the light of the renderer's lights and of the
   * sky, and may glow. With an Extinction of the medium the values are a density of that, in place of
   * this mapper's Extinction; else they are what they are without it, and classified ones have their
   * colour as a factor of the albedo. Composite mode alone: in others a medium is ignored with a
   * warning. Default null: a classified volume sends its colour, a density absorbs.
   */
  virtual void SetMedium(vtkBrumeMedium* medium);
  vtkBrumeMedium* GetMedium();
  ///@}

  ///@{
  /**
   * Light from all around, for the medium; without one it is ignored with a warning. Of volumes that
   * are drawn as one, the sky of the first that has one lights all. Default null: none.
   */
  virtual void SetSky(vtkBrumeSky* sky);
  vtkBrumeSky* GetSky();
  ///@}

  ///@{
  /**
   * Fog for renders without a window: RenderFilm, RenderImage. In a window the vtkBrumeFog among the
   * renderer's props counts instead. Composite mode alone; in others there is no fog. Default null:
   * none.
   */
  virtual void SetFog(vtkBrumeFog* fog);
  vtkBrumeFog* GetFog();
  ///@}

  /**
   * Which effects the last picture simulated, and why, and what is forced for the next ones. Of
   * volumes that are drawn as one, the first's forces count. Never null.
   */
  vtkBrumeEffectPlan* GetEffectPlan();

  /**
   * The latest change of the mapper, its medium, its sky, its fog and what its plan is forced to.
   */
  vtkMTimeType GetMTime() override;

  /**
   * The bounds of the input, an image or a sparse volume, in its own coordinates.
   */
  using vtkVolumeMapper::GetBounds;
  double* GetBounds() VTK_SIZEHINT(6) override;

  /**
   * What the last render took and did, as a JSON object: mapper, seconds (the render alone),
   * seconds_prepare (scans, tables, step choice), samples, rays, threads, simd, effects (a list of
   * {name, on, reason, error_bound}), non_finite_voxels, radiometric, completed and what the mapper
   * adds. docs/user/statistics.md describes each. "{}" before the first render.
   */
  const std::string& GetStatistics() const { return this->Statistics; }

  /**
   * Draws into the renderer's frame. Called by VTK.
   */
  void Render(vtkRenderer* renderer, vtkVolume* volume) override;

  /**
   * Draws without a window: the camera's view of the volume over one background colour, as floats.
   * `image` becomes width × height × 1 points with the scalars "rgb", 3 components of float, linear,
   * rows from the bottom up. `lights` may be null: a headlight then. The camera's clipping range is
   * used as it is; vtkBrumeVolumeMapper::ResetClippingRange fits it to the volume. Returns false,
   * after a vtkErrorMacro, when there is nothing to draw or the render was aborted.
   */
  bool RenderImage(vtkVolume* volume, vtkCamera* camera, vtkLightCollection* lights, int width,
    int height, const double background[3], vtkImageData* image);

  ///@{
  /**
   * A thumbnail, as the stock mappers make it: the volume seen along a direction in parallel
   * projection, its width along x filling the picture, with another blend mode, without cropping,
   * lit from the viewer, over black. `image` has the picture's dimensions, and becomes red, green and
   * blue bytes.
   */
  void CreateCanonicalView(vtkVolume* volume, vtkImageData* image, int blendMode,
    double viewDirection[3], double viewUp[3]);
  void CreateCanonicalView(vtkRenderer*, vtkVolume* volume, vtkImageData* image, int blendMode,
    double viewDirection[3], double viewUp[3])
  {
    this->CreateCanonicalView(volume, image, blendMode, viewDirection, viewUp);
  }
  ///@}

  /**
   * Fits the camera's clipping range to the volume's bounds, as vtkRenderer::ResetCameraClippingRange
   * does for all props of a window.
   */
  static void ResetClippingRange(vtkVolume* volume, vtkCamera* camera);

#ifndef __VTK_WRAP__
  /**
   * As RenderImage, but all that a picture knows: radiance, transmittance, depth, error. The film's
   * size is the picture's.
   */
  bool RenderFilm(
    vtkVolume* volume, vtkCamera* camera, vtkLightCollection* lights, brume::Film& film);

  /**
   * Several volumes as one, with the sum of their extinctions: the first of `volumes` has this
   * mapper, and the others have mappers of the same class, one each, in composite mode.
   */
  bool RenderFilm(vtkVolumeCollection* volumes,
    vtkCamera* camera,
    vtkLightCollection* lights,
    brume::Film& film);

  /**
   * Opaque geometry for renders without a window: for each pixel the normalised device depth of the
   * nearest surface, in [-1, 1] (1: none), rows from the bottom up, as many as the film has. Rays end
   * there. Default empty: none. A render of another size fails with a vtkErrorMacro. In a window the
   * renderer's own depth counts.
   */
  void SetSurfaceDepth(std::vector<float> depth);

  /**
   * The scene as Transport sees it, brought up to date for a picture of this size; for measuring
   * pictures against brume::render_reference. Null, after a vtkErrorMacro, where there is nothing to
   * draw. Valid until the next call of any method of the mapper or change of its input.
   */
  const brume::Scene* UpdateScene(
    vtkVolume* volume, vtkCamera* camera, vtkLightCollection* lights, int width, int height);
#endif

  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkBrumeVolumeMapper();
  ~vtkBrumeVolumeMapper() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;

  /**
   * Fills the film with a picture of the scene. Subclasses report through ReportProgress, and put
   * what they did into Statistics. Returns whether the picture was completed.
   */
  virtual bool RenderScene(brume::Scene& scene, brume::Film& film) = 0;

  /**
   * To be called by RenderScene now and then, from the thread that called it: sends ProgressEvent,
   * asks the window, returns false when the render is to stop.
   */
  bool TellProgress(double fraction);

  /**
   * Pixels between rays for the volume's next picture in a window, below 1 for several rays a
   * pixel; 1 unless a subclass knows better. `allocated`: the seconds that VTK gives to it.
   */
  virtual double ChooseImageSampleDistance(vtkRenderer* renderer,
    vtkVolume* volume,
    double allocated);

  /// Adds settings that are not followed, as they stand now, by name.
  virtual void AppendIgnoredSettings(vtkVolume*, std::vector<std::string>&) {}

  /// Seconds that a picture of the volume in this renderer would have taken with one ray a pixel,
  /// by the last render; 0 before. Without a volume: of any.
  double GetSecondsOfPicture(vtkRenderer* renderer, vtkVolume* volume) const;

  /// The sky whose lights the scene that is being made has; null: none.
  vtkBrumeSky* GetSkyInUse() const { return this->SkyInUse; }

  /// Seconds that bringing the last scene up to date took.
  double SecondsScene = 0.0;
  /// Seconds of the last render alone; set by RenderScene.
  double SecondsRender = 0.0;
  /// Pixels between the rays of the picture that is being made.
  double ImageSampleDistanceInUse = 1.0;
  double Tolerance = 0.004;
  double Extinction = 0.0;
  int NumberOfThreads = 0;
  vtkTypeBool TwoSidedLighting = 1;
  vtkTypeBool CombineVolumes = 1;
  vtkTypeBool IntermixIntersectingGeometry = 1;
  int MaskType = LabelMapMaskType;
  float MaskBlendFactor = 1.0f;
  float FinalColorWindow = 1.0f;
  float FinalColorLevel = 0.5f;
  bool ReportProgress = true;
  std::string Statistics;
  /// Settings of the last scene's VTK objects that the mapper does not follow, by name.
  std::vector<std::string> IgnoredSettings;

private:
  vtkBrumeVolumeMapper(const vtkBrumeVolumeMapper&) = delete;
  void operator=(const vtkBrumeVolumeMapper&) = delete;

  brume::Scene* UpdateScene(vtkVolume* volume, const brume::ViewFromVTK& view);
  brume::Scene* UpdateScene(vtkVolume* first,
    const std::vector<vtkVolume*>& others,
    vtkBrumeFog* fog,
    const brume::ViewFromVTK& view);
  brume::Scene* JoinScenes(const brume::Scene& scene,
    const std::vector<vtkVolume*>& others,
    const brume::ViewFromVTK& view);
  bool RenderUpdated(brume::Scene& scene, brume::Film& film);
  /// The scene with the surfaces of SetSurfaceDepth; null where they are of another size.
  brume::Scene* WithSurfaceDepth(brume::Scene* scene, int width, int height);
  void WarnOfIgnoredSettings(vtkVolume* volume, int components);
  static bool MayJoin(vtkVolume* first, vtkVolume* other);
  /// Whether it is drawn as one with other volumes and fog.
  bool Combines() const;
  /// Draws the first volume that may be, with all that join, and the fog. Returns whether the fog was
  /// drawn.
  static bool RenderWithFog(vtkRenderer* renderer, vtkBrumeFog* fog);
  friend class vtkBrumeFog;

  vtkBrumeSky* SkyInUse = nullptr; ///< kept by who has it while a scene is made and drawn
  struct Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
