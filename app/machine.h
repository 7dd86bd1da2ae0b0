// Where the program runs, and how it was called.
#pragma once

#include "Analysis/comparison.h"

#include <string>

namespace brume::app
{

/// This machine, its software, and what a render used of it.
Machine this_machine(int threads, const std::string& simd);

/// The command line of this process, quoted so that a shell takes it back.
std::string this_command_line();

/// The time now, such as "2024-05-01 12:00 UTC".
std::string utc_now();

}
