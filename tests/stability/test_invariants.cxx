// What holds of light and steps in every scene: tried in random ones.
#include "invariants.h"

#include "Transport/path_tracer.h"
#include "Transport/step_control.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace stability;

TEST(Invariants, LinearInLights)
{
  HardCase linear("Invariants",
    "radiance is linear in the lights",
    "a clamp, a light that is left out or one that is counted twice shows",
    "all lights together are the sum of each alone within 2e-5 of the brightest; paths of four "
    "times the light "
    "are four times the paths");
  Worst worst;
  Worst worst_paths;
  const int held = try_scenes("linear in lights",
    [&]()
    {
      const RandomScene random = draw_scene(lit_or_not(true));
      const MarchSettings settings = settings_of(random, true);
      const Film all = drawn(random.scene, settings);
      std::vector<double> sum[3];
      for (auto& channel : sum)
      {
        channel.assign(all.size(), 0.0);
      }
      const std::size_t lights = random.scene.lights.size();
      for (std::size_t i = 0; i <= lights; ++i)
      {
        Scene one = random.scene;
        one.lights.clear();
        if (i < lights)
        {
          one.lights.push_back(random.scene.lights[i]);
          one.sky = Sky();
        }
        const Film film = drawn(one, settings);
        for (int c = 0; c < 3; ++c)
        {
          for (std::size_t p = 0; p < film.size(); ++p)
          {
            sum[c][p] += film.radiance[c][p];
          }
        }
      }
      double most = 0.0;
      for (int c = 0; c < 3; ++c)
      {
        for (std::size_t p = 0; p < all.size(); ++p)
        {
          const double off = std::abs(sum[c][p] - all.radiance[c][p]);
          most = off <= most ? most : off;
        }
      }
      RC_ASSERT(worst(most / brightest(all)) <= 2e-5);

      PathSettings paths;
      paths.samples_per_pixel = 2;
      paths.threads = 1;
      paths.most_scatterings = 4;
      Film once(edge, edge);
      Film brighter(edge, edge);
      PathTracer().render(random.scene, paths, once);
      Scene scene = random.scene;
      for (Light& light : scene.lights)
      {
        light.diffuse *= 4.0;
      }
      scene.sky.radiance *= 4.0;
      scene.sky.ground *= 4.0;
      PathTracer().render(scene, paths, brighter);
      most = 0.0;
      for (int c = 0; c < 3; ++c)
      {
        for (std::size_t p = 0; p < once.size(); ++p)
        {
          const double off = std::abs(brighter.radiance[c][p] - 4.0 * once.radiance[c][p]);
          most = off <= most ? most : off;
        }
      }
      RC_ASSERT(worst_paths(most / (4.0 * brightest(once))) <= 1e-5);
    });
  tell(linear, held, worst, 2e-5, "of the brightest", "lit march");
  linear.measure(worst_paths.value, 1e-5, "of the brightest, of four times the light", "paths");
}

