// Random numbers of paths in packets: random_stream.h's, a block of four words at once for each
// lane. Included once for each target (Highway's foreach_target).
#if defined(BRUME_PATH_RANDOM_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_PATH_RANDOM_INL_H
#undef BRUME_PATH_RANDOM_INL_H
#else
#define BRUME_PATH_RANDOM_INL_H
#endif

#include "Transport/packet-inl.h"
#include "Transport/random_stream.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

using Word = hn::Vec<hn::RebindToUnsigned<IntTag>>;
constexpr hn::RebindToUnsigned<IntTag> word_tag{};

/// Four words a lane.
struct Words
{
  Word word[4];
};

/// The lower and the upper half of the products with a constant.
HWY_INLINE void multiply_wide(Word a, std::uint32_t constant, Word& lower, Word& upper)
{
#if HWY_TARGET == HWY_SCALAR
  const std::uint64_t product = std::uint64_t{ constant } * hn::GetLane(a);
  lower = hn::Set(word_tag, static_cast<std::uint32_t>(product));
  upper = hn::Set(word_tag, static_cast<std::uint32_t>(product >> 32));
#else
  constexpr hn::Repartition<std::uint64_t, hn::RebindToUnsigned<IntTag>> wide{};
  const Word factor = hn::Set(word_tag, constant);
  const auto even = hn::MulEven(a, factor);
  const auto odd =
    hn::MulEven(hn::BitCast(word_tag, hn::ShiftRight<32>(hn::BitCast(wide, a))), factor);
  lower = hn::OddEven(hn::BitCast(word_tag, hn::ShiftLeft<32>(odd)), hn::BitCast(word_tag, even));
  upper = hn::OddEven(hn::BitCast(word_tag, odd), hn::BitCast(word_tag, hn::ShiftRight<32>(even)));
#endif
}

/// RandomStream::block, of a counter for each lane.
HWY_INLINE Words random_block(Words counter, std::uint32_t seed)
{
  std::uint32_t key[2] = { seed, RandomStream::own_key };
  for (int round = 0; round < RandomStream::rounds; ++round)
  {
    Word a_lower, a_upper, b_lower, b_upper;
    multiply_wide(counter.word[0], RandomStream::factors[0], a_lower, a_upper);
    multiply_wide(counter.word[2], RandomStream::factors[1], b_lower, b_upper);
    counter = { { hn::Xor(hn::Xor(b_upper, counter.word[1]), hn::Set(word_tag, key[0])),
      b_lower,
      hn::Xor(hn::Xor(a_upper, counter.word[3]), hn::Set(word_tag, key[1])),
      a_lower } };
    key[0] += RandomStream::key_steps[0];
    key[1] += RandomStream::key_steps[1];
  }
  return counter;
}

/// The middle of one of 2³² equal parts of [0, 1], rounded, but for the last of them: never 0, never 1.
HWY_INLINE Real uniform(Word word)
{
  const auto part = [](Word bits) { return hn::ConvertTo(float_tag, hn::BitCast(int_tag, bits)); };
  const Real coarse = part(hn::ShiftRight<8>(word)) * real(0x1p-24f);
  const Real fine = part(hn::And(word, hn::Set(word_tag, 0xFFu)));
  const Real sum = coarse + hn::MulAdd(fine, real(0x1p-32f), real(0x1p-33f));
  return hn::Min(sum, real(1.0f - 0x1p-24f));
}

}
}
HWY_AFTER_NAMESPACE();

#endif
