#include "display_table.h"

#include <cstring>

namespace brume
{

namespace
{

constexpr std::uint32_t infinity_bits = 0x7F800000u;

float float_of(std::uint32_t bits)
{
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}

DisplayTable::DisplayTable(const Display& display)
{
  // Positive floats have the order of their bits.
  std::uint32_t lower = 0;
  for (int byte = 0; byte < 256; ++byte)
  {
    std::uint32_t upper = infinity_bits; // becomes 255
    while (lower < upper)
    {
      const std::uint32_t middle = lower + (upper - lower) / 2;
      if (display_byte(float_of(middle), display) >= byte)
      {
        upper = middle;
      }
      else
      {
        lower = middle + 1;
      }
    }
    this->Least[byte] = float_of(lower);
  }
  int byte = 0;
  this->Start.resize((infinity_bits >> shift) + 1);
  for (std::size_t i = 0; i < this->Start.size(); ++i)
  {
    const float value = float_of(static_cast<std::uint32_t>(i) << shift);
    while (byte < 255 && value >= this->Least[byte + 1])
    {
      ++byte;
    }
    this->Start[i] = static_cast<unsigned char>(byte);
  }
}

}