TEST(Invariants, Reciprocity)
{
  HardCase swap("Invariants",
    "sun and view change places, single scattering in random layers",
    "cos θ, a sign or a direction that is turned round shows; so does light that is dimmed on one "
    "of its two "
    "ways only",
    "L cos θ of the view is the same within 2e-3, which is what a hundred steps leave, by shadow "
    "rays of each target "
    "and by paths in five of their standard errors");
  Worst worst;
  Worst worst_paths;
  const int held = try_scenes("reciprocity",
    [&]()
    {
      const int layers = *rc::gen::inRange(2, 12);
      std::vector<float> values;
      for (int k = 0; k < layers; ++k)
      {
        values.insert(values.end(), 9, static_cast<float>(*rc::gen::inRange(0, 1000) * 1e-3));
      }
      Scene scene;
      Volume& volume = scene.volumes[0];
      volume.grid.voxels = values.data();
      volume.grid.type = VoxelType::Float32;
      volume.grid.dims[0] = volume.grid.dims[1] = 3;
      volume.grid.dims[2] = layers;
      const double high = layers - 1.0;
      volume.data_from_index = placed(
        glm::dvec3(100.0 * high, 100.0 * high, 1.0), glm::dvec3(-100.0 * high, -100.0 * high, 0.0));
      volume.meaning = ValueMeaning::Density;
      volume.density.extinction = *rc::gen::element(0.01, 0.3, 1.0, 3.0) / high;
      volume.medium.lit = true;
      PhaseLobe lobe;
      lobe.function = *rc::gen::element(
        PhaseFunction::Rayleigh, PhaseFunction::HenyeyGreenstein, PhaseFunction::Schlick);
      lobe.anisotropy = *rc::gen::inRange(-8, 9) * 0.1;
      volume.medium.lobes = { lobe };
      // Unit vectors away from the layers, both up or one down.
      const auto away = [](bool down)
      {
        const double cosine = *rc::gen::inRange(350, 1001) * 1e-3;
        const double turn = *rc::gen::inRange(0, 628) * 0.01;
        const double sine = std::sqrt(1.0 - cosine * cosine);
        return glm::dvec3(sine * std::cos(turn), sine * std::sin(turn), down ? -cosine : cosine);
      };
      const glm::dvec3 to_sun = away(false);
      const glm::dvec3 to_eye = away(*rc::gen::arbitrary<bool>());
      const glm::dvec3 middle(0.0, 0.0, 0.5 * high);
      const auto seen = [&](const glm::dvec3& sun, const glm::dvec3& eye, bool paths, double& error)
      {
        Light light;
        light.direction = -sun;
        scene.lights = { light };
        scene.camera = camera_along(middle + eye * 4.0 * high, middle - eye * 4.0 * high);
        Film film(1, 1);
        if (paths)
        {
          PathSettings settings;
          settings.samples_per_pixel = 256;
          settings.most_scatterings = 1;
          settings.threads = 1;
          PathTracer().render(scene, settings, film);
        }
        else
        {
          MarchSettings settings;
          settings.step = 0.01 * high;
          settings.leave_error = 0.0;
          settings.threads = 1;
          settings.shadows = ShadowMethod::Rays;
          Marcher().render(scene, settings, film);
        }
        error = film.error[0] / 3.0 * std::abs(eye.z);
        return film.radiance[0][0] * std::abs(eye.z);
      };
      double error = 0.0;
      double other_error = 0.0;
      const double here = seen(to_sun, to_eye, false, error);
      const double there = seen(to_eye, to_sun, false, other_error);
      RC_ASSERT(worst(std::abs(here - there) / std::max({ here, there, 1e-3 })) <= 2e-3);
      const double by_paths = seen(to_sun, to_eye, true, error);
      const double back_by_paths = seen(to_eye, to_sun, true, other_error);
      const double noise = std::hypot(error, other_error) + 1e-3 * here + 1e-6;
      RC_ASSERT(worst_paths(std::abs(by_paths - back_by_paths) / noise) <= 5.0);
    });
  tell(swap, held, worst, 2e-3, "relative", "lit march, shadow rays");
  swap.measure(worst_paths.value, 5.0, "standard errors of 256 paths", "paths");
}

