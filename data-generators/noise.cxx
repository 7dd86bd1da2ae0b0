#include "data-generators/noise.h"

#include "data-generators/random.h"

#include <algorithm>
#include <cmath>

namespace brume
{

namespace
{

/// The largest value of gradient noise with these gradients and this fade; a test searches for it.
constexpr float largest_perlin = 1.0363539f;

/// A place as a lattice cell (modulo 2^32) and the place within it, in [0, 1].
struct Cell
{
  std::uint32_t i[3];
  float f[3];
};

/// False where the place is not a number, or too far off to have a place within its cell.
bool find_cell(const glm::dvec3& place, Cell& cell)
{
  for (int a = 0; a < 3; ++a)
  {
    const double x = place[a];
    if (!(std::fabs(x) < 1e15))
    {
      return false;
    }
    std::int64_t whole = static_cast<std::int64_t>(x);
    whole -= x < static_cast<double>(whole);
    cell.i[a] = static_cast<std::uint32_t>(whole);
    cell.f[a] = static_cast<float>(x - static_cast<double>(whole));
  }
  return true;
}

float fade(float t)
{
  return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

float lerp(float a, float b, float t)
{
  return a + t * (b - a);
}

/// The product of (x, y, z) with one of the 12 vectors to the middles of a cube's edges; four of
/// them twice, as in Perlin's code.
float gradient(std::uint32_t hash, float x, float y, float z)
{
  static const float directions[16][3] = { { 1, 1, 0 },
    { -1, 1, 0 },
    { 1, -1, 0 },
    { -1, -1, 0 },
    { 1, 0, 1 },
    { -1, 0, 1 },
    { 1, 0, -1 },
    { -1, 0, -1 },
    { 0, 1, 1 },
    { 0, -1, 1 },
    { 0, 1, -1 },
    { 0, -1, -1 },
    { 1, 1, 0 },
    { -1, 1, 0 },
    { 0, -1, 1 },
    { 0, -1, -1 } };
  const float* d = directions[hash >> 28];
  return x * d[0] + y * d[1] + z * d[2];
}

using Noise = float (*)(const glm::dvec3&, std::uint32_t);

float billow(const glm::dvec3& place, std::uint32_t seed)
{
  return 1.0f - worley_noise(place, seed);
}

template <Noise noise>
float sum_octaves(const glm::dvec3& place, std::uint32_t seed, const NoiseOctaves& octaves)
{
  double frequency = 1.0;
  double amplitude = 1.0;
  double sum = 0.0;
  double weight = 0.0;
  const int count = std::min(octaves.count, 24);
  for (int octave = 0; octave < count; ++octave)
  {
    sum += amplitude * noise(place * frequency, substream(seed, octave));
    weight += amplitude;
    frequency *= octaves.lacunarity;
    amplitude *= octaves.gain;
  }
  return weight > 0.0 ? static_cast<float>(sum / weight) : 0.0f;
}

}

float perlin_noise(const glm::dvec3& place, std::uint32_t seed)
{
  Cell c;
  if (!find_cell(place, c))
  {
    return 0.0f;
  }
  const std::uint32_t key = mix_bits(seed ^ 0x5bd1e995u);
  const float x = c.f[0], y = c.f[1], z = c.f[2];
  const float u = fade(x), v = fade(y), w = fade(z);
  float layer[2];
  for (std::uint32_t k = 0; k < 2; ++k)
  {
    const float dz = z - static_cast<float>(k);
    const std::uint32_t i = c.i[0], j = c.i[1], l = c.i[2] + k;
    const float near = lerp(gradient(hash_lattice(i, j, l, key), x, y, dz),
      gradient(hash_lattice(i + 1, j, l, key), x - 1.0f, y, dz),
      u);
    const float far = lerp(gradient(hash_lattice(i, j + 1, l, key), x, y - 1.0f, dz),
      gradient(hash_lattice(i + 1, j + 1, l, key), x - 1.0f, y - 1.0f, dz),
      u);
    layer[k] = lerp(near, far, v);
  }
  const float value = lerp(layer[0], layer[1], w) / largest_perlin;
  return std::min(std::max(value, -1.0f), 1.0f);
}

float worley_noise(const glm::dvec3& place, std::uint32_t seed)
{
  Cell c;
  if (!find_cell(place, c))
  {
    return 0.0f;
  }
  const std::uint32_t key = mix_bits(seed ^ 0x1b873593u);
  // Squared distance from the place to the nearest plane of the cells on each side.
  float gap[3][3];
  for (int a = 0; a < 3; ++a)
  {
    gap[a][0] = c.f[a] * c.f[a];
    gap[a][1] = 0.0f;
    gap[a][2] = (1.0f - c.f[a]) * (1.0f - c.f[a]);
  }
  float nearest = 1.0f;
  static const int order[3] = { 1, 0, 2 }; // the place's own cell first, so that most are skipped
  for (int nk : order)
  {
    for (int nj : order)
    {
      if (gap[2][nk] + gap[1][nj] >= nearest)
      {
        continue;
      }
      for (int ni : order)
      {
        if (gap[2][nk] + gap[1][nj] + gap[0][ni] >= nearest)
        {
          continue;
        }
        const std::uint32_t h =
          hash_lattice(c.i[0] + ni - 1u, c.i[1] + nj - 1u, c.i[2] + nk - 1u, key);
        // Ten bits an axis, at the middle of each of 1024 steps.
        const float dx = static_cast<float>(ni - 1) +
                         (static_cast<float>(h & 1023u) + 0.5f) * (1.0f / 1024.0f) - c.f[0];
        const float dy = static_cast<float>(nj - 1) +
                         (static_cast<float>((h >> 10) & 1023u) + 0.5f) * (1.0f / 1024.0f) - c.f[1];
        const float dz = static_cast<float>(nk - 1) +
                         (static_cast<float>((h >> 20) & 1023u) + 0.5f) * (1.0f / 1024.0f) - c.f[2];
        nearest = std::min(nearest, dx * dx + dy * dy + dz * dz);
      }
    }
  }
  return std::sqrt(nearest);
}

float fbm(const glm::dvec3& place, std::uint32_t seed, const NoiseOctaves& octaves)
{
  return sum_octaves<perlin_noise>(place, seed, octaves);
}

float billow_fbm(const glm::dvec3& place, std::uint32_t seed, const NoiseOctaves& octaves)
{
  return sum_octaves<billow>(place, seed, octaves);
}

glm::dvec3 warp(const glm::dvec3& place, double scale, double amplitude, std::uint32_t seed)
{
  if (!(scale > 0.0) || amplitude == 0.0)
  {
    return place;
  }
  const glm::dvec3 at = place / scale;
  return place + amplitude * glm::dvec3(perlin_noise(at, substream(seed, 0)),
                               perlin_noise(at, substream(seed, 1)),
                               perlin_noise(at, substream(seed, 2)));
}

}
