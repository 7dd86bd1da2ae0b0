// How --help looks.
#pragma once

#include <CLI/CLI.hpp>

namespace brume::app
{

/// Help in 80 columns: names on the left, what they mean wrapped on the right, required options
/// marked, and none of the notes on validators that CLI11 adds.
class HelpText : public CLI::Formatter
{
public:
  std::string make_description(const CLI::App* app) const override;
  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_group(
    std::string group, bool is_positional, std::vector<const CLI::Option*> options) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* subcommand) const override;
};

}
