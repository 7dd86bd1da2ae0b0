// Checks of the values on the command line, each with its own words.
#pragma once

#include <CLI/CLI.hpp>

#include <array>
#include <initializer_list>
#include <string>
#include <vector>

namespace brume::app
{

// What an option takes is told by its checks, for scene files too: their names (Validator::get_name)
// are "number", "word:a,b,c", "numbers:1,3" (how many) and "switch:a,b,c".

/// Each number must be finite and `good`; `what` completes "'X' is not …".
CLI::Validator number(const std::string& what, bool (*good)(double));

/// Each value must be one of these words.
CLI::Validator one_of(const std::vector<std::string>& words);

/// Each value must be numbers with commas between, as many as one of `counts`, all finite and `good`;
/// `what` completes "'X' is not …".
CLI::Validator numbers(const std::string& what, std::initializer_list<int> counts, bool (*good)(double));

/// Each value must be NAME=on or NAME=off, the name one of these.
CLI::Validator switch_of(const std::vector<std::string>& names);

/// The numbers of a text with commas between; empty where it is something else, or where one is not
/// finite.
std::vector<double> split_numbers(const std::string& text);

/// One or three numbers as three.
std::array<double, 3> three_of(const std::vector<double>& numbers);

/// Of `names` the one that is written most like `name`, else the first that begins with it (three letters at
/// least); empty where none is near.
std::string nearest_name(const std::string& name, const std::vector<std::string>& names);

/// "a, b, c"
std::string listed(const std::vector<std::string>& words, const char* separator = ", ");

}
