// A torso as a CT scanner sees it: a phantom in Hounsfield units.
#pragma once

#include "data-generators/field.h"
#include "data-generators/scan.h"

#include <cstdint>
#include <memory>

namespace brume
{

/// The settings of a torso phantom.
struct TorsoCTOptions
{
  /// Which torso: the branches of its vessels, the sponge of its bones, what its bowel holds. Any
  /// value. Places and sizes of the organs are the same for all.
  std::uint32_t seed = 1;

  /// Width over which one tissue passes into the next, millimetres: the partial volume of voxels of
  /// about that size. Above 0. A good value is 2 voxels.
  double edge = 4.0;
};

/// A torso in Hounsfield units at any place, in millimetres; time changes nothing.
///
/// Coordinates are RAS+: x grows from the patient's left to the patient's right, y from back to
/// front, z from foot to crown. The origin is the middle of the box, which is 400 x 280 x 560 mm,
/// from the neck to the hip joints; it lies in the body's middle at the height of the twelfth
/// thoracic vertebra. The patient lies on the back, arms raised, breathed in, 70 s after
/// contrast medium: the portal venous phase (hounsfield.h).
///
/// What there is: skin, fat, muscle; neck and shoulders; vertebrae from the sixth of the neck to
/// the fifth of the loins with discs, canal and cord, sacrum and coccyx; twelve pairs of ribs with
/// their cartilage, breastbone, collar bones, shoulder blades, upper arms; hip bones and thigh
/// bones; lungs with their fissures, vessels and bronchi, windpipe, gullet; heart with its four
/// chambers, aorta and its branches, hollow veins, pulmonary vessels; liver with its vessels, gall
/// bladder, spleen, stomach with fluid and an air bubble, pancreas, kidneys, adrenal fat, small and
/// large bowel, bladder. Liver and gall bladder are on the right, the heart's tip, stomach and
/// spleen on the left. Values in hounsfield.h. Places after textbooks of anatomy, to some
/// millimetres.
class TorsoCT : public Field
{
public:
  /// Throws std::invalid_argument for an edge that is not above 0.
  explicit TorsoCT(const TorsoCTOptions& options = {});
  ~TorsoCT() override;

  Box bounds() const override;
  float value(const glm::dvec3& place, double time) const override;

  const PaintedVolume& painting() const { return *m_painting; }
  std::shared_ptr<const PaintedVolume> share_painting() const { return m_painting; }

private:
  std::shared_ptr<const PaintedVolume> m_painting;
};

/// The box of the phantom, millimetres: what TorsoCT::bounds() gives, without making one.
Box torso_ct_bounds();

}
