#include "call_error.h"

#include "option_checks.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <vector>

namespace brume::app
{

namespace
{

/// Not endless: what the user wrote may hold anything.
std::string shortened(std::string text)
{
  if (text.size() > 300)
  {
    text = text.substr(0, 300) + "…";
  }
  return text;
}

/// The innermost subcommand that was called, or the program itself.
const CLI::App& called(const CLI::App& program)
{
  const std::vector<CLI::App*> subcommands = program.get_subcommands();
  return subcommands.empty() ? program : called(*subcommands.front());
}

/// "brume generate cumulus"
std::string call_of(const CLI::App& app)
{
  return app.get_parent() ? call_of(*app.get_parent()) + " " + app.get_name() : "brume";
}

/// The words that a parse left over, of the program and of the subcommands that were called.
std::vector<std::string> left_over(const CLI::App& app)
{
  const std::vector<CLI::App*> subcommands = app.get_subcommands();
  std::vector<std::string> rest =
    subcommands.empty() ? std::vector<std::string>() : left_over(*subcommands.front());
  const std::vector<std::string> own = app.remaining();
  rest.insert(rest.end(), own.begin(), own.end());
  return rest;
}

/// Whether a word that is no option should have been a subcommand.
bool wants_subcommand(const CLI::App& app)
{
  return !app.get_subcommands({}).empty();
}

/// The first argument that belongs to nothing, an option before anything else. Empty when there is
/// none. A parse that fails may leave words in the program or in its subcommand.
std::string unknown_argument(const CLI::App& program)
{
  const std::vector<std::string> rest = left_over(program);
  if (wants_subcommand(called(program)) && !rest.empty() && rest.front()[0] != '-')
  {
    return rest.front(); // what should have been a subcommand; the rest would belong to it
  }
  const auto option = std::find_if(rest.begin(), rest.end(),
    [](const std::string& word) { return word.size() > 1 && word[0] == '-' && word != "--"; });
  if (option != rest.end())
  {
    return *option;
  }
  return rest.empty() ? "" : rest.front();
}

std::string unknown(const CLI::App& program, const std::string& word)
{
  const bool option = word[0] == '-';
  std::vector<std::string> names;
  if (!option && wants_subcommand(called(program)))
  {
    const auto subcommands = called(program).get_subcommands({});
    for (const CLI::App* known : subcommands)
    {
      names.push_back(known->get_name());
    }
    const std::string nearest = nearest_name(word, names);
    return word + ": there is no such " +
      (subcommands.front()->get_group() == "Kinds" ? "kind" : "subcommand") +
      (nearest.empty() ? "" : ", perhaps " + nearest);
  }
  if (!option)
  {
    return word + ": one argument too many";
  }
  for (const CLI::Option* known : called(program).get_options())
  {
    for (const std::string& name : known->get_lnames())
    {
      names.push_back("--" + name);
    }
  }
  const std::string nearest = nearest_name(word.substr(0, word.find('=')), names);
  return word + ": there is no such option" + (nearest.empty() ? "" : ", perhaps " + nearest);
}

/// What stands before ": " in a message of CLI11, an option's name in most.
std::string option_name(const std::string& message)
{
  return message.substr(0, std::min(message.find_first_of(": "), message.size()));
}

/// The option's values as --help shows them, such as "W,H"; empty when the option is not known.
std::string values_of(const CLI::App& app, const std::string& name)
{
  const CLI::Option* option = app.get_option_no_throw(name);
  return option ? option->get_type_name() : "";
}

std::string mismatch(const CLI::App& app, const std::string& message)
{
  const std::string name = option_name(message);
  const CLI::Option* option = app.get_option_no_throw(name);
  if (!option)
  {
    return message;
  }
  const std::string values = values_of(app, name);
  if (option->get_items_expected_max() <= 1)
  {
    return name + (option->count() > 1 ? ": it is given more than once"
                                       : ": its value is missing: give it as " + name + " " + values);
  }
  return name + ": it takes " + values + ", separated by commas, and once";
}

std::string what_is_wrong(const CLI::App& program, const CLI::ParseError& error)
{
  const CLI::App& app = called(program);
  const std::string message = error.what();
  const std::string word = unknown_argument(program);
  if (dynamic_cast<const CLI::RequiredError*>(&error))
  {
    // A misspelt option is a better explanation of a missing one.
    if (!word.empty())
    {
      return unknown(program, word);
    }
    return &app == &program ? "SUBCOMMAND: it is missing"
                            : option_name(message) + ": it is missing";
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) && !word.empty())
  {
    return unknown(program, word);
  }
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error))
  {
    return mismatch(app, message);
  }
  if (dynamic_cast<const CLI::ExcludesError*>(&error))
  {
    return option_name(message) + ": it excludes " + message.substr(message.rfind(' ') + 1);
  }
  if (dynamic_cast<const CLI::ConversionError*>(&error))
  {
    // "Could not convert: NAME = VALUE"
    const std::string key = "Could not convert: ";
    if (message.compare(0, key.size(), key) == 0)
    {
      const std::string rest = message.substr(key.size());
      const std::size_t equal = rest.find(" = ");
      return rest.substr(0, equal) + ": '" +
        (equal == std::string::npos ? "" : rest.substr(equal + 3)) + "' is not what it takes";
    }
  }
  return message;
}

}

std::string describe_call_error(const CLI::App& program, const CLI::ParseError& error)
{
  return shortened(what_is_wrong(program, error)) + ": see " + call_of(called(program)) + " --help";
}

}
