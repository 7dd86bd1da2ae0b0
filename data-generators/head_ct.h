// A head as a CT scanner sees it: a phantom in Hounsfield units.
#pragma once

#include "data-generators/field.h"
#include "data-generators/scan.h"

#include <cstdint>
#include <memory>

namespace brume
{

/// The settings of a head phantom.
struct HeadCTOptions
{
  /// Which head: the folds of its brain, the sponge of its bones. Any value. Places and sizes of
  /// the organs are the same for all.
  std::uint32_t seed = 1;

  /// Width over which one tissue passes into the next, millimetres: the partial volume of voxels of
  /// about that size. Above 0. A good value is 2 voxels.
  double edge = 2.0;
};

/// A head in Hounsfield units at any place, in millimetres; time changes nothing.
///
/// Coordinates are RAS+: x grows from the patient's left to the patient's right, y from back to
/// front, z from foot to crown. (DICOM's are LPS: x and y the other way.) The origin is the middle
/// of the box, which is 192 x 240 x 256 mm; it
/// lies at the skull's base, 2 mm below and 82 mm behind the pupils. The head is symmetric in x,
/// but for what tells left from right: a ceramic bead of 4 mm radius (2800 HU) on the patient's
/// left temple, at head_marker, and the veins.
///
/// What there is: skin, fat under it, muscle; the skull with outer table, diploe and inner table,
/// sutures, eye sockets, cheek bones, nose, upper and lower jaw; air in nose, throat, frontal,
/// maxillary, ethmoid, sphenoid sinuses, mastoid and ear canals; 28 teeth of enamel and dentine;
/// cervical vertebrae; eyes with lens, optic nerve and muscles; brain with folded grey matter,
/// white matter, deep nuclei, ventricles, falx, cerebellum, stem; arteries and veins filled with
/// contrast medium; hyoid, trachea, ears. Values in hounsfield.h.
class HeadCT : public Field
{
public:
  /// Throws std::invalid_argument for an edge that is not above 0.
  explicit HeadCT(const HeadCTOptions& options = {});
  ~HeadCT() override;

  Box bounds() const override;
  float value(const glm::dvec3& place, double time) const override;

  const PaintedVolume& painting() const { return *m_painting; }
  std::shared_ptr<const PaintedVolume> share_painting() const { return m_painting; }

private:
  std::shared_ptr<const PaintedVolume> m_painting;
};

/// The box of the phantom, millimetres: what HeadCT::bounds() gives, without making one.
Box head_ct_bounds();

/// Centre of the bead on the patient's left temple, RAS+ millimetres.
constexpr double head_marker[3] = { -75.0, 22.0, 24.0 };

/// sample_scan() of a head.
bool sample_head_ct(const HeadCT& head,
  double noise,
  std::uint32_t noise_seed,
  const Lattice& grid,
  const Extent& extent,
  std::int16_t* values,
  const Progress& progress = {});

}
