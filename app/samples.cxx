// What `sample:NAME` makes: each kind of `brume generate` with its options at their defaults.
#include "generators.h"

#include <CLI/CLI.hpp>

namespace brume::app
{

namespace
{

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
      const std::string other = short_name(generator);
      if (!other.empty())
      {
        list.push_back(sample_of(generator, other));
      }
    }
    return list;
  }();
  return table;
}

}
