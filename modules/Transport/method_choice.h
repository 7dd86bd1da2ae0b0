// Which method makes the picture of a scene for an error or a time: measured on the scene itself.
// Theory: docs/theory/choice.md.
#pragma once

#include "Transport/film.h"
#include "Transport/marcher.h"
#include "Transport/path_tracer.h"
#include "Transport/scene.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace brume
{

struct PlacedEnvironment;

enum class Method
{
  March, ///< the ray march: single scattering, or octaves in place of more
  Paths, ///< path tracing: all scatterings, and noise
};

/// "raymarch" or "pathtrace".
const char* method_name(Method method);

/// Whether lit matter sends on the light of lamps or sky. Where none does, the ray march's picture
/// has no error but that of its steps.
bool scatters(const Scene& scene);

/// Why paths are not traced through a scene, or would not draw what is asked for, in words; empty
/// where they are.
std::string why_no_paths(const Scene& scene);

/// The share of a picture's pixels that may be expected beyond the tolerance so that, in 99 of 100
/// pictures of independent pixels, no more than one in a thousand is.
double expected_beyond(std::size_t pixels);

/// How many standard errors all but this share of normally distributed errors are below.
double errors_within(double beyond);

/// A ray march with so many octaves, held against paths on the same rays.
struct MarchFit
{
  int octaves = 1;
  std::size_t rays = 0;    ///< that meet matter
  std::size_t outside = 0; ///< of these, surely beyond the tolerance
  /// Root mean square of the difference, without the paths' own noise, and its standard error.
  double rms = 0.0;
  double rms_above = 0.0; ///< two standard errors above
  /// Below which 99.9 % of the pixels are expected, and below which they are hardly not.
  double error = 0.0;
  double error_above = 0.0;
};

/// A look at a few of a picture's rays: rays of its camera, spread evenly over the picture.
///
/// Paths along them tell what tracing the picture takes: the variance and the time of a path.
/// Marches along them tell how far single scattering and octaves are from all scatterings.
class MethodProbe
{
public:
  /// One ray for so many pixels; 64 rays at the least, 1024 at the most.
  static constexpr double pixels_of_ray = 16.0;

  /// Keeps a reference to the scene, a picture of width × height. Paths are traced through
  /// `traced`, with `environment`, where that is the same scene lit by the environment itself.
  MethodProbe(const Scene& scene,
    const Scene& traced,
    std::shared_ptr<const PlacedEnvironment> environment,
    int width,
    int height,
    std::uint32_t seed,
    int threads);
  ~MethodProbe();
  MethodProbe(const MethodProbe&) = delete;
  MethodProbe& operator=(const MethodProbe&) = delete;

  /// Traces on until each ray has so many paths, or `seconds` (0: no limit) have passed. Returns
  /// false when aborted.
  bool trace(int samples, double seconds, const Progress& progress);

  std::uint64_t paths() const { return this->Followed; }
  int samples() const { return this->Samples; }
  std::size_t rays() const { return this->Truth.size(); }
  double seconds() const { return this->Seconds; }
  double seconds_of_path() const;

  /// Paths of the whole picture, each pixel with as many as its noise asks for, for all but the
  /// share `beyond` of its pixels to be within the tolerance.
  double paths_for(double tolerance, double beyond) const;
  /// The sum over the picture's pixels of the variances of a path: with n paths, shared out by
  /// their noise, a pixel's standard error is √(sum / n).
  double variance() const;
  /// The error that all but the share are below with so many.
  double error_of(double paths, double beyond) const;

  /// Marches the rays with so many octaves (0: as the media have them) and compares.
  MarchFit fit(Marcher& marcher, int octaves, double tolerance);

private:
  const Scene& TheScene;
  Scene Seen; ///< with the surfaces of the probe's rays
  Scene Traced;
  std::shared_ptr<const PlacedEnvironment> Environment;
  std::size_t Pixels;
  std::uint32_t Seed;
  int Threads;
  PathTracer Tracer;
  Film Truth;
  std::map<int, Film> Marched; ///< by octaves
  int Samples = 0;
  std::uint64_t Followed = 0;
  double Seconds = 0.0;
};

/// The scene with this number of octaves in all lit media.
Scene with_octaves(const Scene& scene, int octaves);

/// A way to make the picture, and what it is expected to take.
struct MethodOption
{
  Method method = Method::March;
  int octaves = 0;      ///< of a march
  double seconds = 0.0; ///< NaN: not known
  double error = 0.0;   ///< of 99.9 % of the pixels; NaN: not known
  std::string verdict;  ///< "chosen", or why not
};

struct MethodChoice
{
  Method method = Method::March;
  int octaves = 0;          ///< of a march; 0: as the media have them
  std::string reason;       ///< in words, with the figures
  bool compared = false;    ///< whether march and paths were compared
  double seconds = 0.0;     ///< expected of the picture; NaN: not known
  double error = 0.0;       ///< expected, of 99.9 % of the pixels; NaN: not known
  double model_error = 0.0; ///< of a march: the part that is for what it leaves out of the light
  double beyond = 0.001;    ///< share of pixels to be expected beyond the tolerance
  std::vector<MethodOption> options;
  std::size_t probe_rays = 0;
  std::uint64_t probe_paths = 0;
  double probe_seconds = 0.0;
  double variance = 0.0;              ///< MethodProbe::variance; 0: not probed
  double probe_seconds_of_path = 0.0; ///< of one path, by all threads together
  bool aborted = false;
};

struct MethodWish
{
  double tolerance = 0.004; ///< of 99.9 % of the pixels; 0: as small as the time allows
  double seconds = 0.0;     ///< from now on; 0: no limit
  int width = 1;
  int height = 1;
  int threads = 0;
  std::uint32_t seed = 1;
  /// What paths are traced through, with `environment`: the scene, but lit by its environment
  /// itself rather than by lights in its place. Null: the scene.
  const Scene* traced = nullptr;
  std::shared_ptr<const PlacedEnvironment> environment;
  bool forced = false; ///< effects are on or off by the caller's will
};

/// Chooses for one picture. What scatters is probed: a few paths first, for the time of the
/// picture; then, if that is not less than twice what the march would need before it began, marches
/// with 1 and 8 octaves and as the media have them. A march is turned down as soon as more rays are
/// surely beyond the tolerance than a share of 0.001 explains, and taken when none is and 4½ times
/// the most that its root mean square error may be is within seven tenths of the tolerance; else
/// the paths of the probe are doubled until either holds or they have taken a twentieth of what the
/// picture would: paths then.
MethodChoice choose_method(Marcher& marcher,
  const Scene& scene,
  const MethodWish& wish,
  const Progress& progress = {});

}
