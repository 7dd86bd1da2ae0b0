// Random numbers that depend on what they are for, and on nothing else.
#pragma once

#include <array>
#include <cstdint>

namespace brume
{

/// A stream of uniform random numbers for one path: the same for the same seed, pixel and sample,
/// whatever else is drawn and on whichever thread. Philox 4×32 with ten rounds: J. K. Salmon, M. A.
/// Moraes, R. O. Dror, D. E. Shaw, Parallel random numbers: as easy as 1, 2, 3, SC 2011.
class RandomStream
{
public:
  RandomStream(std::uint32_t seed, std::uint64_t pixel, std::uint32_t sample)
    : Counter{ 0,
      sample,
      static_cast<std::uint32_t>(pixel),
      static_cast<std::uint32_t>(pixel >> 32) }
    , Seed(seed)
  {
  }

  /// The first number of a path, before any is drawn: of each `strata` samples of a pixel that follow
  /// one another, beginning with a multiple of it, one is in each of as many equal parts of [0, 1]. Each is
  /// as uniform as without, and independent of all that are not among those samples.
  void stratify()
  {
    this->Block = block(this->Counter, { this->Seed, own_key });
    const Words turned =
      block({ of_strata, this->Counter[1] / strata, this->Counter[2], this->Counter[3] },
        { this->Seed, own_key });
    const std::uint32_t part = (this->Counter[1] ^ turned[0]) % strata;
    this->Block[0] = part << (32 - strata_bits) | this->Block[0] >> strata_bits;
    ++this->Counter[0];
    this->Used = 0;
  }

  /// The next 32 random bits.
  std::uint32_t bits()
  {
    if (this->Used == 4)
    {
      this->Block = block(this->Counter, { this->Seed, own_key });
      ++this->Counter[0];
      this->Used = 0;
    }
    return this->Block[this->Used++];
  }

  /// The middle of one of 2³² equal parts of [0, 1]: never 0, never 1.
  double uniform() { return (this->bits() + 0.5) * 0x1p-32; }

  /// What the function consists of.
  ///@{
  static constexpr int rounds = 10;
  static constexpr std::uint32_t factors[2] = { 0xD2511F53u, 0xCD9E8D57u };
  static constexpr std::uint32_t key_steps[2] = { 0x9E3779B9u, 0xBB67AE85u };
  static constexpr std::uint32_t own_key = 0x42727565u; ///< beside the seed
  static constexpr int strata_bits = 3;
  static constexpr std::uint32_t strata = 1u << strata_bits;
  static constexpr std::uint32_t of_strata = 0xFFFFFFFFu; ///< in place of the number of a draw
  ///@}

  using Words = std::array<std::uint32_t, 4>;
  /// The function itself, of a counter and a key.
  static Words block(Words counter, std::array<std::uint32_t, 2> key)
  {
    for (int round = 0; round < rounds; ++round)
    {
      const std::uint64_t a = std::uint64_t{ factors[0] } * counter[0];
      const std::uint64_t b = std::uint64_t{ factors[1] } * counter[2];
      counter = { static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0],
        static_cast<std::uint32_t>(b),
        static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1],
        static_cast<std::uint32_t>(a) };
      key[0] += key_steps[0];
      key[1] += key_steps[1];
    }
    return counter;
  }

private:
  Words Counter;
  Words Block{};
  std::uint32_t Seed;
  int Used = 4;
};

}
