// What is told of a command line that cannot be understood.
#pragma once

#include <string>

namespace CLI
{
class App;
class ParseError;
}

namespace brume::app
{

/// "PLACE: what is wrong: what to do", one line, in the program's own words. PLACE is the option or
/// the argument, as the user wrote it; the hint names the subcommand that was called.
std::string describe_call_error(const CLI::App& program, const CLI::ParseError& error);

}
