// brume generate KIND: volumes that are made on the spot, into files.
#include "command.h"
#include "generators.h"
#include "interruption.h"
#include "option_checks.h"
#include "output_check.h"
#include "progress.h"
#include "volume_output.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <set>

namespace brume::app
{

namespace
{

struct Options
{
  VolumeOutput output;
  int size = 256;
  int seed = 1;
  std::string time = "0";
  bool quiet = false;
};

/// A series may be long, but not without end.
constexpr int MostTimes = 10000;

/// The times of "T" or "a:b:n": n of them from a to b, both among them. Empty where the text is
/// neither.
std::vector<double> times_of(const std::string& text)
{
  std::string commas = text;
  std::replace(commas.begin(), commas.end(), ':', ',');
  const std::vector<double> numbers = split_numbers(commas);
  if (text.find(',') != std::string::npos || (numbers.size() != 1 && numbers.size() != 3))
  {
    return {};
  }
  if (numbers.size() == 1)
  {
    return numbers;
  }
  const double count = numbers[2];
  if (count < 1 || count > MostTimes || count != std::floor(count))
  {
    return {};
  }
  std::vector<double> times;
  for (int i = 0; i < static_cast<int>(count); ++i)
  {
    const double part = count > 1 ? i / (count - 1) : 0.0;
    times.push_back(numbers[0] * (1 - part) + numbers[1] * part);
  }
  return times;
}

CLI::Validator time_check()
{
  return CLI::Validator(
    [](std::string& text)
    {
      return times_of(text).empty() ? "'" + text + "' is not a time, nor a:b:n with n from 1 to " +
                                        std::to_string(MostTimes)
                                    : std::string();
    },
    "");
}

void run(const Generator& generator, const Options& options, const Make& make)
{
  const std::vector<double> times = times_of(options.time);
  const bool series = options.time.find(':') != std::string::npos;
  std::vector<VolumeOutput> outputs(times.size(), options.output);
  const bool numbered = series || names_a_series(options.output.path);
  for (std::size_t i = 0; numbered && i < outputs.size(); ++i)
  {
    outputs[i].path = numbered_path(options.output.path, static_cast<std::int64_t>(i));
  }
  check_volume_output(outputs.front(), "");
  const InterruptionWatch watch;
  std::set<std::string> told; // what a format cannot hold is the same for all of a series
  ProgressBar bar("making " + options.output.path, !options.quiet);
  const double count = static_cast<double>(times.size());
  for (std::size_t i = 0; i < times.size(); ++i)
  {
    const std::string& path = outputs[i].path;
    const auto overall = [&](double done) { bar.update((static_cast<double>(i) + done) / count); };
    GeneratorRequest request;
    request.size = options.size;
    request.seed = options.seed;
    request.time = times[i];
    // With a background of the user's the volume is made dense, and the writer cuts it.
    const VolumeOutput& o = options.output;
    request.sparse = holds_sparse(path) && !o.background && !(o.tolerance > 0.0);
    request.level_set = o.grid_class == "auto" || o.grid_class == "level-set";
    request.progress = [&](double done) { overall(0.9 * done); };
    std::vector<std::string> messages;
    try
    {
      Input volume = make(request);
      volume.name = generator.name;
      messages = write_volume(volume, outputs[i], [&](double done) { overall(0.9 + 0.1 * done); });
    }
    catch (const Failure&)
    {
      check_interrupted_series(path, i, times.size());
      throw;
    }
    for (const std::string& message : messages)
    {
      if (!options.quiet && told.insert(message).second)
      {
        bar.clear();
        std::cerr << "brume: " << path << ": " << message << '\n';
      }
    }
  }
  bar.clear();
  if (series && !options.quiet)
  {
    std::cerr << "brume: " << outputs.front().path << " to " << outputs.back().path << ": "
              << times.size() << " volumes, a file each: read them as "
              << read_as(options.output.path) << '\n';
  }
}

void add_kind(CLI::App& command, const Generator& generator)
{
  auto options = std::make_shared<Options>();
  options->size = generator.default_size;
  char moment[32];
  std::snprintf(moment, sizeof(moment), "%g", generator.default_time);
  options->time = moment;
  CLI::App* kind = command.add_subcommand(generator.name, generator.summary);
  kind->group("Kinds");
  if (const std::string other = short_name(generator); !other.empty())
  {
    kind->alias(other);
  }
  kind
    ->add_option("--output,-o",
      options->output.path,
      "The file; its ending chooses the format: " + volume_endings())
    ->required()
    ->type_name("FILE");
  kind
    ->add_option("--size",
      options->size,
      "Voxels along the longest side, 2 to 4096 [" + std::to_string(generator.default_size) + "]")
    ->check(number("a whole number from 2 to 4096",
      [](double v) { return v >= 2 && v <= 4096 && v == std::floor(v); }))
    ->type_name("N");
  if (generator.seeded)
  {
    kind->add_option("--seed", options->seed, "Which one of its kind, any whole number [1]")
      ->check(number("a whole number of 32 bits",
        [](double v) { return std::abs(v) <= 2147483647.0 && v == std::floor(v); }))
      ->type_name("S");
  }
  if (generator.moves == Moves::Yes)
  {
    kind
      ->add_option("--time",
        options->time,
        "The moment, in seconds [" + options->time +
          "]; or a:b:n, n moments from a to b: a series, whose files are "
          "numbered before their ending")
      ->check(time_check())
      ->type_name("T|a:b:n");
  }
  kind->add_flag("--quiet", options->quiet, "No progress bar, no notes");
  const std::size_t common = kind->get_options().size();
  const Make make = generator.declare(*kind);
  const std::size_t own = kind->get_options().size();
  for (std::size_t i = common; i < own; ++i)
  {
    kind->get_options()[i]->group("Options of this kind");
  }
  add_volume_output(*kind, options->output);
  for (std::size_t i = own; i < kind->get_options().size(); ++i)
  {
    kind->get_options()[i]->group("Options of the format");
  }
  std::string lacks;
  if (!generator.seeded || generator.moves == Moves::No)
  {
    lacks = generator.seeded ? "It does not move: it has no time.\n"
            : generator.moves == Moves::Yes
              ? "There is one of its kind: it has no seed.\n"
              : "There is one of its kind, which does not move: it has "
                "neither seed nor time.\n";
  }
  kind->footer(lacks + "Example: brume generate " + generator.name + " --size 64 --output " +
               generator.name + ".nrrd");
  kind->callback([&generator, options, make] { run(generator, *options, make); });
}

}

void add_generate(CLI::App& program)
{
  CLI::App* command =
    program.add_subcommand("generate", "Make a volume on the spot, and write it to a file");
  auto list = std::make_shared<bool>(false);
  command->add_flag(
    "--list", *list, "The kinds, one a line, and which of them take --seed and --time");
  command->require_subcommand(0, 1);
  for (const Generator& generator : generators())
  {
    add_kind(*command, generator);
  }
  command->footer("brume generate KIND --help tells its options.\n"
                  "Example: brume generate cumulus --size 128 --time 0:60:10 --output cloud.nrrd");
  command->callback(
    [command, list]
    {
      if (!command->get_subcommands().empty())
      {
        return; // the kind's own callback has done it
      }
      if (!*list)
      {
        throw Failure("generate", "it names no kind", "see brume generate --list", BadCall);
      }
      std::size_t width = 0;
      for (const Generator& generator : generators())
      {
        width = std::max(width, generator.name.size());
      }
      for (const Generator& generator : generators())
      {
        std::cout << generator.name << std::string(width + 2 - generator.name.size(), ' ')
                  << generator.summary;
        const std::string other = short_name(generator);
        std::cout << (other.empty() ? "" : " (also: " + other + ")")
                  << (generator.seeded ? " [--seed]" : "")
                  << (generator.moves == Moves::Yes ? " [--time]" : "") << '\n';
      }
    });
}

}
