// The program `brume`: reads the command line, runs one subcommand, turns failures into one line
// on standard error and an exit status.
#include "call_error.h"
#include "command.h"
#include "help_text.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <string>

namespace
{

/// One line on standard error: names of files may hold anything, line ends and escapes too.
void tell(std::string message, const char* before = "brume: ")
{
  std::replace_if(
    message.begin(), message.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  std::cerr << before << message << '\n';
}

}

int main(int argc, char** argv)
{
  using namespace brume::app;
  CLI::App program{ "Brume renders volumes in VTK, tells how wrong each picture is and what it "
                    "cost." };
  program.name("brume");
  program.set_version_flag("--version", "brume " BRUME_VERSION);
  program.require_subcommand(1);
  program.formatter(std::make_shared<HelpText>()); // before the subcommands, which inherit it
  program.footer("brume SUBCOMMAND --help tells its options.");
  add_compare(program);
  add_convert(program);
  add_cost(program);
  add_generate(program);
  add_info(program);
  add_plan(program);
  add_render(program);
  add_view(program);

  try
  {
    program.parse(argc, argv);
    if (!std::cout.flush())
    {
      throw Failure("standard output", "it cannot be written", "free some space, or write elsewhere");
    }
    return Success;
  }
  catch (const CLI::CallForHelp& help)
  {
    return program.exit(help);
  }
  catch (const CLI::Success& version)
  {
    return program.exit(version);
  }
  catch (const CLI::ParseError& error)
  {
    tell(describe_call_error(program, error));
    return BadCall;
  }
  catch (const Failure& failure)
  {
    tell(failure.what());
    for (const std::string& choice : failure.Choices)
    {
      tell(choice, "  ");
    }
    return failure.Status;
  }
  catch (const std::bad_alloc&)
  {
    tell("memory: there is not enough: close other programs or take a smaller volume");
    return Failed;
  }
  catch (const std::exception& error)
  {
    tell(error.what());
    return Failed;
  }
}
