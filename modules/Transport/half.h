// Numbers of 16 bits (IEEE 754 binary16, "half"), and how they become single precision and back.
#pragma once

#include <cstdint>
#include <cstring>

namespace brume
{

/// Exact. Infinities and NaN stay what they are.
inline float float_from_half(std::uint16_t half)
{
  // The exponent moves by 127 − 15, by a multiplication that also brings denormals into place.
  std::uint32_t bits = static_cast<std::uint32_t>(half & 0x7fffu) << 13;
  float value;
  std::memcpy(&value, &bits, sizeof(value));
  value *= 0x1p112f;
  std::memcpy(&bits, &value, sizeof(bits));
  bits |= (half & 0x7c00u) == 0x7c00u ? 0x7f800000u : 0u;
  bits |= static_cast<std::uint32_t>(half & 0x8000u) << 16;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

/// Rounds to the nearest, ties to even; beyond 65504 (by half a step or more) to infinity.
inline std::uint16_t half_from_float(float value)
{
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  const auto sign = static_cast<std::uint16_t>(bits >> 16 & 0x8000u);
  bits &= 0x7fffffffu;
  if (bits >= 0x47800000u) // 2¹⁶ and above, infinities, NaN
  {
    return sign | (bits > 0x7f800000u ? 0x7e00u : 0x7c00u);
  }
  if (bits < 0x38800000u) // below 2⁻¹⁴: the sum's last bit is worth 2⁻²⁴, a half's smallest step
  {
    float magnitude;
    std::memcpy(&magnitude, &bits, sizeof(magnitude));
    magnitude += 0.5f;
    std::memcpy(&bits, &magnitude, sizeof(bits));
    return static_cast<std::uint16_t>(sign | (bits - 0x3f000000u));
  }
  const std::uint32_t odd = bits >> 13 & 1u;
  return static_cast<std::uint16_t>(sign | ((bits - 0x38000000u + 0xfffu + odd) >> 13));
}

}
