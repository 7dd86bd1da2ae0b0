// Many values to bytes: display_byte() by a table.
#pragma once

#include "film_io.h"

#include <array>
#include <cstdint>
#include <vector>

namespace brume
{

/// The bytes that one display makes of values; the same as display_byte(), some ten times as fast for a
/// curve. A display is monotone, so that the least value of each byte says it all.
class VTKBRUMEIO_EXPORT DisplayTable
{
public:
  explicit DisplayTable(const Display& display);

  unsigned char operator()(float value) const
  {
    if (!(value > 0.0f)) // NaN too
    {
      return 0;
    }
    int byte = value < this->Least[255] ? this->Start[bits_of(value) >> shift] : 255;
    while (byte < 255 && value >= this->Least[byte + 1])
    {
      ++byte;
    }
    return static_cast<unsigned char>(byte);
  }

private:
  static constexpr int shift = 15;
  static std::uint32_t bits_of(float value);

  std::array<float, 256> Least;     ///< the least value, above 0, that becomes this byte or a higher one
  std::vector<unsigned char> Start; ///< the byte of the least value with these leading bits
};

inline std::uint32_t DisplayTable::bits_of(float value)
{
  std::uint32_t bits;
  static_assert(sizeof bits == sizeof value);
  __builtin_memcpy(&bits, &value, sizeof bits);
  return bits;
}

}
