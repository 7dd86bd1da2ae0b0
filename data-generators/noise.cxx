// Noise, one place at a time: the kernels of noise-inl.h with packets of one lane.
#define BRUME_ONE_LANE
#include "data-generators/noise_field.h"

#include "data-generators/noise-inl.h"
#include "data-generators/noise_packets.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace brume
{

namespace
{

one_lane::Place lane_of(const glm::dvec3& place)
{
  return { place.x, place.y, place.z };
}

one_lane::Cell cell_of(const glm::dvec3& place, const NoisePeriod& period)
{
  return one_lane::find_cell(lane_of(place), glm::dvec3(period));
}

}

float perlin_noise(const glm::dvec3& place, std::uint32_t seed, const NoisePeriod& period)
{
  return one_lane::perlin_in(cell_of(place, period), seed);
}

float worley_noise(const glm::dvec3& place, std::uint32_t seed, const NoisePeriod& period)
{
  return one_lane::worley_in(cell_of(place, period), seed);
}

float simplex_noise(const glm::dvec3& place, std::uint32_t seed)
{
  return one_lane::simplex(lane_of(place), seed);
}

float fbm(const glm::dvec3& place,
  std::uint32_t seed,
  const NoiseOctaves& octaves,
  const NoisePeriod& period)
{
  return one_lane::sum_octaves<one_lane::Octave::Perlin>(lane_of(place), seed, octaves, period);
}

float simplex_fbm(const glm::dvec3& place, std::uint32_t seed, const NoiseOctaves& octaves)
{
  return one_lane::sum_octaves<one_lane::Octave::Simplex>(
    lane_of(place), seed, octaves, NoisePeriod(0));
}

float billow_fbm(const glm::dvec3& place,
  std::uint32_t seed,
  const NoiseOctaves& octaves,
  const NoisePeriod& period)
{
  return one_lane::sum_octaves<one_lane::Octave::Billow>(lane_of(place), seed, octaves, period);
}

float perlin_worley_noise(const glm::dvec3& place,
  std::uint32_t seed,
  const NoiseOctaves& octaves,
  const NoisePeriod& period)
{
  const one_lane::Place lane = lane_of(place);
  return octaves.count > 0 && one_lane::is_valid(lane)
           ? one_lane::perlin_worley(lane, seed, octaves, period)
           : 0.0f;
}

glm::dvec3 warp(const glm::dvec3& place, double scale, double amplitude, std::uint32_t seed)
{
  const one_lane::Place moved =
    one_lane::warp(lane_of(place), scale, amplitude, seed, NoisePeriod(0));
  return { moved.x, moved.y, moved.z };
}

NoiseField::NoiseField(const NoiseOptions& options)
  : m_options(options)
{
  const auto require = [](bool holds, const char* what)
  {
    if (!holds)
    {
      throw std::invalid_argument(std::string("noise: ") + what);
    }
  };
  const auto above_zero = [](double x) { return x > 0.0 && std::isfinite(x); };
  require(above_zero(options.width), "the width must be above 0");
  require(above_zero(options.feature_size), "the size of the features must be above 0");
  require(options.octaves.count >= 1 && options.octaves.count <= 24, "the octaves must be 1 to 24");
  require(above_zero(options.octaves.lacunarity), "the lacunarity must be above 0");
  require(
    options.octaves.gain >= 0.0 && options.octaves.gain <= 1e6, "the gain must be 0 to 1000000");
  require(std::isfinite(options.warp_amplitude) && std::isfinite(options.warp_size),
    "the warp must be finite");
  require(options.kind != NoiseKind::Simplex ||
            (options.period.x <= 0 && options.period.y <= 0 && options.period.z <= 0),
    "simplex noise does not tile: leave the period 0, or take another kind");
}

Box NoiseField::bounds() const
{
  return { glm::dvec3(0.0), glm::dvec3(m_options.width) };
}

float NoiseField::value(const glm::dvec3& place, double) const
{
  const one_lane::Place lane = lane_of(place);
  return one_lane::is_valid(lane) ? one_lane::noise_of(m_options, lane) : 0.0f;
}

void NoiseField::values(const PlaceBlock& places, double, float* out) const
{
  noise_packets(m_options, places, out);
}

FieldRange NoiseField::range_in(const Box&, double) const
{
  const bool signed_kind =
    m_options.kind == NoiseKind::Perlin || m_options.kind == NoiseKind::Simplex;
  return { signed_kind ? -1.0f : 0.0f, 1.0f };
}

}
