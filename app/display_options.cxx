#include "display_options.h"

#include "option_checks.h"

#include <CLI/CLI.hpp>

#include <cmath>

namespace brume::app
{

void add_display_options(CLI::App& command, DisplayOptions& options)
{
  command
    .add_option("--exposure", options.exposure,
      "Brightens a .png: its values are multiplied by 2^STOPS, -64 to 64 [0]")
    ->check(number("a number of stops from -64 to 64", [](double v) { return std::abs(v) <= 64.0; }))
    ->type_name("STOPS");
  command
    .add_option("--display-curve", options.curve,
      "How a .png shows linear light: none (as VTK's frames do) or srgb (as eyes see it) [none]")
    ->check(one_of({ "none", "srgb" }))
    ->type_name("CURVE");
}

}