namespace
{

/// The largest that a phase function of lobes can be, from above.
double largest_of(const Medium& medium)
{
  double sum = medium.lobes.empty() ? 1.0 : 0.0;
  double weights = medium.lobes.empty() ? 1.0 : 0.0;
  for (const PhaseLobe& lobe : medium.lobes)
  {
    const double g = std::abs(lobe.anisotropy);
    const double k = std::min(1.55 * g - 0.55 * g * g * g + 0.05, 0.999);
    weights += lobe.weight;
    sum += lobe.weight * (lobe.function == PhaseFunction::Isotropic   ? 1.0
                           : lobe.function == PhaseFunction::Rayleigh ? 1.5
                           : lobe.function == PhaseFunction::Schlick
                             ? (1.0 + k) / (1.0 - k)
                             : (1.0 + g) / ((1.0 - g) * (1.0 - g)));
  }
  return sum / weights / (4.0 * pi);
}

/// How far a film is from what light and matter allow; NaN for what is not a number.
double beyond(const Film& film, const glm::dvec3& most_sent)
{
  double worst = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      const double t = film.transmittance[c][i];
      const double l = film.radiance[c][i];
      const double most = most_sent[c] * (1.0 - t);
      const double off = std::max({ -t, t - 1.0, -l, (l - most) / std::max(most_sent[c], 1.0) });
      worst = off <= worst ? worst : off;
    }
  }
  return worst;
}

}

TEST(Invariants, SaneUnlit)
{
  HardCase sane("Invariants",
    "no pixel is negative, not finite or brighter than its matter: emission and absorption, "
    "projections",
    "a quadrature that overshoots, a table read beyond its end, 1 − T of a T that is not the sum's",
    "0 ≤ T ≤ 1 and 0 ≤ L ≤ the brightest colour · (1 − T), but for 1e-5");
  Worst worst;
  const int held = try_scenes("sane pictures",
    [&]()
    {
      RandomScene random = draw_scene(lit_or_not(false));
      Scene& scene = random.scene;
      const bool classified = std::all_of(scene.volumes.begin(),
        scene.volumes.end(),
        [](const Volume& v) { return v.meaning == ValueMeaning::Classified; });
      if (classified && scene.volumes.size() == 1)
      {
        scene.blend_mode = *rc::gen::element(BlendMode::Composite,
          BlendMode::Composite,
          BlendMode::MaximumIntensity,
          BlendMode::MinimumIntensity,
          BlendMode::Isosurface,
          BlendMode::Slice);
        scene.isosurfaces = { 0.3, 0.6 };
        scene.slice =
          glm::dvec4(random.view.forward, -glm::dot(random.view.forward, random.view.centre));
      }
      glm::dvec3 most(0.0);
      for (const Volume& volume : scene.volumes)
      {
        const std::vector<double>& rgb = volume.classification.rgb;
        for (std::size_t i = 0; i < rgb.size(); ++i)
        {
          most[i % 3] = std::max(most[i % 3], rgb[i]);
        }
      }
      MarchSettings settings = settings_of(random, false);
      settings.rule = *rc::gen::element(StepRule::Midpoint, StepRule::Integrated, StepRule::Cells);
      settings.step *= *rc::gen::element(0.3, 1.0, 10.0, 1000.0);
      settings.jitter = *rc::gen::arbitrary<bool>();
      settings.refinements = *rc::gen::inRange(0, 4);
      RC_ASSERT(worst(beyond(drawn(scene, settings), most)) <= 1e-5);
    });
  tell(sane, held, worst, 1e-5, "beyond what is allowed", "march and projections");
}

