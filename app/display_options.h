// How linear light is shown in pictures of 8 bits.
#pragma once

#include "film_io.h"

#include <string>

namespace CLI
{
class App;
}

namespace brume::app
{

struct DisplayOptions
{
  double exposure = 0.0;      ///< stops
  std::string curve = "none"; ///< or srgb

  Display display() const
  {
    return { this->exposure, this->curve == "srgb" ? Display::Curve::SRGB : Display::Curve::None };
  }
  /// Whether a picture shows anything but the numbers as they are.
  bool changes_light() const { return this->exposure != 0.0 || this->curve != "none"; }
};

/// Declares --exposure and --display-curve on a subcommand; `options` must outlive the parse.
void add_display_options(CLI::App& command, DisplayOptions& options);

}
