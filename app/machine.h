// Where the program runs, and how it was called.
#pragma once

#include "Analysis/comparison.h"

#include <cstdint>
#include <string>

namespace brume::app
{

/// This machine, its software, and what a render used of it.
Machine this_machine(int threads, const std::string& simd);

/// The most memory that the process has held so far.
std::int64_t peak_memory_bytes();

/// The word, quoted where a shell would take it apart.
std::string shell_word(const std::string& word);

/// The command line of this process, quoted so that a shell takes it back.
std::string this_command_line();

/// The time now, such as "2024-05-01 12:00 UTC".
std::string utc_now();

}