TEST(Invariants, SaneLit)
{
  HardCase sane("Invariants",
    "no pixel is negative, not finite or beyond what the lights can give: lit media",
    "shadows that amplify, phase functions beyond their largest value, cosines beyond 1",
    "0 ≤ T ≤ 1 and 0 ≤ L ≤ albedo · (E · largest phase + sky) · (1 − T), but for 2e-5; paths never "
    "negative, "
    "always finite");
  Worst worst;
  bool finite = true;
  const int held = try_scenes("sane lit pictures",
    [&]()
    {
      RandomScene random = draw_scene(lit_or_not(true));
      Scene& scene = random.scene;
      glm::dvec3 arrives(0.5 * (scene.sky.radiance + scene.sky.ground));
      glm::dvec3 most(0.0);
      for (const Volume& volume : scene.volumes)
      {
        glm::dvec3 sends = arrives;
        for (const Light& light : scene.lights)
        {
          sends += pi * light.diffuse * largest_of(volume.medium);
        }
        sends *= volume.medium.albedo;
        for (int c = 0; c < 3; ++c)
        {
          most[c] = std::max(most[c], sends[c]);
        }
      }
      MarchSettings settings = settings_of(random, true);
      settings.shadows = *rc::gen::element(
        ShadowMethod::None, ShadowMethod::Rays, ShadowMethod::Volume, ShadowMethod::Functions);
      settings.precise_shadows = *rc::gen::arbitrary<bool>();
      settings.step *= *rc::gen::element(0.5, 1.0, 10.0, 1000.0);
      settings.jitter = *rc::gen::arbitrary<bool>();
      RC_ASSERT(worst(beyond(drawn(scene, settings), most)) <= 2e-5);
      PathSettings paths;
      paths.samples_per_pixel = 1;
      paths.threads = 1;
      Film film(edge, edge);
      PathTracer().render(scene, paths, film);
      for (int c = 0; c < 3; ++c)
      {
        for (std::size_t i = 0; i < film.size(); ++i)
        {
          const double v = film.radiance[c][i];
          finite = finite && v >= 0.0 && std::isfinite(v) && film.transmittance[c][i] >= 0.0f &&
                   film.transmittance[c][i] <= 1.0f;
        }
      }
      RC_ASSERT(finite);
    });
  tell(sane, held, worst, 2e-5, "beyond what is allowed", "lit march");
  sane.holds(finite, "finite and not negative", "paths");
}

namespace
{

/// How far the mean of a white furnace's picture is from 1.
double in_standard_errors(const Scene& scene, int samples, std::uint32_t seed)
{
  PathSettings paths;
  paths.samples_per_pixel = samples;
  paths.seed = seed;
  paths.threads = 1;
  Film film(edge, edge);
  PathTracer().render(scene, paths, film);
  double off = 0.0;
  double noise = 0.0;
  for (std::size_t i = 0; i < film.size(); ++i)
  {
    // A grey pixel's path is 0 or 1 here, so that its noise is that of the chance to pass;
    // coloured ones tell theirs.
    const double t = film.transmittance[1][i];
    off += film.radiance[1][i] + t - 1.0;
    noise += std::max(t * (1.0 - t) / samples, film.error[i] * film.error[i] / 9.0);
  }
  // The steps of the transmittance are off by some thousandths of a pixel.
  return std::abs(off) / (std::sqrt(noise) + 0.1);
}

}

TEST(Invariants, Furnace)
{
  HardCase furnace("Invariants",
    "white matter in even light from all around cannot be seen",
    "each scattering keeps the light: a fault of a thousandth in weights, roulette or tracking "
    "adds up to "
    "the number of scatterings",
    "L + T = 1 in the mean of each picture within five standard errors, of 64 times as many paths "
    "where 32 a pixel say otherwise");
  Worst worst;
  const int held = try_scenes("furnaces",
    [&]()
    {
      SceneWishes wishes = lit_or_not(true);
      RandomScene random = draw_scene(wishes);
      Scene& scene = random.scene;
      scene.lights.clear();
      scene.sky.radiance = scene.sky.ground = glm::dvec3(1.0);
      for (Volume& volume : scene.volumes)
      {
        volume.medium.albedo = glm::dvec3(1.0);
        std::fill(volume.classification.rgb.begin(), volume.classification.rgb.end(), 1.0);
      }
      // Of rare paths that bring much, few samples underestimate the noise: what looks wrong is
      // tried again with more of other paths, and a true fault stands out eight times as far.
      double off = in_standard_errors(scene, 32, 1);
      if (off > 5.0)
      {
        off = in_standard_errors(scene, 64 * 32, 2);
      }
      RC_ASSERT(worst(off) <= 5.0);
    });
  tell(furnace, held, worst, 5.0, "standard errors of a picture", "paths");
}

