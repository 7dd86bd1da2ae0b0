/**
 * @class   vtkBrumeEffectPlan
 * @brief   which effects a picture simulates, why, and how wrong it is without the others
 *
 * A mapper simulates the effects that its scene calls for: what the scene does not have, and what
 * together changes no pixel by more than a quarter of the mapper's tolerance, is left out. Its plan
 * (vtkBrumeVolumeMapper::GetEffectPlan()) tells after each render what was settled, and takes
 * orders for the next:
 *
 * @code
 * mapper->GetEffectPlan()->Force("shadows", true);
 * @endcode
 *
 * Effects are named "absorption", "emission", "scattering", "phase anisotropy", "coloured
 * extinction", "shadows", "ambient", "octaves", "gradient shading", "silver lining", "powder",
 * "fog", "surfaces", "space leaping"; a hyphen or an underscore does for a space, in any case of
 * letters. docs/theory/plan.md derives the bounds.
 */
#ifndef vtkBrumeEffectPlan_h
#define vtkBrumeEffectPlan_h

#include "vtkBrumeMediumModule.h"
#include "vtkObject.h"

#include <map>    // for std::map
#include <memory> // for std::unique_ptr

namespace brume
{
enum class Effect;
struct EffectPlan;
}

class VTKBRUMEMEDIUM_EXPORT vtkBrumeEffectPlan : public vtkObject
{
public:
  static vtkBrumeEffectPlan* New();
  vtkTypeMacro(vtkBrumeEffectPlan, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The effects there are, always the same ones in the same order. The name of an index that there
   * is not is null; the index of a name that there is not is −1.
   */
  static int GetNumberOfEffects();
  static const char* GetEffectName(int index);
  static int GetEffectIndex(const char* name);
  ///@}

  /**
   * Whether a render has filled the plan. Before, all effects are on with a bound of 0.
   */
  vtkGetMacro(Planned, bool);

  ///@{
  /**
   * Whether the effect was simulated; why or why not, in words; the most that leaving it out
   * changes a pixel, as a fraction of white (0 where it is on); whether it was forced. An index or
   * a name that there is not: false, "", 0, false.
   */
  bool GetEffectOn(int index) const;
  bool GetEffectOn(const char* name) const;
  const char* GetEffectReason(int index) const;
  const char* GetEffectReason(const char* name) const;
  double GetEffectErrorBound(int index) const;
  double GetEffectErrorBound(const char* name) const;
  bool GetEffectForced(int index) const;
  bool GetEffectForced(const char* name) const;
  ///@}

  /**
   * The sum of the bounds: how wrong the picture is, at the most, for what it leaves out.
   */
  double GetErrorBound() const;

  ///@{
  /**
   * Overrules the plan from the next render on: the effect is simulated where the scene has it, or
   * left out whatever that costs. Returns false, after a warning, for a name that there is not.
   * ForceNothing, the default, leaves all to the plan again.
   */
  bool Force(const char* name, bool on);
  void ForceNothing();
  ///@}

#ifndef __VTK_WRAP__
  ///@{
  /**
   * For mappers: what was forced, and what was settled. SetPlan is no modification.
   */
  const std::map<brume::Effect, bool>& GetForces() const;
  void SetPlan(const brume::EffectPlan& plan);
  const brume::EffectPlan& GetPlan() const;
  ///@}
#endif

protected:
  vtkBrumeEffectPlan();
  ~vtkBrumeEffectPlan() override;

private:
  vtkBrumeEffectPlan(const vtkBrumeEffectPlan&) = delete;
  void operator=(const vtkBrumeEffectPlan&) = delete;

  bool Planned = false;

  struct Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
