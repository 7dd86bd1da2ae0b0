// Random scenes for properties that hold in all of them. Small, so that one takes a millisecond or
// so.
#pragma once

#include "../support/transport_scenes.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace stability
{

using namespace transport_scenes;

/// What scenes a property is about.
struct SceneWishes
{
  int volumes = 1;        ///< at the most
  bool classified = true; ///< may be
  bool density = true;    ///< may be
  bool lit = false;       ///< is; else sends its colour, or is dark
  bool lamps = true;      ///< lit scenes may have lamps beside suns
  bool sky = true;        ///< may have one
  bool parallel_only = false;
  bool awkward = true; ///< spacing from 1e-6 to 1e6, uneven by up to 1e3, shear, far origins
};

/// A random scene, drawn with RapidCheck within a property, and its voxels.
struct RandomScene
{
  std::vector<std::shared_ptr<std::vector<float>>> voxels;
  Scene scene;
  double voxel = 1.0; ///< length of a typical voxel edge, in the data's units
  View view;
};

RandomScene draw_scene(const SceneWishes& wishes);

/// One of this machine's SIMD targets, now forced. Undo it with force_simd_target("").
void draw_target();

}
