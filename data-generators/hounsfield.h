// CT numbers of the tissues of a head.
//
// Hounsfield units (HU): 1000 (mu - mu_water)/(mu_water - mu_air), so that air is -1000 and water
// is 0. The values depend on the tube's voltage; these are usual ones at 120 kV. Beside each stands
// the range that textbooks give (Buzug, "Computed Tomography", 2008, p. 475; Prokop & Galanski,
// "Spiral and Multislice Computed Tomography of the Body", 2003; for teeth the range that dental CT
// reports).
#pragma once

namespace brume
{
namespace hounsfield
{

constexpr double lowest = -1024.0; ///< a scanner stores 12 bits: -1024 … 3071
constexpr double highest = 3071.0;

constexpr double air = -1000.0;
constexpr double fat = -100.0;              ///< -120 … -50
constexpr double marrow = 60.0;             ///< in the diploe's gaps, mixed with thin bone
constexpr double vitreous = 8.0;            ///< 0 … 15
constexpr double cerebrospinal_fluid = 8.0; ///< 0 … 15
constexpr double white_matter = 27.0;       ///< 20 … 30
constexpr double grey_matter = 40.0;        ///< 37 … 45
constexpr double dura = 55.0;               ///< 50 … 70
constexpr double muscle = 50.0;             ///< 35 … 60
constexpr double mucosa = 45.0;             ///< 30 … 60
constexpr double skin = 60.0;               ///< 40 … 80
constexpr double gland = 30.0;              ///< 10 … 40 (parotid: fat among it)
constexpr double sclera = 65.0;             ///< 50 … 80
constexpr double lens = 100.0;              ///< 80 … 120
constexpr double cartilage = 110.0;         ///< 80 … 150
constexpr double calcification = 160.0;     ///< above 100: pineal gland, choroid plexus
constexpr double lung = -860.0;             ///< -900 … -800, breathed in
constexpr double water = 0.0;               ///< bile and urine: 0 … 20
constexpr double chyme = 35.0;              ///< 10 … 60
constexpr double heart_muscle = 110.0;      ///< 90 … 130 after contrast medium
constexpr double pancreas = 95.0;           ///< 80 … 120 after contrast medium
constexpr double liver = 110.0;         ///< 90 … 130 after contrast medium (55 … 65 without)
constexpr double spleen = 125.0;        ///< 110 … 140 after contrast medium
constexpr double kidney_marrow = 130.0; ///< 100 … 160 after contrast medium
constexpr double kidney_rind = 200.0;   ///< 170 … 230 after contrast medium
// The torso's blood: one phase, the portal venous one, some 70 s after the injection began. The
// arteries have fallen nearly to the veins, the portal vein and the liver's veins are at their
// height, and so is the liver, 50 HU or more above what it has without contrast medium; the
// kidneys' rind is still above their marrow. (In the late arterial phase, which the head's vessels
// show, arteries have 290 … 360 HU and the liver has hardly begun.) Course of the phases: Bae,
// "Intravenous contrast medium administration and scan timing at CT", Radiology 256 (2010) 32;
// ranges: usual ones.
constexpr double portal_phase_artery =
  160.0; ///< 130 … 190; the left heart and the lungs' veins, too
constexpr double portal_phase_vein =
  150.0;                              ///< 120 … 180; the right heart and the lungs' arteries, too
constexpr double portal_vein = 180.0; ///< 150 … 210; the liver's own veins, too
constexpr double contrast_blood = 320.0; ///< 250 … 400 in the arteries of a CT angiography
constexpr double contrast_vein = 220.0;  ///< 150 … 250 in the venous sinuses
constexpr double spongy_bone = 480.0;    ///< 200 … 700
constexpr double bone = 1100.0;          ///< 700 … 1900, cortical
constexpr double dense_bone = 1500.0;    ///< 1200 … 2000: petrous bone, inner and outer table
constexpr double dentine = 1700.0;       ///< 1400 … 2000
constexpr double enamel = 2600.0;        ///< 2200 … 3000
constexpr double marker = 2800.0;        ///< the ceramic bead on the patient's left temple

}
}
