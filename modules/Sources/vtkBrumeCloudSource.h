/**
 * @class   vtkBrumeCloudSource
 * @brief   clouds: cumulus, layers, cirrus, cumulonimbus
 *
 * Gives the density of a cloud, dense or sparse, at any moment (vtkBrumeFieldSource says how).
 * Point scalars are named "density" and lie in [0, 1], without a unit: multiply by an extinction
 * per metre (0.02 to 0.1 for clouds of droplets, 0.0005 to 0.003 for cirrus) to get the medium's
 * extinction.
 *
 * World units are metres, x and y around 0, z up. A cumulus' box is Width x Width x 0.6 Width, with
 * its base at 0.08 Width, unless BaseHeight and TopHeight say otherwise; nothing of it comes nearer
 * to the box's faces than 0.02 Width, so all outer voxels are exactly 0 where voxels are no larger
 * than 0.04 Width (from Size = 26 on, unless the box is higher than wide). Boxes and formulas of
 * all kinds, and where they come from: data-generators/clouds.h and cumulus.h.
 *
 * Each kind has defaults of its own, which SetKind() puts in place: set the kind first. Those named
 * below are a cumulus'.
 *
 * | kind | Width | BaseHeight | TopHeight | Coverage | Wind |
 * |---|---|---|---|---|---|
 * | KindCumulus | 2000 | 0 (0.08 Width) | 0 (0.44 Width above) | - | 4, 1, 1.5 |
 * | KindCumulusField | 6000 | 600 | 1500 | 0.25 | 6, 2, 1 |
 * | KindStratus | 6000 | 200 | 600 | 0.85 | 5, 1, 0 |
 * | KindStratocumulus | 8000 | 900 | 1500 | 0.7 | 8, 2, 0 |
 * | KindCirrus | 12000 | 8000 | 9500 | 0.55 | 30, 8, 0 |
 * | KindCumulonimbus | 20000 | 1200 | 12000 | - | 18, 3, 6 |
 *
 * @sa vtkBrumeFogSource vtkBrumeFieldSource
 */
#ifndef vtkBrumeCloudSource_h
#define vtkBrumeCloudSource_h

#include "vtkBrumeFieldSource.h"
#include "vtkBrumeSourcesModule.h" // for the export macro

class VTKBRUMESOURCES_EXPORT vtkBrumeCloudSource : public vtkBrumeFieldSource
{
public:
  static vtkBrumeCloudSource* New();
  vtkTypeMacro(vtkBrumeCloudSource, vtkBrumeFieldSource);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Kinds
  {
    KindCumulus = 0,   ///< one fair-weather cloud: flat base, cauliflower top, wispy edges
    KindCumulusField,  ///< many of them of all sizes, over one level
    KindStratus,       ///< a grey sheet, ragged below, waved above
    KindStratocumulus, ///< a layer of cells, domed, with gaps between
    KindCirrus,        ///< streaks of ice, drawn out by the wind
    KindCumulonimbus   ///< a tower with an anvil
  };

  ///@{
  /**
   * What cloud it is. Default KindCumulus; other values become the nearest. A kind that is another
   * one than before puts its own defaults in place of all settings below this one.
   */
  void SetKind(int kind);
  vtkGetMacro(Kind, int);
  void SetKindToCumulus() { this->SetKind(KindCumulus); }
  void SetKindToCumulusField() { this->SetKind(KindCumulusField); }
  void SetKindToStratus() { this->SetKind(KindStratus); }
  void SetKindToStratocumulus() { this->SetKind(KindStratocumulus); }
  void SetKindToCirrus() { this->SetKind(KindCirrus); }
  void SetKindToCumulonimbus() { this->SetKind(KindCumulonimbus); }
  ///@}

  ///@{
  /**
   * Heights of the cloud's base and of its top, in metres. The base must be below the top, for a
   * cumulus, a cumulus field and a cumulonimbus at 0.03 Width or higher. For a cumulus 0, the
   * default, leaves them to the Width. Any finite value.
   */
  vtkSetMacro(BaseHeight, double);
  vtkGetMacro(BaseHeight, double);
  vtkSetMacro(TopHeight, double);
  vtkGetMacro(TopHeight, double);
  ///@}

