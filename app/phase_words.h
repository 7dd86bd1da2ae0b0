// Phase functions and point lights as the command line writes them.
#pragma once

#include "medium_options.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace brume::app
{

/// The lobes of a text such as "hg:0.8:0.7,rayleigh:0.3": FUNCTION[:G][:WEIGHT] each, G for hg and
/// schlick, where it must stand, between -1 and 1; WEIGHT above 0, 1 where it is left out. Empty
/// where the text is something else: `wrong` then says what.
std::vector<LobeChoice> read_lobes(const std::string& text, std::string& wrong);

/// Each value must be lobes.
CLI::Validator phase_words();

/// Of a point light with six numbers the last three must be 0 or more.
CLI::Validator irradiance_of_point();

}
