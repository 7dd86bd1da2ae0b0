#include "Transport/timed_march.h"

#include "Transport/step_control.h"

#include <glm/mat4x4.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace brume
{

namespace
{

using Clock = std::chrono::steady_clock;

/// In voxel edges.
constexpr double longest = 4.0;
constexpr double longest_lit = 1.0;
constexpr double shortest = 1.0 / 64.0;
/// Of the time: what the quickest picture may take, and what all are to take.
constexpr double share_of_quickest = 0.5;
constexpr double share_of_all = 0.95;
/// Of what is left then: what a second picture may take that tells what steps cost, and how much
/// shorter its steps are.
constexpr double share_of_second = 0.15;
constexpr double step_of_second = 8.0;
/// Of the quickest picture's time, what goes with its steps, before there is a second.
constexpr double usual_share_of_steps = 0.3;
/// Strips of a picture that tell its time, and how much finer it is than it has to be.
constexpr int rows_of_strip = 6;
constexpr int most_strips = 4;
/// Rays of the strips that have to meet something before there may be fewer.
constexpr std::size_t least_met = 64;
constexpr double long_from = 2.0;   ///< voxel edges
constexpr int longest_distance = 4; ///< pixels; below the rows of a strip
/// What all halvings of the steps change, after the first and by what that changes.
constexpr double rest_of_steps = 1.0 / 3.0;
/// Another picture is made where its steps are shorter by this at the least.
constexpr double worth = 1.2;

double seconds_since(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool is_lit(const Scene& scene)
{
  return scene.fog.enabled || std::any_of(scene.volumes.begin(),
                                scene.volumes.end(),
                                [](const Volume& v) { return v.medium.lit; });
}

/// How many rays of a picture met something.
std::size_t met_by(const Film& film)
{
  std::size_t count = 0;
  for (std::size_t pixel = 0; pixel < film.size(); ++pixel)
  {
    bool any = false;
    for (int c = 0; c < 3; ++c)
    {
      any = any || film.transmittance[c][pixel] < 1.0f || film.radiance[c][pixel] > 0.0f;
    }
    count += any;
  }
  return count;
}

/// For each pixel the largest difference of a channel.
std::vector<double> errors_of(const Film& film, const Film& truth)
{
  std::vector<double> errors(film.size(), 0.0);
  for (std::size_t pixel = 0; pixel < errors.size(); ++pixel)
  {
    for (int c = 0; c < 3; ++c)
    {
      errors[pixel] = std::max({ errors[pixel],
        std::abs(double(film.radiance[c][pixel]) - truth.radiance[c][pixel]),
        std::abs(double(film.transmittance[c][pixel]) - truth.transmittance[c][pixel]) });
    }
  }
  return errors;
}

/// What 99.9 % of the pixels changed by no more than.
double change(const Film& longer, const Film& shorter)
{
  std::vector<double> changes = errors_of(longer, shorter);
  const auto at =
    changes.begin() + static_cast<std::ptrdiff_t>(changes.size() - 1 - changes.size() / 1000);
  std::nth_element(changes.begin(), at, changes.end());
  return *at;
}

}

Scene for_size(const Scene& scene, int width, int height, int new_width, int new_height)
{
  Scene other = scene;
  if (scene.surface_depth.empty() || (width == new_width && height == new_height))
  {
    return other;
  }
  other.surface_depth.resize(static_cast<std::size_t>(new_width) * new_height);
  for (int y = 0; y < new_height; ++y)
  {
    for (int x = 0; x < new_width; ++x)
    {
      const int i = static_cast<int>((2 * x + 1LL) * width / (2 * new_width));
      const int j = static_cast<int>((2 * y + 1LL) * height / (2 * new_height));
      other.surface_depth[static_cast<std::size_t>(y) * new_width + x] =
        scene.surface_depth[static_cast<std::size_t>(j) * width + i];
    }
  }
  return other;
}

namespace
{

/// Rows of a picture, and the scene that draws them.
struct Strip
{
  Scene scene;
  Film film;
};

std::vector<Strip> strips_of(const Scene& scene, int width, int height)
{
  const int rows = std::min(rows_of_strip, height);
  const int count = std::clamp(height / (8 * rows), 1, most_strips);
  std::vector<Strip> strips;
  for (int strip = 0; strip < count; ++strip)
  {
    const int bottom = static_cast<int>((strip + 0.5) * height / count - 0.5 * rows);
    Scene part = scene;
    if (!scene.surface_depth.empty())
    {
      const auto from = scene.surface_depth.begin() + static_cast<std::ptrdiff_t>(bottom) * width;
      part.surface_depth.assign(from, from + static_cast<std::ptrdiff_t>(rows) * width);
    }
    // The strip's edges become those of the picture, −1 and 1.
    const double scale = static_cast<double>(height) / rows;
    glm::dmat4 cut(1.0);
    cut[1][1] = scale;
    cut[3][1] = scale - 2.0 * bottom / rows - 1.0;
    part.camera.clip_from_world = cut * scene.camera.clip_from_world;
    strips.push_back({ std::move(part), Film(width, rows) });
  }
  return strips;
}

/// For all pixels but those at the strips' edges: how far they are from the middle of the four that
/// lie half of the distance from them to the side and up or down, where `finer` strips have shorter
/// steps, with what that changes.
void add_errors(std::vector<double>& errors, const Film& film, const Film& finer, int distance)
{
  const int half = distance / 2;
  const std::ptrdiff_t up = static_cast<std::ptrdiff_t>(half) * film.width;
  for (int y = half; y < film.height - half; ++y)
  {
    for (int x = half; x < film.width - half; ++x)
    {
      const std::ptrdiff_t i = static_cast<std::ptrdiff_t>(y) * film.width + x;
      double error = 0.0;
      const auto compare = [&](const std::vector<float>& plane, const std::vector<float>& fine)
      {
        const float* at = plane.data() + i;
        const double between =
          0.25 * (double(at[up - half]) + at[up + half] + at[-up - half] + at[-up + half]);
        const double truth = fine[static_cast<std::size_t>(i)];
        error = std::max(error, std::abs(between - truth) + rest_of_steps * std::abs(*at - truth));
      };
      for (int c = 0; c < 3; ++c)
      {
        compare(film.radiance[c], finer.radiance[c]);
        compare(film.transmittance[c], finer.transmittance[c]);
      }
      errors.push_back(error);
    }
  }
}

/// The error that all but the share have, credibly.
double all_but(std::vector<double> errors, double share)
{
  const int beyond = std::max(credible_count(static_cast<int>(errors.size()), share), 0);
  std::nth_element(errors.begin(), errors.begin() + beyond, errors.end(), std::greater<>());
  return errors[static_cast<std::size_t>(beyond)];
}

/// The errors of a picture with rays so many pixels apart, by strips of all pixels: of all but the
/// share.
double between(const std::vector<Film>& films,
  const std::vector<Film>& finer,
  int distance,
  double beyond)
{
  std::vector<double> errors;
  for (std::size_t i = 0; i < films.size(); ++i)
  {
    add_errors(errors, films[i], finer[i], distance);
  }
  return all_but(std::move(errors), beyond);
}

}

MarchForecast forecast_march(Marcher& marcher,
  const Scene& scene,
  const MarchSettings& settings,
  int width,
  int height,
  double room,
  double beyond)
{
  MarchForecast forecast;
  forecast.step = settings.step;
  forecast.error = std::numeric_limits<double>::quiet_NaN();
  std::vector<Strip> strips = strips_of(scene, width, height);
  int rows = 0;
  for (Strip& strip : strips)
  {
    forecast.seconds += marcher.render(strip.scene, settings, strip.film).seconds;
    rows += strip.film.height;
  }
  forecast.seconds *= static_cast<double>(height) / rows;
  // Strips that hardly met anything tell nothing of what lies between fewer rays, and rays that
  // meet nothing are soon done.
  std::size_t met = 0;
  for (const Strip& strip : strips)
  {
    met += met_by(strip.film);
  }
  if (met < least_met)
  {
    return forecast;
  }
  if (!(room > 0.0) || !scene.surface_depth.empty() ||
      strips.front().film.height <= longest_distance || width <= 2 * longest_distance)
  {
    return forecast;
  }
  // Long steps are off by other amounts from ray to ray, so that shorter ones may do with fewer
  // rays.
  const bool long_steps = settings.step >= long_from * smallest_voxel_edge(scene);
  std::vector<Film> films;
  for (Strip& strip : strips)
  {
    films.push_back(std::move(strip.film));
  }
  MarchSettings now = settings;
  for (int attempt = 0; attempt < (long_steps ? 2 : 1) && forecast.distance == 1; ++attempt)
  {
    forecast.step = now.step;
    now.step *= 0.5;
    // Where not even this much is within, the shorter steps need not be marched.
    const bool hopeful = between(films, films, 2, beyond) <= room;
    if (!hopeful && !(long_steps && attempt == 0))
    {
      break;
    }
    std::vector<Film> finer;
    for (const Strip& strip : strips)
    {
      finer.emplace_back(width, films.front().height);
      marcher.render(strip.scene, now, finer.back());
    }
    for (int distance = 2; hopeful && distance <= longest_distance; distance *= 2)
    {
      const double error = between(films, finer, distance, beyond);
      if (error > room)
      {
        break;
      }
      forecast.distance = distance;
      forecast.error = error;
    }
    films = std::move(finer);
  }
  return forecast;
}

double error_of_scaled(Marcher& marcher,
  const Scene& scene,
  const MarchSettings& settings,
  const Film& film,
  double beyond)
{
  // A prime, so that rays lie at all places between those of the film.
  const int edge = film.size() < 128 * 128 ? 37 : 61;
  MarchSettings half = settings;
  half.step *= 0.5;
  Film truth(edge, edge);
  marcher.render(scene, half, truth);
  return all_but(errors_of(scaled(film, edge, edge), truth), beyond);
}

Film scaled(const Film& film, int width, int height)
{
  Film large(width, height);
  std::vector<const std::vector<float>*> from;
  std::vector<std::vector<float>*> to;
  for (int c = 0; c < 3; ++c)
  {
    from.insert(from.end(), { &film.radiance[c], &film.transmittance[c] });
    to.insert(to.end(), { &large.radiance[c], &large.transmittance[c] });
  }
  from.push_back(&film.error);
  to.push_back(&large.error);
  for (int y = 0; y < height; ++y)
  {
    const double v = std::clamp((y + 0.5) * film.height / height - 0.5, 0.0, film.height - 1.0);
    const int j = std::min(static_cast<int>(v), std::max(film.height - 2, 0));
    const int below = film.height > 1 ? film.width : 0;
    for (int x = 0; x < width; ++x)
    {
      const double u = std::clamp((x + 0.5) * film.width / width - 0.5, 0.0, film.width - 1.0);
      const int i = std::min(static_cast<int>(u), std::max(film.width - 2, 0));
      const int beside = film.width > 1 ? 1 : 0;
      const double s = u - i;
      const double t = v - j;
      const std::size_t at = static_cast<std::size_t>(j) * film.width + i;
      const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
      for (std::size_t plane = 0; plane < from.size(); ++plane)
      {
        const std::vector<float>& p = *from[plane];
        (*to[plane])[pixel] =
          static_cast<float>((1.0 - t) * ((1.0 - s) * p[at] + s * p[at + beside]) +
                             t * ((1.0 - s) * p[at + below] + s * p[at + below + beside]));
      }
      large.depth[pixel] = film.depth[static_cast<std::size_t>(std::lround(v)) * film.width +
                                      static_cast<std::size_t>(std::lround(u))];
    }
  }
  return large;
}

TimedMarch march_within(Marcher& marcher,
  const Scene& scene,
  const MarchSettings& base,
  double seconds,
  double latest,
  double tolerance,
  Film& film,
  const Progress& progress)
{
  const auto start = Clock::now();
  TimedMarch result;
  result.estimated_error = std::numeric_limits<double>::quiet_NaN();
  MarchSettings settings = base;
  settings.rule = StepRule::Midpoint;
  settings.refinements = 0;
  const double edge = smallest_voxel_edge(scene);
  const double first_step = is_lit(scene) ? longest_lit : longest;
  bool aborted = false;
  double fraction = 0.0; // of the last picture
  const auto march = [&](const Scene& drawn, double step, double until, Film& target)
  {
    settings.step = step * edge;
    return marcher.render(drawn,
      settings,
      target,
      [&](double done)
      {
        fraction = done;
        const double passed = seconds_since(start);
        aborted = progress && !progress(std::min(passed / seconds, 1.0));
        return !aborted && (done >= 1.0 || passed < until);
      });
  };

  // The quickest picture of all.
  double step = first_step;
  result.march = march(scene, step, share_of_quickest * seconds, film);
  result.predicted = result.march.seconds;
  if (aborted)
  {
    return result;
  }
  if (!result.march.completed)
  {
    // No time for that: one of fewer rays.
    const double whole = result.march.seconds / std::max(fraction, 0.01);
    const double rest = std::max(share_of_all * seconds - seconds_since(start), 0.05 * seconds);
    result.distance = std::max(std::sqrt(whole / rest), 1.0);
    Film small(std::max(1, static_cast<int>(film.width / result.distance)),
      std::max(1, static_cast<int>(film.height / result.distance)));
    result.predicted = rest;
    result.march = march(for_size(scene, film.width, film.height, small.width, small.height),
      step,
      std::numeric_limits<double>::infinity(),
      small);
    film = scaled(small, film.width, film.height);
    result.completed = !aborted;
    return result;
  }
  result.completed = true;

  // Better ones, by what those before took: fixed + by_step / step.
  double by_step = usual_share_of_steps * result.march.seconds * step;
  double fixed = result.march.seconds - by_step / step;
  for (int pictures = 1;; ++pictures)
  {
    const double rest = share_of_all * seconds - seconds_since(start);
    double next = rest > fixed ? std::max(by_step / (rest - fixed), shortest) : step;
    const double second = step / step_of_second;
    if (pictures == 1 && fixed + by_step / second < share_of_second * rest)
    {
      next = second; // to learn what steps take
    }
    if (tolerance > 0.0 && pictures > 1)
    {
      // Errors fall with the square of the step, across sharp surfaces only with the step itself.
      next = std::max(next, step * tolerance / std::max(result.estimated_error, 1e-9));
    }
    if (!(next * worth <= step))
    {
      break;
    }
    Film better(film.width, film.height);
    const MarchStatistics now = march(scene, next, latest, better);
    if (aborted)
    {
      result.completed = false;
      return result;
    }
    if (!now.completed)
    {
      break;
    }
    result.predicted = fixed + by_step / next;
    result.estimated_error = change(film, better) / (step / next - 1.0);
    by_step = std::clamp((now.seconds - result.march.seconds) / (1.0 / next - 1.0 / step),
      0.1 * now.seconds * next,
      now.seconds * next);
    fixed = now.seconds - by_step / next;
    result.march = now;
    step = next;
    film = std::move(better);
  }
  result.finest = step <= shortest;
  return result;
}

}
