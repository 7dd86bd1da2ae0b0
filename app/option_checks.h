// Checks of the values on the command line, each with its own words.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace brume::app
{

/// Each number must be finite and `good`; `what` completes "'X' is not …".
CLI::Validator number(const std::string& what, bool (*good)(double));

/// Each value must be one of these words.
CLI::Validator one_of(const std::vector<std::string>& words);

}
