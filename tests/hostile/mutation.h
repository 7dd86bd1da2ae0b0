// Damaged versions of small files, the same for the same seed on every machine.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace hostile
{

/// Files that belong together, by their names without a folder.
using Files = std::map<std::string, std::string>;

/// A reader's whole example: its files, and which of them (or, for ".", which folder) is named.
struct Example
{
  std::string name;
  Files files;
};

/// The example with one to four changes in one of its files: flipped bits, runs of bytes, other numbers in
/// text, other integers of 2, 4 or 8 bytes in either order, pieces cut out, doubled or taken from
/// another example, a shorter or a longer end. Two in three changes are in the first 600 bytes.
Example mutated(const Example& example, const std::vector<Example>& others, std::uint64_t seed);

}
