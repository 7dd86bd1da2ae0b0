#include "property.h"

#include <cstdlib>
#include <stdexcept>

namespace brume_tests
{

namespace
{

std::uint64_t number_from(const char* variable, std::uint64_t otherwise)
{
  const char* text = std::getenv(variable);
  if (!text || !*text)
  {
    return otherwise;
  }
  char* end = nullptr;
  const std::uint64_t number = std::strtoull(text, &end, 10);
  if (*end != '\0' || *text == '-')
  {
    throw std::invalid_argument(std::string(variable) + ": \"" + text + "\" is not a number");
  }
  return number;
}

}

int property_trials(int few)
{
  const std::uint64_t trials =
    number_from("BRUME_PROPERTY_TRIALS", static_cast<std::uint64_t>(few));
  if (trials < 1 || trials > 1000000000)
  {
    throw std::invalid_argument("BRUME_PROPERTY_TRIALS: must be from 1 to 1e9");
  }
  return static_cast<int>(trials);
}

std::uint64_t property_seed()
{
  const std::uint64_t seed = number_from("BRUME_PROPERTY_SEED", 20201111);
  // RapidCheck tells its own seed otherwise, which nothing is drawn from.
  setenv("RC_PARAMS", ("seed=" + std::to_string(seed)).c_str(), 0);
  return seed;
}

}
