// The program `brume`: reads the command line, runs one subcommand, turns failures into one line
// on standard error and an exit status.
#include "command.h"

#include <CLI/CLI.hpp>

#include <exception>
#include <iostream>
#include <new>

int main(int argc, char** argv)
{
  using namespace brume::app;
  CLI::App program{ "Brume renders volumes in VTK, tells how wrong each picture is and what it "
                    "cost." };
  program.name("brume");
  program.set_version_flag("--version", "brume " BRUME_VERSION);
  program.require_subcommand(1);
  program.get_formatter()->column_width(38);
  add_compare(program);
  add_info(program);
  add_render(program);

  try
  {
    program.parse(argc, argv);
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
    const auto unknown = program.remaining();
    if (program.get_subcommands().empty() && !unknown.empty())
    {
      std::cerr << "brume: " << unknown.front() << ": no such subcommand or option";
    }
    else
    {
      std::cerr << "brume: " << error.what();
    }
    std::cerr << ": see brume --help\n";
    return BadCall;
  }
  catch (const Failure& failure)
  {
    std::cerr << "brume: " << failure.what() << '\n';
    return failure.Status;
  }
  catch (const std::bad_alloc&)
  {
    std::cerr << "brume: out of memory: close other programs or take a smaller volume\n";
    return Failed;
  }
  catch (const std::exception& error)
  {
    std::cerr << "brume: " << error.what() << '\n';
    return Failed;
  }
}