  ///@{
  /**
   * Fraction of the ground that is under cloud, for cumulus fields and layers, away from the sides
   * of the box; data-generators/clouds.h says what is counted, and how well it is met. Without a
   * unit, default 0.5, range 0 to 1; outside it the nearest end. A cumulus and a cumulonimbus are
   * one cloud, and it does not matter.
   */
  vtkSetClampMacro(Coverage, double, 0.0, 1.0);
  vtkGetMacro(Coverage, double);
  ///@}

  ///@{
  /**
   * Width of the box, in metres. A cumulus grows with it; of other kinds there is more. The detail
   * (DetailSize, WarpSize, WarpAmplitude) stays. Default 2000, range 1 to 1e6; outside it the
   * nearest end.
   */
  vtkSetClampMacro(Width, double, 1.0, 1e6);
  vtkGetMacro(Width, double);
  ///@}

  ///@{
  /**
   * Size of the largest bulges of the noise, in metres; for cirrus the distance of its streaks.
   * Default 160, range 0.1 to 1e6; outside it the nearest end.
   */
  vtkSetClampMacro(DetailSize, double, 0.1, 1e6);
  vtkGetMacro(DetailSize, double);
  ///@}

  ///@{
  /**
   * Octaves of the noise, each half as large and half as strong as the one before. Default 5, range
   * 1 to 8; outside it the nearest end. More costs time, and shows only if voxels are small enough.
   */
  vtkSetClampMacro(Octaves, int, 1, 8);
  vtkGetMacro(Octaves, int);
  ///@}

  ///@{
  /**
   * How much cloud there is where the noise is 0: larger fills the cloud and smooths it, smaller
   * frays it. Without a unit, default 0.12, range 0 to 1; outside it the nearest end.
   */
  vtkSetClampMacro(Offset, double, 0.0, 1.0);
  vtkGetMacro(Offset, double);
  ///@}

  ///@{
  /**
   * How fast density climbs to 1 behind the cloud's edge: large is crisp, small is soft. Without a
   * unit, default 4, range 0.1 to 100; outside it the nearest end.
   */
  vtkSetClampMacro(Crispness, double, 0.1, 100.0);
  vtkGetMacro(Crispness, double);
  ///@}

  ///@{
  /**
   * The domain warp: how far, at most and along each axis, the noise pushes the cloud about, in
   * metres. Default 50, 0 is none; a negative one counts as 0, more than 0.06 Width as 0.06 Width,
   * for layers more than Width as Width.
   */
  vtkSetMacro(WarpAmplitude, double);
  vtkGetMacro(WarpAmplitude, double);
  ///@}

  ///@{
  /**
   * Size of the domain warp's eddies, in metres. Default 300, range 0.1 to 1e6; outside it the
   * nearest end.
   */
  vtkSetClampMacro(WarpSize, double, 0.1, 1e6);
  vtkGetMacro(WarpSize, double);
  ///@}

  ///@{
  /**
   * The wind, in metres a second along x, y and z. It carries layers through their box, and the
   * noise of the others through the cloud, which boils and stays. The streaks of cirrus lie along
   * it. Default (4, 1, 1.5), any finite value.
   */
  vtkSetVector3Macro(Wind, double);
  vtkGetVector3Macro(Wind, double);
  ///@}

protected:
  vtkBrumeCloudSource();
  ~vtkBrumeCloudSource() override;

  std::shared_ptr<const brume::Field> MakeField() override;

  int Kind = KindCumulus;
  double BaseHeight = 0.0;
  double TopHeight = 0.0;
  double Coverage = 0.5;
  double Width = 2000.0;
  double DetailSize = 160.0;
  int Octaves = 5;
  double Offset = 0.12;
  double Crispness = 4.0;
  double WarpAmplitude = 50.0;
  double WarpSize = 300.0;
  double Wind[3] = { 4.0, 1.0, 1.5 };

private:
  vtkBrumeCloudSource(const vtkBrumeCloudSource&) = delete;
  void operator=(const vtkBrumeCloudSource&) = delete;
};

#endif
