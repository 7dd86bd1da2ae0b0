// How much memory a volume may take. Private to this module.
#pragma once

#include "vtkBrumeIOModule.h" // the export macro alone

#include <cstdint>
#include <string>

namespace brume::io
{

/// The limit in bytes that `chosen` stands for: itself, or for 0 three quarters of the machine's memory.
std::uint64_t memory_limit(std::uint64_t chosen);

/// Throws fail() when `bytes` are more than memory_limit(limit): what a volume larger than that takes
/// would be granted page by page, and then end the program with no word.
VTKBRUMEIO_EXPORT void check_memory(const std::string& path, double bytes, std::uint64_t limit);

}
