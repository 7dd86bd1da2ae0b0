// Choosing the steps of a march from the error that is accepted.
#pragma once

#include "Transport/marcher.h"
#include "Transport/scene.h"

namespace brume
{

/// How the shadows of lit media are made, and what that is expected to cost in accuracy.
struct ShadowChoice
{
  ShadowMethod method = ShadowMethod::None;
  double step = 0.0;            ///< MarchSettings has these two
  bool precise = false;
  double estimated_error = 0.0; ///< largest error of a pixel, as a fraction of white
  bool met = true;              ///< whether the estimate is within the tolerance asked for
};

/// The cheapest shadows whose error is expected to be within `tolerance` (a fraction of white, > 0).
///
/// Light volumes come first, with as many nodes as take no longer to sweep than a picture takes to
/// march (a few millions, ¼ to 4 voxel edges apart), then with nodes half as far apart as long as
/// memory allows. The error is measured: a few hundred rays of the scene's camera are marched with
/// the light volume and with shadow rays. Where no light volume will do, and always below 1e-4,
/// shadow rays are taken; but not through classified matter for a tolerance of 0.0009 and more: the
/// best light volume then, with the error that it has, since rays take a hundred times as long. None
/// where nothing is lit.
///
/// It holds for all directions of light and view, nearly: call it again when the media change, not
/// when lights or camera move.
ShadowChoice choose_shadows(Marcher& marcher, const Scene& scene, double tolerance, int threads = 0);

/// Steps, and what they are expected to cost in accuracy.
struct StepChoice
{
  StepRule rule = StepRule::Midpoint;
  double step = 1.0;            ///< in the data's units
  int refinements = 0;          ///< MarchSettings has these two
  double refine_error = 0.0;
  double estimated_error = 0.0; ///< largest error of a pixel, as a fraction of white
  bool met = false;             ///< whether the estimate is within the tolerance asked for
};

/// The cheapest steps with which the picture's largest error is expected to be within `tolerance` (a
/// fraction of white, > 0): between 4 and 1/32 of the smallest voxel edge (1/128 in lit scenes below
/// 1e-4), by the rule that needs the fewer samples; the shortest where none is expected to do.
///
/// The expectation is measured with the kernels themselves: 4096 rays of the scene's camera, spread
/// evenly over the outline of what can be seen of the volumes, whatever part of it is in the picture, are
/// marched with steps of 4, 2, 1, … voxel edges (4 and 2 are held against 1, too, which steps over no voxel); where hardly any of them meets something, steps
/// of ¼, ⅛, … are. The midpoint rule's error falls with the square of the step, so that 4/3
/// of the largest change by a halving is the error of the longer step; half of that again is added for
/// the rays that were not looked at. Steps between two halvings are taken with an error that grows
/// with the cube.
///
/// Where a few rays ask for much shorter steps than the rest, all take the steps that 19 of 20 rays
/// allow, and the pixels whose own estimate tells of a larger error are refined: at `refine_error`,
/// which is `tolerance` by the scale that estimates and measured errors have on the rays looked at. In
/// lit scenes so also where the shortest steps leave some rays beyond the tolerance.
///
/// In lit scenes steps are at most one voxel edge long, and radiance counts as a fraction of the
/// brightest that these rays meet, where that is above 1.
///
/// `base` tells how shadows are made and what is left out. The marcher's caches are brought up to date
/// for the scene, and used.
///
/// `edge` × `edge` rays are looked at in place of 4096: for pictures that have not many more.
///
/// `beyond` is the share of pixels that may have a larger error than the tolerance, in [0, 1). Above 0
/// the error that counts is the one that so many of the rays exceed that, were the share larger,
/// fewer would in one of ten cases; nothing is added for rays that were not looked at; steps may go
/// down to 1/256 voxel edge; and where errors fall more slowly than with the square of the step, as
/// across sharp surfaces, they are taken to go on like that. Longer steps are compared with the
/// shortest again then, and the step is as long as these errors allow (docs/theory/choice.md).
StepChoice choose_step(Marcher& marcher,
  const Scene& scene,
  double tolerance,
  int threads = 0,
  const MarchSettings& base = {},
  double beyond = 0.0,
  int edge = 64);

/// How many of `count` independent draws may fall into a part that is allowed a share of them: so few
/// that, were its share larger, as few or fewer would in no more than one of ten cases. −1 where not
/// even none tells that.
int credible_count(int count, double share);

/// The smallest edge of a voxel of any of the volumes, in the data's units.
double smallest_voxel_edge(const Scene& scene);

}
