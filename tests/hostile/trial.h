// Reads many damaged files with one reader, and watches time, memory and what is said.
#pragma once

#include "mutation.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace hostile
{

/// The most memory that a reader is given for one volume, bytes.
constexpr std::int64_t memory_limit = 32 << 20;

/// Reads a path; returns its error's one line, or nothing for success. Throws for a success that is
/// none (an image without numbers).
using Read = std::function<std::string(const std::string& path)>;

/// How many damaged files a reader gets: the environment variable BRUME_HOSTILE_FILES, else `usual`.
int files_of_each_reader(int usual);

/// Reads damaged versions of the examples, which must be whole. Fails the running test where
/// - reading takes more than 10 s of processor time, or 300 s by the clock (the process ends then, and the file is left where it was);
/// - one allocation, or what is held at once, is beyond the limit on memory and what small things take;
/// - an error is not one line "PATH: what is wrong: what to do", or says that memory has run out;
/// - anything is written to standard error.
/// A crash ends the process; the file is left in the test's folder, and its number in "number".
void try_reader(const std::vector<Example>& examples, const Read& read, int usual = 200);

}
