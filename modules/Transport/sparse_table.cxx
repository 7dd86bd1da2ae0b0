#include "Transport/sparse_table.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <stdexcept>
#include <string>

namespace brume
{

namespace
{

constexpr int most_page_shift = 6;
constexpr std::size_t most_entries = std::numeric_limits<std::int32_t>::max();
constexpr std::size_t never = std::numeric_limits<std::size_t>::max();
/// Cubes in boxes that are looked at to try one shape of a table: so many, or so many for each brick
/// and box if that is more. Time and memory then grow with what there is, not with how wide it is.
constexpr std::size_t few_tried = std::size_t(1) << 20;
constexpr std::size_t tried_for_each = 4;

/// Every third bit, from the lowest on, gets a bit of a number of 21 bits.
std::uint64_t spread(std::uint64_t x)
{
  x = (x | x << 32) & 0x001f00000000ffffu;
  x = (x | x << 16) & 0x001f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  return (x | x << 2) & 0x1249249249249249u;
}

std::int32_t gather(std::uint64_t x)
{
  x &= 0x1249249249249249u;
  x = (x | x >> 2) & 0x10c30c30c30c30c3u;
  x = (x | x >> 4) & 0x100f00f00f00f00fu;
  x = (x | x >> 8) & 0x001f0000ff0000ffu;
  x = (x | x >> 16) & 0x001f00000000ffffu;
  return static_cast<std::int32_t>((x | x >> 32) & 0x1fffffu);
}

std::size_t cubes_in(const std::array<std::int32_t, 3>& dims, int shift)
{
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    count *= static_cast<std::size_t>((dims[axis] - 1) >> shift) + 1;
  }
  return count;
}

/// Calls visit(cube) for each cube of (2^shift)³ bricks that the box touches.
template <class Visit>
void for_each_cube(const BrickBox& box, int shift, const Visit& visit)
{
  BrickPlace cube;
  for (cube[2] = box.first[2] >> shift; cube[2] <= box.last[2] >> shift; ++cube[2])
  {
    for (cube[1] = box.first[1] >> shift; cube[1] <= box.last[1] >> shift; ++cube[1])
    {
      for (cube[0] = box.first[0] >> shift; cube[0] <= box.last[0] >> shift; ++cube[0])
      {
        visit(cube);
      }
    }
  }
}

/// The box in cubes of (2^shift)³ bricks: those that it touches.
BrickBox touched(const BrickBox& box, int shift)
{
  BrickBox cubes;
  for (int axis = 0; axis < 3; ++axis)
  {
    cubes.first[axis] = box.first[axis] >> shift;
    cubes.last[axis] = box.last[axis] >> shift;
  }
  return cubes;
}

std::size_t touched_cubes(const BrickBox& box, int shift)
{
  return touched(box, shift).size();
}

/// Of these cubes the outermost, which alone can be held in part: how many, and each of them.
std::size_t outermost_cubes(const BrickBox& box, int shift)
{
  const BrickBox cubes = touched(box, shift);
  std::size_t inside = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    inside *= static_cast<std::size_t>(std::max(cubes.last[axis] - cubes.first[axis] - 1, 0));
  }
  return cubes.size() - inside;
}

template <class Visit>
void for_each_outermost_cube(const BrickBox& box, int shift, const Visit& visit)
{
  const BrickBox cubes = touched(box, shift);
  const auto at_end = [&](const BrickPlace& cube, int axis)
  { return cube[axis] == cubes.first[axis] || cube[axis] == cubes.last[axis]; };
  BrickPlace cube;
  for (cube[2] = cubes.first[2]; cube[2] <= cubes.last[2]; ++cube[2])
  {
    for (cube[1] = cubes.first[1]; cube[1] <= cubes.last[1]; ++cube[1])
    {
      const bool whole_row = at_end(cube, 2) || at_end(cube, 1);
      const std::int32_t step =
        whole_row ? 1 : std::max(cubes.last[0] - cubes.first[0], std::int32_t{ 1 });
      for (cube[0] = cubes.first[0]; cube[0] <= cubes.last[0]; cube[0] += step)
      {
        visit(cube);
      }
    }
  }
}

