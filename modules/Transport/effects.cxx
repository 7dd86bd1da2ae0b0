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

}
