/**
 * @class   vtkBrumeFogSource
 * @brief   fog banks: homogeneous, thinning with the height, in valleys
 *
 * Gives the density of fog, dense or sparse, at any moment (vtkBrumeFieldSource says how). Point
 * scalars are named "density" and lie in [0, 1], without a unit: multiply by the extinction of the
 * thickest fog per metre (0.04 for a visibility of 100 m, 0.004 for 1 km) to get the medium's.
 *
 * World units are metres, x and y around 0, z up. The formulas: data-generators/fog_bank.h.
 *
 * Valley fog fills the hollows of the ground. The optional input is its height map: a vtkImageData
 * with one layer of voxels along z, whose scalars (their first component) are heights in metres,
 * standing where its origin and spacing place them; beyond its ends the ground goes on level. With
 * no input the source makes hills of its own (height_map.h, valley_terrain), of Relief and Width;
 * GetGround() hands them out. The map is brought up to date when the volume's extent is asked for,
 * which follows from it. It has one moment: a map with several TIME_STEPS is an error.
 *
 * @sa vtkBrumeCloudSource vtkBrumeFieldSource vtkBrumeFog
 */
#ifndef vtkBrumeFogSource_h
#define vtkBrumeFogSource_h

#include "vtkBrumeFieldSource.h"
#include "vtkBrumeSourcesModule.h" // for the export macro

class vtkImageData;

class VTKBRUMESOURCES_EXPORT vtkBrumeFogSource : public vtkBrumeFieldSource
{
public:
  static vtkBrumeFogSource* New();
  vtkTypeMacro(vtkBrumeFogSource, vtkBrumeFieldSource);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Kinds
  {
    KindHomogeneous = 0, ///< the same everywhere in its box
    KindHeight,          ///< thinner the higher, in swathes
    KindValley           ///< what has gathered in the hollows of a height map
  };

  ///@{
  /**
   * What fog it is. Default KindHeight; other values become the nearest.
   */
  vtkSetClampMacro(Kind, int, KindHomogeneous, KindValley);
  vtkGetMacro(Kind, int);
  void SetKindToHomogeneous() { this->SetKind(KindHomogeneous); }
  void SetKindToHeight() { this->SetKind(KindHeight); }
  void SetKindToValley() { this->SetKind(KindValley); }
  ///@}

  ///@{
  /**
   * Width of the box, in metres. Default 4000, range 1 to 1e6; outside it the nearest end.
   */
  vtkSetClampMacro(Width, double, 1.0, 1e6);
  vtkGetMacro(Width, double);
  ///@}

  ///@{
  /**
   * Heights of the box's floor and ceiling, in metres, for homogeneous and height fog; valley fog
   * has its box from its ground. Default 0 and 400, any finite values, the base below the top.
   */
  vtkSetMacro(BaseHeight, double);
  vtkGetMacro(BaseHeight, double);
  vtkSetMacro(TopHeight, double);
  vtkGetMacro(TopHeight, double);
  ///@}

  ///@{
  /**
   * Height over which height fog thins to 1/e, in metres. Default 90, range 0.1 to 1e6; outside it
   * the nearest end.
   */
  vtkSetClampMacro(ScaleHeight, double, 0.1, 1e6);
  vtkGetMacro(ScaleHeight, double);
  ///@}

  ///@{
  /**
   * How much the noise takes at most from height and valley fog: 0 none, 1 all. Without a unit,
   * default 0.6, range 0 to 1; outside it the nearest end.
   */
  vtkSetClampMacro(Noise, double, 0.0, 1.0);
  vtkGetMacro(Noise, double);
  ///@}

  ///@{
  /**
   * Size of the noise's largest features, level, in metres; they are a third as high. Default 400,
   * range 0.1 to 1e6; outside it the nearest end.
   */
  vtkSetClampMacro(DetailSize, double, 0.1, 1e6);
  vtkGetMacro(DetailSize, double);
  ///@}

  ///@{
  /**
   * Octaves of the noise, each half as large and half as strong as the one before. Default 5, range
   * 1 to 8; outside it the nearest end.
   */
  vtkSetClampMacro(Octaves, int, 1, 8);
  vtkGetMacro(Octaves, int);
  ///@}

  ///@{
  /**
   * Fraction of the height map that lies under valley fog. Without a unit, default 0.45, range 0 to
   * 1; outside it the nearest end.
   */
  vtkSetClampMacro(Coverage, double, 0.0, 1.0);
  vtkGetMacro(Coverage, double);
  ///@}

  ///@{
  /**
   * Depth below its surface at which valley fog is at its full density, in metres. Default 60,
   * range 0.1 to 1e5; outside it the nearest end.
   */
  vtkSetClampMacro(Softness, double, 0.1, 1e5);
  vtkGetMacro(Softness, double);
  ///@}

  ///@{
  /**
   * How far valley fog goes on under the ground, in metres, so that interpolation at the ground
   * finds fog on both sides: a voxel or two. Default 30, range 0 to 1e5; outside it the nearest
   * end.
   */
  vtkSetClampMacro(Sink, double, 0.0, 1e5);
  vtkGetMacro(Sink, double);
  ///@}

  ///@{
  /**
   * Height of the hills that stand in where there is no height map, in metres. Default 500, range 0
   * to 1e5; outside it the nearest end.
   */
  vtkSetClampMacro(Relief, double, 0.0, 1e5);
  vtkGetMacro(Relief, double);
  ///@}

  ///@{
  /**
   * The wind that carries the noise, in metres a second along x, y and z. Default (1.5, 0.5, 0),
   * any finite value.
   */
  vtkSetVector3Macro(Wind, double);
  vtkGetVector3Macro(Wind, double);
  ///@}

  /**
   * Fills an image with the ground of valley fog as the present settings have it: floats named
   * "height", one layer at z = 0. Of other kinds it empties the image.
   */
  void GetGround(vtkImageData* image);

protected:
  vtkBrumeFogSource();
  ~vtkBrumeFogSource() override;

  std::shared_ptr<const brume::Field> MakeField() override;
  vtkMTimeType GetFieldMTime() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int Kind = KindHeight;
  double Width = 4000.0;
  double BaseHeight = 0.0;
  double TopHeight = 400.0;
  double ScaleHeight = 90.0;
  double Noise = 0.6;
  double DetailSize = 400.0;
  int Octaves = 5;
  double Coverage = 0.45;
  double Softness = 60.0;
  double Sink = 30.0;
  double Relief = 500.0;
  double Wind[3] = { 1.5, 0.5, 0.0 };

private:
  vtkBrumeFogSource(const vtkBrumeFogSource&) = delete;
  void operator=(const vtkBrumeFogSource&) = delete;

  // The input, brought up to date; null where there is none. Throws std::invalid_argument where it
  // has several moments.
  vtkImageData* UpdateHeightMap();
};

#endif
