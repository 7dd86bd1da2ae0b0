#include "mutation.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace hostile
{

namespace
{

/// splitmix64 (S. Vigna): one state, the same everywhere.
class Random
{
public:
  explicit Random(std::uint64_t seed)
    : state_(seed)
  {
  }
  std::uint64_t next()
  {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
  }
  /// From 0 to count − 1; 0 for a count of 0.
  std::size_t below(std::size_t count) { return count ? next() % count : 0; }

private:
  std::uint64_t state_;
};

/// A place in a text of bytes; two in three are near its beginning, where headers are.
std::size_t place(Random& random, const std::string& bytes)
{
  const std::size_t near = std::min<std::size_t>(bytes.size(), 600);
  return random.below(random.below(3) ? near : bytes.size());
}

void other_number(Random& random, std::string& bytes)
{
  static const char* const numbers[] = { "0", "-1", "1", "2", "3", "7", "255", "65535", "65536",
    "2147483647", "2147483648", "-2147483648", "4294967295", "1000000000000",
    "18446744073709551615", "99999999999999999999999", "1e12", "1e30", "1e-30", "nan", "inf", "1.5",
    "", "x", "0x10" };
  const auto digit = [&](std::size_t i) { return std::isdigit(static_cast<unsigned char>(bytes[i])); };
  std::size_t begin = place(random, bytes);
  while (begin < bytes.size() && !digit(begin))
  {
    ++begin;
  }
  std::size_t end = begin;
  while (end < bytes.size() && digit(end))
  {
    ++end;
  }
  if (end > begin)
  {
    bytes.replace(begin, end - begin, numbers[random.below(sizeof(numbers) / sizeof(*numbers))]);
  }
}

void other_integer(Random& random, std::string& bytes)
{
  static const std::uint64_t numbers[] = { 0, 1, 2, 3, 4, 8, 16, 127, 128, 255, 256, 32767, 32768,
    65535, 65536, 0x7fffffff, 0x80000000, 0xffffffff, 0xfffffffe, 0x100000000, 1000000000000,
    0x7fffffffffffffff, 0xffffffffffffffff };
  const std::size_t size = std::size_t(2) << random.below(3);
  const std::uint64_t number = numbers[random.below(sizeof(numbers) / sizeof(*numbers))];
  const bool big = random.below(2);
  const std::size_t at = random.below(2) ? place(random, bytes) / size * size : place(random, bytes);
  for (std::size_t i = 0; i < size && at + i < bytes.size(); ++i)
  {
    bytes[at + i] = static_cast<char>(number >> 8 * (big ? size - 1 - i : i));
  }
}

void change(Random& random, std::string& bytes, const std::string& donor)
{
  const std::size_t at = place(random, bytes);
  const std::size_t rest = bytes.size() - std::min(at, bytes.size());
  const std::size_t run = std::min<std::size_t>(1 + random.below(random.below(4) ? 8 : 200), rest);
  switch (random.below(10))
  {
    case 0:
    case 1: // bits
      for (std::size_t i = 1 + random.below(4); i > 0 && !bytes.empty(); --i)
      {
        char& byte = bytes[place(random, bytes)];
        byte = static_cast<char>(byte ^ 1 << random.below(8));
      }
      break;
    case 2: // a run
    {
      const std::size_t kind = random.below(3);
      for (std::size_t i = 0; i < run; ++i)
      {
        bytes[at + i] = static_cast<char>(kind == 0 ? 0 : kind == 1 ? 255 : random.below(256));
      }
      break;
    }
    case 3:
    case 4:
      other_number(random, bytes);
      break;
    case 5:
    case 6:
      other_integer(random, bytes);
      break;
    case 7: // the end
      if (random.below(3))
      {
        bytes.resize(random.below(2) ? at : random.below(bytes.size() + 1));
      }
      else
      {
        for (std::size_t i = 1 + random.below(300); i > 0; --i)
        {
          bytes.push_back(static_cast<char>(random.below(256)));
        }
      }
      break;
    case 8: // cut out, or doubled
      if (random.below(2))
      {
        bytes.erase(at, run);
      }
      else
      {
        bytes.insert(at, bytes.substr(at, run));
      }
      break;
    default: // from another file
    {
      const std::string piece = donor.substr(place(random, donor), 1 + random.below(100));
      if (random.below(2))
      {
        bytes.insert(at, piece);
      }
      else
      {
        bytes.replace(at, std::min(piece.size(), rest), piece);
      }
    }
  }
}

}

Example mutated(const Example& example, const std::vector<Example>& others, std::uint64_t seed)
{
  Random random(seed);
  Example result = example;
  auto victim = result.files.begin();
  std::advance(victim, random.below(result.files.size()));
  // The file that is named tells of the others: it is the one in two of three cases.
  const auto named = result.files.find(result.name);
  if (named != result.files.end() && random.below(3))
  {
    victim = named;
  }
  const Example& other = others[random.below(others.size())];
  for (std::size_t i = 1 + random.below(4); i > 0; --i)
  {
    change(random, victim->second, other.files.begin()->second);
  }
  return result;
}

}
