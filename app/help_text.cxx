#include "help_text.h"

#include <sstream>

namespace brume::app
{

namespace
{

constexpr std::size_t Columns = 80;
constexpr std::size_t Indent = 30; ///< where the right column begins

/// The text in lines of at most `width` columns; a longer word has a line of its own. Counts bytes
/// that begin a UTF-8 character.
std::vector<std::string> wrapped(const std::string& text, std::size_t width)
{
  const auto columns = [](const std::string& s)
  {
    std::size_t n = 0;
    for (unsigned char c : s)
    {
      n += (c & 0xc0) != 0x80;
    }
    return n;
  };
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;)
  {
    if (!lines.back().empty() && columns(lines.back()) + 1 + columns(word) > width)
    {
      lines.emplace_back();
    }
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

std::string entry(const std::string& name, const std::string& text)
{
  std::string left = "  " + name;
  std::string out;
  if (left.size() + 2 > Indent)
  {
    out = left + '\n';
    left.clear();
  }
  for (const std::string& line : wrapped(text, Columns - Indent))
  {
    left.resize(Indent, ' ');
    out += left + line + '\n';
    left.clear();
  }
  return out;
}

std::string names(const CLI::Option* option)
{
  std::string text;
  for (const std::string& name : option->get_snames())
  {
    text += (text.empty() ? "-" : ", -") + name;
  }
  for (const std::string& name : option->get_lnames())
  {
    text += (text.empty() ? "--" : ", --") + name;
  }
  return text;
}

}

std::string HelpText::make_description(const CLI::App* app) const
{
  std::string out;
  for (const std::string& line : wrapped(app->get_description(), Columns))
  {
    out += line + '\n';
  }
  return out;
}

/// What must be given stands in the line; the rest is [OPTIONS].
std::string HelpText::make_usage(const CLI::App* app, std::string name) const
{
  std::string out = "Usage: " + (name.empty() ? app->get_name() : name);
  for (const CLI::Option* option : app->get_options())
  {
    if (option->get_positional())
    {
      out += ' ' + make_option_name(option, true);
    }
  }
  for (const CLI::Option* option : app->get_options())
  {
    if (!option->get_positional() && option->get_required())
    {
      out += " --" + option->get_lnames().front() + ' ' + option->get_type_name();
    }
  }
  const std::vector<const CLI::App*> subcommands = app->get_subcommands({});
  if (!subcommands.empty())
  {
    out += subcommands.front()->get_group() == "Kinds" ? " KIND" : " SUBCOMMAND";
  }
  return out + " [OPTIONS]\n";
}

std::string HelpText::make_group(
  std::string group, bool is_positional, std::vector<const CLI::Option*> options) const
{
  // CLI11 puts an empty line before each group but the positionals'.
  std::string out = is_positional ? "\nInput:\n" : group + ":\n";
  for (const CLI::Option* option : options)
  {
    out += make_option(option, is_positional);
  }
  return out;
}

std::string HelpText::make_option(const CLI::Option* option, bool is_positional) const
{
  std::string name = is_positional ? make_option_name(option, true) : names(option);
  if (!is_positional && option->get_type_size() != 0 && !option->get_type_name().empty())
  {
    name += ' ' + option->get_type_name();
  }
  std::string text = make_option_desc(option);
  if (!is_positional && option->get_required())
  {
    text += " (required)";
  }
  return entry(name, text);
}

std::string HelpText::make_subcommand(const CLI::App* subcommand) const
{
  return entry(subcommand->get_name(), subcommand->get_description());
}

}
