// Whether a field gives the same bits on every SIMD target of this machine.
#pragma once

#include "data-generators/field.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstring>
#include <vector>

namespace brume_tests
{

/// The values of a block on each target that Highway has here, against value(), place by place.
inline void expect_bits_of_one_lane(const brume::Field& field,
  const brume::PlaceBlock& places,
  double time)
{
  std::vector<float> one(places.size());
  field.brume::Field::values(places, time, one.data());
  int targets = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
  {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    std::vector<float> many(places.size());
    field.values(places, time, many.data());
    EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(float)), 0)
      << hwy::TargetName(target);
    ++targets;
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  EXPECT_GT(targets, 0);
}

}
