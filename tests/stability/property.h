// Properties over random arguments, with RapidCheck, the same in each run.
#pragma once

#include <rapidcheck.h>

#include <cstdint>
#include <gtest/gtest.h>
#include <sstream>
#include <string>
#include <utility>

namespace brume_tests
{

/// How many random arguments a property is tried with: BRUME_PROPERTY_TRIALS where that is set,
/// else `few`. Throws std::invalid_argument if it is set and is not a number from 1 on.
int property_trials(int few);

/// The seed of every property: BRUME_PROPERTY_SEED, else one that never changes, so that a run can
/// be repeated.
std::uint64_t property_seed();

/// Tries `property`, a function of arguments that RapidCheck can make, or one that draws them with
/// *rc::gen::…, as often as property_trials(few) says. Where it does not hold (RC_ASSERT), the test
/// fails and tells the smallest arguments found, and the seed. Returns how often it held.
///
/// RapidCheck begins with small numbers: rc::gen::inRange is the whole range for one trial in a
/// hundred. With `whole_ranges` it is for all.
template <class Property>
int expect_property(const std::string& name,
  int few,
  Property&& property,
  bool whole_ranges = false)
{
  rc::detail::TestParams parameters;
  parameters.seed = property_seed();
  parameters.maxSuccess = property_trials(few);
  rc::detail::TestMetadata what;
  what.id = what.description = name;
  auto tried = rc::detail::toProperty(std::forward<Property>(property));
  if (whole_ranges)
  {
    tried = rc::gen::resize(rc::kNominalSize, std::move(tried));
  }
  const auto result = rc::detail::checkProperty(tried, what, parameters);
  if (result.template is<rc::detail::SuccessResult>())
  {
    return result.template get<rc::detail::SuccessResult>().numSuccess;
  }
  std::ostringstream words;
  rc::detail::printResultMessage(result, words);
  ADD_FAILURE() << name << ", BRUME_PROPERTY_SEED=" << parameters.seed << ":\n" << words.str();
  return 0;
}

}
