// No bias from majorants, roulette or the colours' weights: over many seeds, means are off by their
// own standard errors as chance has it, and by nothing else.
#include "../support/path_truth.h"

#include <glm/ext/matrix_transform.hpp>

#include <array>
#include <cstdlib>
#include <iostream>
#include <string>

using namespace path_truth;

namespace
{

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int seeds = 30;
#else
constexpr int seeds = 200;
#endif

/// BRUME_SEED in the environment takes others.
int first_seed()
{
  const char* text = std::getenv("BRUME_SEED");
  return text ? std::atoi(text) : 1001;
}

/// How seeds differ from a truth.
struct Scores
{
  double of_mean = 0.0; ///< of the mean over all seeds, in its standard errors; normal
  double chi_square =
    0.0;                  ///< of the seeds' z, with as many degrees of freedom, as a normal deviate
  double off = 0.0;       ///< the mean, relatively
  double mean_size = 0.0; ///< mean |z|; √(2/π) = 0.80 where z is normal
};

/// Of each channel, of pictures of 8 × 8 equal pixels, each a seed's mean and standard error.
std::array<Scores, 3> scores(const Scene& scene,
  int samples,
  const glm::dvec3& truth,
  int most_scatterings = 0)
{
  std::array<Scores, 3> result;
  glm::dvec3 sum(0.0);
  glm::dvec3 variance(0.0);
  glm::dvec3 squares(0.0);
  const int first = first_seed();
  for (int seed = first; seed < first + seeds; ++seed)
  {
    PathSettings settings;
    settings.samples_per_pixel = samples;
    settings.seed = static_cast<std::uint32_t>(seed);
    settings.most_scatterings = most_scatterings;
    const Mean mean = mean_of(traced(scene, settings, 8, 8));
    for (int c = 0; c < 3; ++c)
    {
      const double off = mean.value[c] - truth[c];
      const double z = off / mean.error[c];
      sum[c] += off;
      variance[c] += mean.error[c] * mean.error[c];
      squares[c] += z * z;
      result[c].mean_size += std::abs(z) / seeds;
    }
  }
  for (int c = 0; c < 3; ++c)
  {
    result[c].of_mean = sum[c] / std::sqrt(variance[c]);
    result[c].off = sum[c] / seeds / truth[c];
    // Wilson and Hilferty's cube root is nearly normal.
    const double ninth = 2.0 / (9.0 * seeds);
    result[c].chi_square = (std::cbrt(squares[c] / seeds) - 1.0 + ninth) / std::sqrt(ninth);
  }
  return result;
}

void expect_unbiased(const std::string& name, const std::array<Scores, 3>& channels, int step = 1)
{
  for (int c = 0; c < 3; c += step)
  {
    const Scores& s = channels[c];
    std::cout << name << ", channel " << c << ": mean " << s.of_mean << " (" << s.off
              << "), chi square " << s.chi_square << ", mean |z| " << s.mean_size << '\n';
    EXPECT_LE(std::abs(s.of_mean), 4.0) << name;
    EXPECT_LE(std::abs(s.chi_square), 4.5) << name;
    EXPECT_NEAR(s.mean_size, 0.798, 0.17 * std::sqrt(240.0 / seeds)) << name;
  }
}

/// What half_space() sends, of isotropic scatterers.
double chandrasekhar(double albedo)
{
  const HFunction h(albedo);
  const double mu = std::cos(30.0 * pi / 180.0);
  const double mu0 = std::cos(50.0 * pi / 180.0);
  return mu0 * 0.25 * albedo * h(mu) * h(mu0) / (mu + mu0);
}

Slab half_space(double albedo, const glm::dvec3& depths)
{
  Slab slab(depths, 1e5);
  slab.medium().albedo = glm::dvec3(albedo);
  slab.add_sun(50.0, 40.0, glm::dvec3(1.0));
  View view = slab.look(30.0, 1e-3);
  view.centre += glm::dvec3(1234.5, 777.7, 0.0);
  view.parallel = true;
  slab.scene.camera = view.camera(1.0);
  return slab;
}

/// Uneven matter, grey or coloured, between bounds that are tight or loose: one voxel in the far
/// corner of each brick row makes the bounds of all bricks those of the densest place.
struct Uneven
{
  Voxels<float> voxels;
  Scene scene;

