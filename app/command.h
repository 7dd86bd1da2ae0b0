// What the subcommands of the program share: how each is declared, and how one fails.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace CLI
{
class App;
}

namespace brume::app
{

/// The program's exit statuses.
enum ExitStatus
{
  Success = 0,
  Failed = 1,  ///< the call was right, but the work could not be done
  BadCall = 2, ///< the command line asks for something that does not exist
};

/// A failure with its place. main() prints it on standard error as one line,
///     brume: PLACE: what is wrong: what to do
/// and exits with its status. `place` is a file, an option or a subcommand, as the user wrote it.
class Failure : public std::runtime_error
{
public:
  Failure(const std::string& place, const std::string& wrong, const std::string& remedy,
    ExitStatus status = Failed)
    : std::runtime_error(place + ": " + wrong + ": " + remedy)
    , Status(status)
  {
  }
  /// A message that is already "PLACE: what is wrong: what to do".
  explicit Failure(const std::string& message, ExitStatus status = Failed)
    : std::runtime_error(message)
    , Status(status)
  {
  }
  ExitStatus Status;
  std::vector<std::string> Choices; ///< printed below the message, one line each: what to choose from
};

// Each subcommand declares its options on the program and the callback that runs it; one file each.
// A callback returns when it is done and throws Failure when it cannot do its work.
void add_compare(CLI::App& program);
void add_convert(CLI::App& program);
void add_cost(CLI::App& program);
void add_generate(CLI::App& program);
void add_info(CLI::App& program);
void add_plan(CLI::App& program);
void add_render(CLI::App& program);
void add_view(CLI::App& program);

}
