// The best ray march that a time allows.
#pragma once

#include "Transport/film.h"
#include "Transport/marcher.h"
#include "Transport/scene.h"

namespace brume
{

struct TimedMarch
{
  MarchStatistics march;  ///< of the picture that was kept
  double distance = 1.0;  ///< pixels between its rays; above 1 it was scaled up
  double predicted = 0.0; ///< seconds of that picture alone
  /// The largest error of 99.9 % of the pixels by their steps, as a fraction of white, from the two
  /// pictures that were made; NaN where there was time for one alone.
  double estimated_error = 0.0;
  bool finest = false; ///< the steps are the shortest that make a difference
  bool completed = false;
};

/// Fills the film in about so many seconds from now on, of any number above 0: the quickest picture
/// first, one with shorter steps, to learn how long a step takes, then one with the steps that fill
/// the time. Where that takes longer than was expected it is given up at `latest` seconds, and the
/// one before is kept. Where not even the longest steps do, the picture has fewer rays, and is
/// scaled up.
///
/// Steps are made no shorter than 1/64 of the smallest voxel edge, nor, with a `tolerance` above 0,
/// than is expected to put 99.9 % of the pixels within that.
///
/// `base` tells all but steps, rule and refinements. Steps are at most 4 (1 in lit scenes) of the
/// smallest voxel edge. Throws as Marcher::render does.
TimedMarch march_within(Marcher& marcher,
  const Scene& scene,
  const MarchSettings& base,
  double seconds,
  double latest,
  double tolerance,
  Film& film,
  const Progress& progress = {});

/// What a few strips of a picture tell of its march.
struct MarchForecast
{
  double seconds = 0.0; ///< of the whole picture, without what is prepared
  /// Pixels between the rays of a picture that does as well: 1, 2 or 4.
  int distance = 1;
  double step = 0.0; ///< that it takes: the one asked for, or half of that
  /// Of such a picture, scaled up: the error of 99.9 % of the pixels, of steps and between rays.
  /// NaN where the distance is 1.
  double error = 0.0;
};

/// Marches four strips of six rows of a picture of this size. Each pixel between others is compared
/// with what is between those; where for all but the share `beyond` of the pixels that is within
/// `room` (a fraction of white; 0: none), with what steps of half the length change, there may be
/// fewer rays. Steps of two voxel edges and more are tried with half of the length, too. Not where
/// surfaces end rays: their outlines are sharp; nor where hardly any ray of the strips meets
/// something.
MarchForecast forecast_march(Marcher& marcher,
  const Scene& scene,
  const MarchSettings& settings,
  int width,
  int height,
  double room = 0.0,
  double beyond = 0.0);

/// The error of such a picture, `film`, of all but the share `beyond` of the pixels, from some
/// thousand rays all over it, marched with steps of half the length.
double error_of_scaled(Marcher& marcher,
  const Scene& scene,
  const MarchSettings& settings,
  const Film& film,
  double beyond);

/// A picture of another size: bilinear between the pixels' middles. Depths are the nearest pixel's.
Film scaled(const Film& film, int width, int height);

/// The scene for a picture of another size: with the surfaces' depths at its rays.
Scene for_size(const Scene& scene, int width, int height, int new_width, int new_height);

}
