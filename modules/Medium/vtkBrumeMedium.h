/**
 * @class   vtkBrumeMedium
 * @brief   what the matter of a volume does with light
 *
 * Given to a mapper, it makes the volume scatter the light of the renderer's lights and of a
 * vtkBrumeSky, and glow:
 *
 * @code
 * vtkNew<vtkBrumeMedium> medium;
 * medium->SetExtinction(0.05); // the values are a density
 * medium->SetAnisotropy(0.8);  // cloud droplets
 * mapper->SetMedium(medium);
 * @endcode
 *
 * In R, G and B, at each place:
 *
 *     σt = extinction · density,  σs = albedo · σt
 *
 * for a density; where Extinction is 0 the vtkVolumeProperty classifies the values, σt is that of
 * its opacity, and albedo and emission are multiplied by its colour. A phase function is a mixture
 * of lobes; without one it is isotropic.
 *
 * SilverLining and Powder are not physical: they are off unless switched on, and the statistics of
 * a picture with one of them say that it is not radiometric.
 *
 * No setting ever becomes NaN or infinite: such a value is refused with a warning and the old one
 * kept. Values outside of a range are clamped.
 *
 * Lengths are in the data's own coordinates, as the mapper's are. docs/user/medium.md tells how to
 * use it, docs/theory/light.md has the formulas with their sources.
 */
#ifndef vtkBrumeMedium_h
#define vtkBrumeMedium_h

#include "vtkBrumeMediumModule.h"
#include "vtkObject.h"

#include <memory> // for std::unique_ptr
#include <string> // for std::string

namespace brume
{
struct Medium;
}