  Uneven(const glm::dvec3& channels, double loose)
    : voxels(17,
        17,
        17,
        [loose](int i, int j, int k)
        {
          const bool spike = i % 8 == 4 && j % 8 == 4 && k % 8 == 4;
          const float v = 0.5f + 0.5f * std::sin(1.1f * i + 0.3f) * std::cos(0.8f * j) *
                                   std::sin(0.6f * k + 1.0f);
          return spike ? v * float(loose) : v * v;
        })
  {
    Volume& volume = scene.volumes[0];
    volume.grid = voxels.grid();
    volume.meaning = ValueMeaning::Density;
    volume.density.extinction = 0.6;
    volume.density.channels = channels;
    volume.medium.lit = true;
    volume.medium.albedo = glm::dvec3(0.95, 0.7, 0.2);
    volume.medium.lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.5 } };
    Light sun;
    sun.direction = glm::normalize(glm::dvec3(0.3, -0.8, -0.5));
    scene.lights = { sun };
    scene.camera =
      pencil(glm::dvec3(8.3, 7.9, 8.6), glm::dvec3(-0.5, -0.6, -0.62), 30.0).camera(1.0);
  }
};

}

// Roulette ends nearly all of these paths early.
TEST(PathBias, RouletteKeepsTheMean)
{
  for (const double albedo : { 0.2, 0.9 })
  {
    const Slab slab = half_space(albedo, glm::dvec3(60.0));
    expect_unbiased("half-space, albedo " + std::to_string(albedo),
      scores(slab.scene, 100, glm::dvec3(chandrasekhar(albedo))),
      3);
  }
}

// Dark matter, where nearly all paths meet roulette: in packets as path by path. The half-spaces above
// are so wide that packets would lose places in them.
TEST(PathBias, RouletteInPacketsKeepsTheMean)
{
  Uneven dark(glm::dvec3(1.0), 1.0);
  dark.scene.volumes[0].medium.albedo = glm::dvec3(0.24);
  dark.scene.volumes[0].medium.lobes.clear();
  dark.scene.volumes[0].density.extinction = 2.0;
  // A volume of next to nothing is no matter for packets.
  Scene apart = dark.scene;
  apart.volumes.push_back(apart.volumes[0]);
  apart.volumes[1].density.extinction = 1e-12;
  Mean means[2];
  for (int which = 0; which < 2; ++which)
  {
    PathSettings settings;
    settings.samples_per_pixel = 10 * seeds;
    settings.seed = static_cast<std::uint32_t>(first_seed() + which);
    means[which] = mean_of(traced(which ? apart : dark.scene, settings, 32, 32));
  }
  const double error = std::hypot(means[0].error.x, means[1].error.x);
  const double off = means[0].value.x - means[1].value.x;
  std::cout << "packets and single paths differ by " << off / error << " standard errors of "
            << error / means[1].value.x << '\n';
  EXPECT_LE(std::abs(off), 4.0 * error);
}

// All channels of a half-space are alike, however much thinner one is than the hero's. Roulette
// among them: path by path, not in packets.
TEST(PathBias, ColoursAreWeighted)
{
  const Slab slab = half_space(0.4, glm::dvec3(60.0, 120.0, 40.0));
  expect_unbiased("coloured half-space", scores(slab.scene, 60, glm::dvec3(chandrasekhar(0.4))));
}

// Uneven matter, scattered once, against the reference, with bounds as tight as bricks have them
// and eight times too loose.
TEST(PathBias, MajorantsKeepTheMean)
{
  for (const bool coloured : { false, true })
  {
    for (const double loose : { 1.0, 8.0 })
    {
      const Uneven uneven(coloured ? glm::dvec3(1.0, 0.5, 0.2) : glm::dvec3(1.0), loose);
      const Film film = by_reference(1e-6, 16)(uneven.scene, 1, 1);
      const glm::dvec3 truth(film.radiance[0][0], film.radiance[1][0], film.radiance[2][0]);
      expect_unbiased(
        std::string(coloured ? "coloured" : "grey") + (loose > 1.0 ? ", loose" : ", tight"),
        scores(uneven.scene, 40, truth, 1),
        coloured ? 1 : 2);
    }
  }
}
