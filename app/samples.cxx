// What `sample:NAME` makes: each kind of `brume generate` with its options at their defaults.
#include "generators.h"

#include <CLI/CLI.hpp>

namespace brume::app
{

namespace
{

/// A shorter or older name of a kind.
struct Alias
{
  const char* name;
  const char* kind;
};
constexpr Alias Aliases[] = { { "cloud", "cumulus" }, { "fog", "valley-fog" } };

Sample sample_of(const Generator& generator, const std::string& name)
{
  return { name,
    generator.summary,
    [&generator](const std::function<void(double)>& progress)
    {
      CLI::App options; // whose defaults are the kind's
      const Make make = generator.declare(options);
      GeneratorRequest request;
      request.size = generator.default_size;
      request.time = generator.default_time;
      request.progress = progress;
      return make(request);
    } };
}

}

const std::vector<Sample>& samples()
{
  static const std::vector<Sample> table = []
  {
    std::vector<Sample> list;
    for (const Generator& generator : generators())
    {
      list.push_back(sample_of(generator, generator.name));
      for (const Alias& alias : Aliases)
      {
        if (generator.name == alias.kind)
        {
          list.push_back(sample_of(generator, alias.name));
        }
      }
    }
    return list;
  }();
  return table;
}

}
