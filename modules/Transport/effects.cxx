#include "Transport/effects.h"

namespace brume
{

const char* effect_name(Effect effect)
{
  switch (effect)
  {
    case Effect::Absorption:
      return "absorption";
    case Effect::Emission:
      return "emission";
    case Effect::Scattering:
      return "scattering";
    case Effect::PhaseAnisotropy:
      return "phase anisotropy";
    case Effect::ColouredExtinction:
      return "coloured extinction";
    case Effect::Shadows:
      return "shadows";
    case Effect::Ambient:
      return "ambient";
    case Effect::Octaves:
      return "octaves";
    case Effect::GradientShading:
      return "gradient shading";
    case Effect::SilverLining:
      return "silver lining";
    case Effect::Powder:
      return "powder";
    case Effect::Fog:
      return "fog";
    case Effect::Surfaces:
      return "surfaces";
    case Effect::SpaceLeaping:
      return "space leaping";
  }
  return "";
}

double effect_cost(Effect effect)
{
  // brume-benchmarks --filter effect-: each row less the row without the effect.
  switch (effect)
  {
    case Effect::Absorption:
      return 0.87;
    case Effect::Emission:
      return 0.13;
    case Effect::Scattering:
      return 0.06;
    case Effect::PhaseAnisotropy:
      return 0.03;
    case Effect::ColouredExtinction:
      return 0.60;
    case Effect::Shadows:
      return 0.40;
    case Effect::Ambient:
      return 1.49;
    case Effect::Octaves:
      return 0.23;
    case Effect::GradientShading:
      return 1.30;
    case Effect::SilverLining:
      return 0.01;
    case Effect::Powder:
      return 0.14;
    case Effect::Fog:
      return 8.10;
    case Effect::Surfaces:
    case Effect::SpaceLeaping:
      return 0.0;
  }
  return 0.0;
}

}
