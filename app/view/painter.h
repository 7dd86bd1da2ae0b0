// What draws a viewport's pictures: coarse ones at once, then better ones.
#pragma once

#include "mapper_names.h"
#include "volume_scene.h"

#include "Analysis/picture.h"
#include "Transport/film.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace brume::app
{

/// Told the part that is done, in [0, 1], and asked whether to go on.
using KeepGoing = std::function<bool(double)>;

/// An effect as a picture's statistics tell it.
struct ShownEffect
{
  std::string name;
  bool on = false;
  bool forced = false;
  std::string reason;
  double error_bound = 0.0; ///< fraction of white, of what is left out; NaN where it is not known
  double milliseconds = 0.0; ///< what it costs in this picture, or would; NaN where it is not known
};

/// A picture of the scene and what is known of it.
struct Shot
{
  Picture picture;      ///< linear; coarser than its viewport for drafts
  std::shared_ptr<const Film> film; ///< what it is made of; null for VTK's mappers
  std::string state;    ///< in a few words: "draft, a ray for 3 x 3 pixels", "128 paths a pixel"
  double seconds = 0.0; ///< that it took in all
  std::optional<double> error; ///< estimated, fraction of white
  std::vector<ShownEffect> effects;
  std::string failure;  ///< why there is no picture; empty where there is one
  bool whole = false;   ///< a ray for each pixel of the viewport
  bool draft = false;   ///< made in haste: not for keeping, though it may be whole
};

/// Draws one scene with one mapper. The camera is the scene's, and may move between any two calls.
///
///     painter->set_scene(scene);        // and again whenever it changed
///     painter->draft(w, h, 0.04, go);   // something to look at, soon
///     while (painter->refine(w, h, go)) // then better and better
///       show(painter->shot());
class Painter
{
public:
  virtual ~Painter() = default;

  /// What changed other than the camera. The scene must stay until the next one is set.
  virtual void set_scene(const VolumeScene& scene) = 0;

  /// A picture within about so many seconds, with fewer rays than pixels where it must be. False where
  /// `go` ended it: shot() is then the one before.
  virtual bool draft(int width, int height, double seconds, const KeepGoing& go) = 0;

  /// One better picture than the last. False where there is none, or `go` ended it: shot() is then the
  /// one before, and finished() tells which.
  virtual bool refine(int width, int height, const KeepGoing& go) = 0;

  /// Whether the last picture is as good as was asked for.
  virtual bool finished() const = 0;

  /// Of the last picture.
  virtual const Shot& shot() const = 0;
};

/// Painters of Brume's mappers: drafts and first whole pictures are ray marches. The path tracer then adds
/// paths until the tolerance is met; the smart mapper makes the picture that it promises.
std::unique_ptr<Painter> make_own_painter(MapperKind kind);

/// Painters of VTK's mappers, which need a display. Drafts have fewer rays, as the mappers' own settings
/// allow; whole pictures are those of `brume compare`: steps of half a voxel or --sample-distance. What
/// they do not know of the scene is left out (stock_scene.h).
std::unique_ptr<Painter> make_stock_painter(MapperKind kind);

inline std::unique_ptr<Painter> make_painter(MapperKind kind)
{
  return is_own(kind) ? make_own_painter(kind) : make_stock_painter(kind);
}

}