/// Whether the box holds all of the cube.
bool covers(const BrickBox& box, const BrickPlace& cube, int shift)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (box.first[axis] > cube[axis] << shift || box.last[axis] < ((cube[axis] + 1) << shift) - 1)
    {
      return false;
    }
  }
  return true;
}

void sort_unique(std::vector<std::uint64_t>& numbers)
{
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

/// What is to be in the table, and what each shape of it would take.
class Contents
{
public:
  Contents(const std::array<std::int32_t, 3>& dims,
    const std::vector<BrickPlace>& places,
    const std::vector<BrickBox>& boxes)
    : Dims(dims)
    , Boxes(boxes)
    , MostTried(std::max(few_tried, tried_for_each * (places.size() + boxes.size())))
    , Numbers(places.size())
  {
    tbb::parallel_for(
      std::size_t(0), places.size(), [&](std::size_t i) { this->Numbers[i] = morton(places[i]); });
    if (std::adjacent_find(this->Numbers.begin(), this->Numbers.end()) != this->Numbers.end())
    {
      throw std::invalid_argument("two bricks of the sparse grid are at one place");
    }
    for (const BrickBox& box : boxes)
    {
      this->Uniform.push_back(box.slot);
    }
    std::sort(this->Uniform.begin(), this->Uniform.end());
    this->Uniform.erase(
      std::unique(this->Uniform.begin(), this->Uniform.end()), this->Uniform.end());
  }

  /// The slots of boxes, rising.
  const std::vector<std::int32_t>& uniform() const { return this->Uniform; }

  /// Numbers of the pages that need a block of their own, rising: those with a brick in them, and
  /// those that a box covers in part. False where they are too many to look at.
  bool mixed_pages(int shift, std::vector<std::uint64_t>& pages) const
  {
    pages.clear();
    for (std::uint64_t number : this->Numbers)
    {
      const std::uint64_t page = number >> 3 * shift;
      if (pages.empty() || pages.back() != page)
      {
        pages.push_back(page);
      }
    }
    std::size_t tried = 0;
    for (const BrickBox& box : this->Boxes)
    {
      if (shift == 0)
      {
        break;
      }
      if ((tried += outermost_cubes(box, shift)) > this->MostTried)
      {
        return false;
      }
      for_each_outermost_cube(box,
        shift,
        [&](const BrickPlace& page)
        {
          if (!covers(box, page, shift))
          {
            pages.push_back(morton(page));
          }
        });
    }
    if (!this->Boxes.empty())
    {
      sort_unique(pages);
    }
    return true;
  }

  /// Numbers of the cubes of (2^shift)³ bricks with anything in them, rising. False as above.
  bool occupied_cubes(int shift, std::vector<std::uint64_t>& cubes) const
  {
    cubes.clear();
    for (std::uint64_t number : this->Numbers)
    {
      const std::uint64_t cube = number >> 3 * shift;
      if (cubes.empty() || cubes.back() != cube)
      {
        cubes.push_back(cube);
      }
    }
    std::size_t tried = 0;
    for (const BrickBox& box : this->Boxes)
    {
      if ((tried += touched_cubes(box, shift)) > this->MostTried)
      {
        return false;
      }
      for_each_cube(box, shift, [&](const BrickPlace& cube) { cubes.push_back(morton(cube)); });
    }
    if (!this->Boxes.empty())
    {
      sort_unique(cubes);
    }
    return true;
  }

  /// Entries of a table whose pages are dense over the box.
  std::size_t dense_entries(int page_shift) const
  {
    std::vector<std::uint64_t> mixed;
    const std::size_t pages = cubes_in(this->Dims, page_shift);
    if (pages > most_entries || !this->mixed_pages(page_shift, mixed))
    {
      return never;
    }
    const std::size_t slots = this->blocks(mixed.size()) << 3 * page_shift;
    return slots > most_entries ? never : pages + slots;
  }

  /// Entries of a table with a directory.
  std::size_t directory_entries(int page_shift, int directory_shift) const
  {
    std::vector<std::uint64_t> numbers;
    const std::size_t cubes = cubes_in(this->Dims, page_shift + directory_shift);
    if (cubes > most_entries || !this->mixed_pages(page_shift, numbers))
    {
      return never;
    }
    const std::size_t slots = this->blocks(numbers.size()) << 3 * page_shift;
    if (!this->occupied_cubes(page_shift + directory_shift, numbers))
    {
      return never;
    }
    const std::size_t pages = (1 + numbers.size()) << 3 * directory_shift;
    return slots > most_entries || pages > most_entries ? never : cubes + pages + slots;
  }

private:
  std::size_t blocks(std::size_t mixed) const { return 1 + this->Uniform.size() + mixed; }

  const std::array<std::int32_t, 3>& Dims;
  const std::vector<BrickBox>& Boxes;
  std::size_t MostTried;
  std::vector<std::uint64_t> Numbers; ///< of the bricks, rising
  std::vector<std::int32_t> Uniform;
};

/// Sets the shape that takes the least memory; throws where none is possible.
void choose_shape(
  const Contents& contents, std::size_t pool_bytes, std::size_t most_bytes, SparseTable& table)
{
  std::size_t dense = never;
  for (int k = 0; k <= most_page_shift; ++k)
  {
    const std::size_t entries = contents.dense_entries(k);
    if (entries < dense)
    {
      dense = entries;
      table.page_shift = k;
    }
  }
  const std::size_t worth_it = pool_bytes / 32 / sizeof(std::int32_t);
  const std::size_t affordable = most_bytes / sizeof(std::int32_t);
  if (dense <= std::min(worth_it, affordable))
  {
    return;
  }
  std::size_t least = dense == never || dense > affordable ? never : dense - worth_it;
  for (int k = 2; k <= 4; ++k)
  {
    for (int d = 2; d <= most_page_shift; ++d)
    {
      const std::size_t entries = contents.directory_entries(k, d);
      if (entries < least)
      {
        least = entries;
        table.page_shift = k;
        table.directory_shift = d;
      }
    }
  }
  const std::size_t entries = table.directory_shift > 0 ? least : dense;
  if (entries == never)
  {
    throw std::length_error("the sparse grid's table would have more than 2^31 entries");
  }
  if (entries > affordable)
  {
    throw std::length_error("the sparse grid's table would take " +
      std::to_string(entries / (std::size_t(1) << 18)) + " MiB");
  }
}

}