TEST(Invariants, LeavingEarly)
{
  HardCase early("Invariants",
    "rays that are left when little more can come, and bricks that are leapt over",
    "what is behind may be brighter than what is in front; a brick may be visible in a corner "
    "alone",
    "leaving changes no pixel by more than was allowed; leaping by no more than rounding does");
  Worst worst_leap;
  try_unlit_and_lit(early,
    "leaving early",
    1.0,
    "of what was allowed",
    [&worst_leap](bool lit, Worst& worst)
    {
      const RandomScene random = draw_scene(lit_or_not(lit));
      MarchSettings settings = settings_of(random, lit);
      const Film all = drawn(random.scene, settings);
      const double allowed = *rc::gen::element(1e-1, 1e-2, 1e-3);
      settings.leave_error = allowed;
      RC_ASSERT(worst(difference(all, drawn(random.scene, settings)) / (allowed + 1e-5)) <= 1.0);
      settings.leave_error = 0.0;
      settings.leaping = false;
      RC_ASSERT(worst_leap(relative(all, drawn(random.scene, settings)) / rounding) <= 1.0);
    });
  early.measure(worst_leap.value, 1.0, "of rounding between leaps and none", "march, lit march");
}

namespace
{

/// How many rays of two pictures met matter, and of how many a channel differs by more than a
/// bound.
void count_changed(const Film& a,
  const Film& b,
  double bound,
  std::int64_t& met,
  std::int64_t& changed)
{
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    bool any = false;
    double most = 0.0;
    for (int c = 0; c < 3; ++c)
    {
      const double l = std::abs(double(a.radiance[c][i]) - b.radiance[c][i]);
      const double t = std::abs(double(a.transmittance[c][i]) - b.transmittance[c][i]);
      any = any || a.transmittance[c][i] < 1.0f || b.transmittance[c][i] < 1.0f;
      most = std::max({ l, t, most });
    }
    met += any;
    changed += !(most <= bound);
  }
}

}

TEST(Invariants, HalvedStep)
{
  HardCase halved("Invariants",
    "halving the step that was chosen for a tolerance of 1e-2 or 1e-3",
    "the choice has looked at 1024 other rays than the picture's, of which few may meet a small "
    "thing, and refines by estimates; transfer functions may jump anywhere",
    "where the choice says that it is met, 99.9 % of all rays that meet matter change by no more "
    "than the error that was stated and half of it: a quarter is the error of the halved steps. "
    "Not "
    "every ray does: single ones that graze what no probe ray met are off by any amount. The count "
    "may be beyond by three of its standard deviations");
  for (const bool lit : { false, true })
  {
    std::int64_t met = 0;
    std::int64_t changed = 0;
    const int held = try_scenes("halved steps",
      [&]()
      {
        const RandomScene random = draw_scene(lit_or_not(lit));
        const double tolerance = *rc::gen::element(1e-2, 1e-3);
        Marcher marcher;
        MarchSettings settings = settings_of(random, lit);
        settings.shadows = lit ? ShadowMethod::Volume : ShadowMethod::None;
        const StepChoice choice =
          choose_step(marcher, random.scene, tolerance, 1, settings, 0.0, 32);
        settings.rule = choice.rule;
        settings.step = choice.step;
        settings.refinements = choice.refinements;
        settings.refine_error = choice.refine_error;
        const Film film = drawn(random.scene, settings);
        settings.step *= 0.5;
        const Film finer = drawn(random.scene, settings);
        RC_ASSERT(all_finite(film) && all_finite(finer));
        if (choice.met)
        {
          count_changed(film, finer, 1.5 * tolerance * brightest(film), met, changed);
        }
      });
    RecordProperty(lit ? "lit_rays" : "rays", std::to_string(changed) + "/" + std::to_string(met));
    const double rays = std::max<double>(met, 1.0);
    halved.measure(changed / rays,
      1e-3 + 3.0 * std::sqrt(1e-3 / rays),
      "of the rays that meet matter",
      march(lit));
    halved.holds(held, property_trials(few), "random scenes", march(lit));
  }
}
