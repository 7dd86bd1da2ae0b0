// The presets themselves: one table, meant to be read and edited.
//
// Opacity ramps are wide, tens of Hounsfield units or several hundredths of the range: at steps of
// half a voxel a mapper then meets each ramp more than once, and mappers that sample in different
// places agree.
#include "presets.h"

namespace brume::app
{

const std::vector<Preset>& presets()
{
  using VU = ValueUnit;
  using LU = LengthUnit;
  static const std::vector<Preset> table = {
    { "ct-bone", "CT, bone", "CT", VU::Hounsfield, LU::Millimetre, 1.0,
      // value, red, green, blue
      { { 150, 0.62, 0.36, 0.22 }, { 350, 0.86, 0.66, 0.45 }, { 700, 0.95, 0.88, 0.76 },
        { 1500, 1.00, 0.98, 0.93 } },
      // value, opacity
      { { 150, 0 }, { 300, 0.08 }, { 600, 0.45 }, { 1200, 0.85 } }, {},
      { true, 0.15, 0.85, 0.25, 20 },
      "Bone, with skin, fat and muscle left out." },

    { "ct-muscle", "CT, soft tissue", "CT", VU::Hounsfield, LU::Millimetre, 1.0,
      { { -80, 0.80, 0.62, 0.40 }, { 0, 0.66, 0.30, 0.22 }, { 60, 0.72, 0.28, 0.22 },
        { 180, 0.80, 0.45, 0.35 }, { 400, 0.93, 0.82, 0.68 }, { 1200, 1.00, 0.97, 0.92 } },
      { { -30, 0 }, { 30, 0.12 }, { 80, 0.35 }, { 300, 0.55 }, { 1000, 0.85 } }, {},
      { true, 0.18, 0.82, 0.20, 12 },
      "Muscle and organs in red, bone in ivory; fat and air left out." },

    { "ct-skin", "CT, skin", "CT", VU::Hounsfield, LU::Millimetre, 1.0,
      { { -700, 0.75, 0.50, 0.38 }, { -200, 0.88, 0.64, 0.51 }, { 50, 0.93, 0.72, 0.59 },
        { 400, 0.97, 0.90, 0.80 } },
      { { -700, 0 }, { -400, 0.12 }, { -100, 0.55 }, { 200, 0.80 } }, {},
      { true, 0.30, 0.75, 0.12, 10 },
      "The body's surface: everything denser than air, in the colour of skin." },

    { "ct-angiography", "CT, vessels with contrast agent", "CT", VU::Hounsfield, LU::Millimetre, 1.0,
      { { 100, 0.45, 0.08, 0.06 }, { 220, 0.80, 0.16, 0.10 }, { 380, 0.94, 0.42, 0.22 },
        { 600, 0.95, 0.82, 0.62 }, { 1200, 1.00, 0.97, 0.90 } },
      { { 110, 0 }, { 180, 0.08 }, { 300, 0.45 }, { 500, 0.60 }, { 1000, 0.75 } }, {},
      { true, 0.15, 0.80, 0.35, 25 },
      "Vessels filled with contrast agent in red, bone in ivory." },

    { "ct-lung", "CT, lung", "CT", VU::Hounsfield, LU::Millimetre, 1.0,
      { { -950, 0.20, 0.30, 0.55 }, { -800, 0.45, 0.60, 0.85 }, { -600, 0.90, 0.75, 0.68 },
        { -350, 0.80, 0.40, 0.35 } },
      { { -950, 0 }, { -820, 0.03 }, { -650, 0.10 }, { -500, 0.10 }, { -300, 0 } }, {},
      { true, 0.30, 0.70, 0.15, 10 },
      "Lung tissue and airways, translucent; the rest of the body left out." },

    { "mr-brain", "MR, brain", "MR", VU::RangeFraction, LU::Millimetre, 1.0,
      { { 0.20, 0.70, 0.38, 0.34 }, { 0.45, 0.88, 0.60, 0.54 }, { 0.65, 0.96, 0.78, 0.70 },
        { 0.85, 1.00, 0.95, 0.88 } },
      { { 0.25, 0 }, { 0.45, 0.10 }, { 0.65, 0.40 }, { 0.90, 0.65 } }, {},
      { true, 0.28, 0.80, 0.20, 12 },
      "Grey and white matter of a T1-weighted head." },

    { "mr-skin", "MR, skin", "MR", VU::RangeFraction, LU::Millimetre, 1.0,
      { { 0.05, 0.55, 0.32, 0.24 }, { 0.20, 0.86, 0.62, 0.50 }, { 0.60, 0.95, 0.78, 0.66 },
        { 1.00, 1.00, 0.92, 0.84 } },
      { { 0.06, 0 }, { 0.14, 0.10 }, { 0.30, 0.55 }, { 0.60, 0.85 } }, {},
      { true, 0.20, 0.80, 0.15, 10 },
      "The body's surface: everything brighter than the noise of air." },

    { "mr-angiography", "MR, vessels", "MR", VU::RangeFraction, LU::Millimetre, 1.0,
      { { 0.50, 0.40, 0.06, 0.05 }, { 0.75, 0.85, 0.20, 0.12 }, { 1.00, 1.00, 0.75, 0.55 } },
      { { 0.50, 0 }, { 0.65, 0.08 }, { 0.85, 0.45 }, { 1.00, 0.70 } }, {},
      { true, 0.15, 0.80, 0.35, 25 },
      "The brightest part of the data in red, as flowing blood is in an angiogram." },

    { "mr-default", "MR, all tissue", "MR", VU::RangeFraction, LU::Millimetre, 1.0,
      { { 0.00, 0.10, 0.05, 0.05 }, { 0.25, 0.55, 0.30, 0.25 }, { 0.60, 0.90, 0.72, 0.60 },
        { 1.00, 1.00, 1.00, 0.97 } },
      { { 0.10, 0 }, { 0.30, 0.04 }, { 0.60, 0.20 }, { 1.00, 0.55 } }, {},
      { true, 0.25, 0.75, 0.15, 10 },
      "A translucent look at all that is brighter than the background." },

    { "cloud", "Cloud", "any density", VU::DensityFraction, LU::EdgeFraction, 0.05,
      { { 0.00, 0.92, 0.94, 0.97 }, { 1.00, 1.00, 1.00, 1.00 } },
      { { 0.00, 0 }, { 0.25, 0.06 }, { 1.00, 0.35 } }, {},
      { false, 1.0, 0.0, 0.0, 1 },
      "White, translucent, opacity growing with density; for fog and smoke too." },

    { "grey", "Grey ramp", "any density", VU::RangeFraction, LU::EdgeFraction, 0.01,
      { { 0.00, 0.00, 0.00, 0.00 }, { 1.00, 1.00, 1.00, 1.00 } },
      { { 0.00, 0 }, { 1.00, 0.30 } }, {},
      { false, 1.0, 0.0, 0.0, 1 },
      "A plain ramp from black and clear to white and half opaque; assumes nothing of the data." },
  };
  return table;
}

}