class VTKBRUMEMEDIUM_EXPORT vtkBrumeMedium : public vtkObject
{
public:
  static vtkBrumeMedium* New();
  vtkTypeMacro(vtkBrumeMedium, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Extinction coefficient, absorption and scattering together, per unit of length and of density,
   * for R, G and B; one number is for all three. Above 0 in any channel, the values are a density
   * of matter: the property's functions are not read, and values below 0 count as 0. Default 0, 0,
   * 0: the values are classified by the property (or are a density, where the mapper has an
   * Extinction of its own). Negative values are set to 0.
   */
  void SetExtinction(double red, double green, double blue);
  void SetExtinction(const double rgb[3]) { this->SetExtinction(rgb[0], rgb[1], rgb[2]); }
  void SetExtinction(double every) { this->SetExtinction(every, every, every); }
  vtkGetVector3Macro(Extinction, double);
  ///@}

  ///@{
  /**
   * Single-scattering albedo, σs / σt: the part of the light taken from a ray that is sent on in
   * another direction, for R, G and B. Default 1, 1, 1: nothing is absorbed. Range 0 to 1; values
   * outside are clamped.
   */
  void SetAlbedo(double red, double green, double blue);
  void SetAlbedo(const double rgb[3]) { this->SetAlbedo(rgb[0], rgb[1], rgb[2]); }
  void SetAlbedo(double every) { this->SetAlbedo(every, every, every); }
  vtkGetVector3Macro(Albedo, double);
  ///@}

  ///@{
  /**
   * The array of the input's point data that holds the values, in place of the mapper's scalars.
   * Default none: the mapper's scalars. Images only.
   */
  vtkSetStdStringFromCharMacro(DensityArrayName);
  vtkGetCharFromStdStringMacro(DensityArrayName);
  ///@}

  // Emission. -----------------------------------------------------------------------------------

  ///@{
  /**
   * Radiance that matter sends by itself per unit of length and of density, R, G, B. Of classified
   * values: per unit of optical depth, and times the colour, so that 1 adds what VTK's composite
   * mode draws. Default 0, 0, 0. Negative values are set to 0.
   */
  void SetEmission(double red, double green, double blue);
  void SetEmission(const double rgb[3]) { this->SetEmission(rgb[0], rgb[1], rgb[2]); }
  void SetEmission(double every) { this->SetEmission(every, every, every); }
  vtkGetVector3Macro(Emission, double);
  ///@}

  ///@{
  /**
   * How much radiance of a black body at the temperature of the place is sent per unit of length
   * and of density (of optical depth and times the colour, for classified values). A body of
   * BlackBodyReference kelvin has the luminance 1; its radiance grows steeply with the temperature.
   * Needs TemperatureArrayName. Default 0: none. Negative values are set to 0.
   */
  void SetBlackBody(double amount);
  vtkGetMacro(BlackBody, double);
  ///@}

  ///@{
  /**
   * The temperature whose black body has the luminance 1, in kelvin. Default 1500. Range 800 to
   * 100 000; values outside are clamped.
   */
  void SetBlackBodyReference(double kelvin);
  vtkGetMacro(BlackBodyReference, double);
  ///@}

  ///@{
  /**
   * The array of the input's point data that holds temperatures, of one component, on the lattice
   * of the values. Read only where BlackBody is above 0. Default none. Images only.
   */
  vtkSetStdStringFromCharMacro(TemperatureArrayName);
  vtkGetCharFromStdStringMacro(TemperatureArrayName);
  ///@}

  ///@{
  /**
   * Kelvin in one unit of the temperature array. Default 1. Values that are not positive are
   * refused with a warning.
   */
  void SetTemperatureScale(double kelvin);
  vtkGetMacro(TemperatureScale, double);
  ///@}

  // Phase function. -----------------------------------------------------------------------------

  enum LobeFunction
  {
    IsotropicLobe = 0,
    RayleighLobe,
    HenyeyGreensteinLobe,
    SchlickLobe
  };

  ///@{
  /**
   * Adds a part to the phase function. θ is the angle between the directions in which light travels
   * before and after, so that cos θ = 1 is straight on. Each part integrates to 1 over the sphere.
   *
   * - Isotropic: 1 / 4π.
   * - Rayleigh: 3 / 16π · (1 + cos²θ): particles much smaller than the wavelength.
   * - Henyey and Greenstein: (1 − g²) / 4π / (1 + g² − 2 g cos θ)^{3/2}, of mean cosine g.
   * - Schlick: (1 − k²) / 4π / (1 − k cos θ)²: near the former, and cheaper; k is such that g is
   * the mean cosine here, too.
   *
   * Weights are divided by their sum; one that is not positive is refused with a warning. g above 0
   * scatters forward, below 0 backward; clamped to ±0.9999. No lobe, the default, is isotropic.
   */
  void AddIsotropicLobe(double weight = 1.0);
  void AddRayleighLobe(double weight = 1.0);
  void AddHenyeyGreensteinLobe(double weight, double anisotropy);
  void AddSchlickLobe(double weight, double anisotropy);
  ///@}

  /**
   * Removes all lobes, which makes the phase function isotropic.
   */
  void RemoveAllLobes();

  ///@{
  /**
   * The lobes in the order in which they were added: the function (a LobeFunction), the weight as
   * it was given, and g (0 for functions without one). An index that there is not: isotropic, 0, 0.
   */
  int GetNumberOfLobes() const;
  int GetLobeFunction(int index) const;
  double GetLobeWeight(int index) const;
  double GetLobeAnisotropy(int index) const;
  ///@}

  ///@{
  /**
   * One number for the phase function. Setting it puts one Henyey–Greenstein lobe of this g in the
   * place of all lobes, or none for 0. Got is the mean of cos θ over the phase function: the mean
   * of the lobes' g by weight. Default 0. Clamped to ±0.9999.
   */
  void SetAnisotropy(double anisotropy);
  double GetAnisotropy() const;
  ///@}

  // Multiple scattering. ------------------------------------------------------------------------

  ///@{
  /**
   * Multiple scattering as a sum of single scatterings in ever thinner matter: octave m, from 0 on,
   * sends OctaveContributionᵐ of the light, dimmed on its way from the light by OctaveAttenuationᵐ
   * of the extinction, by a phase function of OctaveAnisotropyᵐ · g. An approximation without a
   * bound on its error. Default 1 octave, which is single scattering, and ½ for each of the others.
   * Ranges: 1 to 16 octaves; factors 0 to 1; values outside are clamped.
   *
   * A contribution above the attenuation would make light from nothing. It is refused with a
   * warning; an attenuation that is set below the contribution takes the contribution down with it.
   * So set the attenuation first.
   */
  vtkSetClampMacro(NumberOfOctaves, int, 1, 16);
  vtkGetMacro(NumberOfOctaves, int);
  void SetOctaveAttenuation(double factor);
  vtkGetMacro(OctaveAttenuation, double);
  void SetOctaveContribution(double factor);
  vtkGetMacro(OctaveContribution, double);
  void SetOctaveAnisotropy(double factor);
  vtkGetMacro(OctaveAnisotropy, double);
  ///@}

  // Not physical. -------------------------------------------------------------------------------

  ///@{
  /**
   * Brightens the rim of matter before a light: the phase function (of the first octave) gains
   * strength · ((1 − back) HG(1 − spread) + back · HG(spread − 1)). Not physical. Default off.
   */
  vtkSetMacro(SilverLining, vtkTypeBool);
  vtkGetMacro(SilverLining, vtkTypeBool);
  vtkBooleanMacro(SilverLining, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Of the silver lining: its strength (default 1; negative values are set to 0); its spread,
   * 1 − g of the lobe, small for a thin bright rim (default 0.2, range 0.0001 to 1); and the share
   * that shines back toward the light (default 0, range 0 to 1).
   */
  void SetSilverLiningStrength(double strength);
  vtkGetMacro(SilverLiningStrength, double);
  void SetSilverLiningSpread(double spread);
  vtkGetMacro(SilverLiningSpread, double);
  void SetSilverLiningBack(double back);
  vtkGetMacro(SilverLiningBack, double);
  ///@}

  ///@{
  /**
   * Darkens thin matter, as multiple scattering would brighten what is inside: a factor on all
   * scattered light, by PowderForm. Not physical. Default off.
   */
  vtkSetMacro(Powder, vtkTypeBool);
  vtkGetMacro(Powder, vtkTypeBool);
  vtkBooleanMacro(Powder, vtkTypeBool);
  ///@}

  enum PowderForms
  {
    ExponentialPowder = 0,
    HeightPowder
  };

  ///@{
  /**
   * Of the powder effect: its strength (default 1, range 0 to 1), its form, and the factor by which
   * a density (of classified values: the opacity over the unit distance) becomes d, cut to [0, 1]
   * (default 1, refused where not positive).
   *
   * - Exponential, the default: 1 − strength · e^{−2d}.
   * - Height: 1 − sat(strength · d^{R(h; 0.3, 0.9 → 0.5, 1)}) · sat(R(h; 0, 0.3 → 0.8, 1))^{0.8},
   *   h the height in the volume's box from 0 to 1, R a linear map that is clamped, sat a clamp to
   *   [0, 1] (Schneider and Vos 2015).
   */
  void SetPowderStrength(double strength);
  vtkGetMacro(PowderStrength, double);
  vtkSetClampMacro(PowderForm, int, ExponentialPowder, HeightPowder);
  vtkGetMacro(PowderForm, int);
  void SetPowderFormToExponential() { this->SetPowderForm(ExponentialPowder); }
  void SetPowderFormToHeight() { this->SetPowderForm(HeightPowder); }
  void SetPowderScale(double scale);
  vtkGetMacro(PowderScale, double);
  ///@}

#ifndef __VTK_WRAP__
  /**
   * All of it as Transport has it, but for the extinction, which goes to Density, and for the
   * temperatures, which are the input's.
   */
  void FillMedium(brume::Medium& medium) const;
#endif

protected:
  vtkBrumeMedium();
  ~vtkBrumeMedium() override;

private:
  vtkBrumeMedium(const vtkBrumeMedium&) = delete;
  void operator=(const vtkBrumeMedium&) = delete;

  void AddLobe(int function, double weight, double anisotropy);

  double Extinction[3] = { 0.0, 0.0, 0.0 };
  double Albedo[3] = { 1.0, 1.0, 1.0 };
  std::string DensityArrayName;
  double Emission[3] = { 0.0, 0.0, 0.0 };
  double BlackBody = 0.0;
  double BlackBodyReference = 1500.0;
  std::string TemperatureArrayName;
  double TemperatureScale = 1.0;
  int NumberOfOctaves = 1;
  double OctaveAttenuation = 0.5;
  double OctaveContribution = 0.5;
  double OctaveAnisotropy = 0.5;
  vtkTypeBool SilverLining = 0;
  double SilverLiningStrength = 1.0;
  double SilverLiningSpread = 0.2;
  double SilverLiningBack = 0.0;
  vtkTypeBool Powder = 0;
  double PowderStrength = 1.0;
  int PowderForm = ExponentialPowder;
  double PowderScale = 1.0;

  struct Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