std::uint64_t morton(const BrickPlace& place)
{
  return spread(static_cast<std::uint32_t>(place[0])) |
         spread(static_cast<std::uint32_t>(place[1])) << 1 |
         spread(static_cast<std::uint32_t>(place[2])) << 2;
}

BrickPlace from_morton(std::uint64_t number)
{
  return { { gather(number), gather(number >> 1), gather(number >> 2) } };
}

SparseTable::SparseTable(const std::array<std::int32_t, 3>& dims,
  const std::vector<BrickPlace>& places,
  std::int32_t first_slot,
  const std::vector<BrickBox>& boxes,
  std::size_t pool_bytes,
  std::size_t most_bytes)
{
  const Contents contents(dims, places, boxes);
  choose_shape(contents, pool_bytes, most_bytes, *this);
  const int k = page_shift;
  const int d = directory_shift;
  const int top_shift = k + d;
  for (int axis = 0; axis < 3; ++axis)
  {
    top[axis] = ((dims[axis] - 1) >> top_shift) + 1;
  }
  const auto top_index = [&](const BrickPlace& cube)
  { return (static_cast<std::size_t>(cube[2]) * top[1] + cube[1]) * top[0] + cube[0]; };

  std::vector<std::uint64_t> numbers;
  if (d > 0)
  {
    contents.occupied_cubes(top_shift, numbers);
    directory.assign(cubes_in(dims, top_shift), 0);
    pages.assign((1 + numbers.size()) << 3 * d, 0);
    for (std::size_t i = 0; i < numbers.size(); ++i)
    {
      directory[top_index(from_morton(numbers[i]))] = static_cast<std::int32_t>((1 + i) << 3 * d);
    }
  }
  else
  {
    pages.assign(cubes_in(dims, top_shift), 0);
  }
  const auto page_at = [&](const BrickPlace& page) -> std::int32_t&
  {
    if (d == 0)
    {
      return pages[top_index(page)];
    }
    const std::int32_t mask = (1 << d) - 1;
    const std::int32_t cube =
      directory[top_index({ { page[0] >> d, page[1] >> d, page[2] >> d } })];
    return pages[cube + (((page[2] & mask) << d | (page[1] & mask)) << d | (page[0] & mask))];
  };
  const std::int32_t mask = (1 << k) - 1;
  const auto in_page = [&](std::int32_t x, std::int32_t y, std::int32_t z)
  { return ((z & mask) << k | (y & mask)) << k | (x & mask); };

  // Blocks of slots: the background's, those of whole pages of one slot, then the others.
  contents.mixed_pages(k, numbers);
  const std::vector<std::int32_t>& uniform = contents.uniform();
  const std::size_t first_mixed = 1 + uniform.size();
  slots.assign((first_mixed + numbers.size()) << 3 * k, 0);
  for (std::size_t i = 0; i < uniform.size(); ++i)
  {
    std::fill_n(slots.begin() + static_cast<std::ptrdiff_t>((1 + i) << 3 * k),
      std::size_t(1) << 3 * k,
      uniform[i]);
  }
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    page_at(from_morton(numbers[i])) = static_cast<std::int32_t>((first_mixed + i) << 3 * k);
  }

  bool overlap = false;
  for (const BrickBox& box : boxes)
  {
    const std::size_t at =
      std::lower_bound(uniform.begin(), uniform.end(), box.slot) - uniform.begin();
    const auto shared = static_cast<std::int32_t>((1 + at) << 3 * k);
    for_each_cube(box,
      k,
      [&](const BrickPlace& page)
      {
        std::int32_t& base = page_at(page);
        if (static_cast<std::size_t>(base) < first_mixed << 3 * k)
        {
          overlap = overlap || base != 0;
          base = shared;
          return;
        }
        BrickBox part;
        for (int axis = 0; axis < 3; ++axis)
        {
          part.first[axis] = std::max(box.first[axis], page[axis] << k);
          part.last[axis] = std::min(box.last[axis], (page[axis] << k) + mask);
        }
        for_each_cube(part,
          0,
          [&](const BrickPlace& brick)
          {
            std::int32_t& slot = slots[base + in_page(brick[0], brick[1], brick[2])];
            overlap = overlap || slot != 0;
            slot = box.slot;
          });
      });
  }
  std::atomic<bool> brick_in_box{ false };
  tbb::parallel_for(std::size_t(0),
    places.size(),
    [&](std::size_t i)
    {
      const BrickPlace& p = places[i];
      const std::int32_t base = page_at({ { p[0] >> k, p[1] >> k, p[2] >> k } });
      std::int32_t& slot = slots[base + in_page(p[0], p[1], p[2])];
      if (slot != 0)
      {
        brick_in_box = true;
      }
      slot = first_slot + static_cast<std::int32_t>(i);
    });
  if (overlap || brick_in_box)
  {
    throw std::invalid_argument("tiles of the sparse grid overlap each other or its bricks");
  }
}

std::int32_t SparseTable::slot(std::int32_t x, std::int32_t y, std::int32_t z) const
{
  const int k = page_shift;
  const int d = directory_shift;
  const std::size_t at =
    (static_cast<std::size_t>(z >> (k + d)) * top[1] + (y >> (k + d))) * top[0] + (x >> (k + d));
  std::size_t page = at;
  if (d > 0)
  {
    const std::int32_t n = (1 << d) - 1;
    page = static_cast<std::size_t>(directory[at]) +
           (((z >> k & n) << d | (y >> k & n)) << d | (x >> k & n));
  }
  const std::int32_t m = (1 << k) - 1;
  return slots[pages[page] + (((z & m) << k | (y & m)) << k | (x & m))];
}

}
