#include "Transport/optics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace brume;

TEST(ExtinctionFromOpacity, IsMinusLogOfTransmittanceOverTheDistance)
{
  for (double distance : { 1e-3, 1.0, 1e3 })
  {
    for (double alpha = 1e-12; alpha < 1.0; alpha = alpha * 1.7 + 1e-13)
    {
      const long double truth = -std::log1p(-static_cast<long double>(alpha)) / distance;
      EXPECT_NEAR(extinction_from_opacity(alpha, distance) / truth, 1.0, 4e-16 / (1.0 - alpha))
        << alpha;
    }
  }
}

TEST(ExtinctionFromOpacity, EndsAreFinite)
{
  EXPECT_EQ(extinction_from_opacity(0.0, 2.0), 0.0);
  EXPECT_EQ(extinction_from_opacity(-0.5, 2.0), 0.0);
  EXPECT_EQ(extinction_from_opacity(std::numeric_limits<double>::quiet_NaN(), 2.0), 0.0);
  const double opaque = extinction_from_opacity(1.0, 2.0);
  EXPECT_NEAR(opaque, 36.8 / 2.0, 0.1);
  EXPECT_EQ(extinction_from_opacity(7.0, 2.0), opaque);
  EXPECT_EQ(extinction_from_opacity(std::numeric_limits<double>::infinity(), 2.0), opaque);
  EXPECT_LE(extinction_from_opacity(0.999999, 2.0), opaque);
}

TEST(OpacityFromOpticalDepth, KeepsItsDigits)
{
  for (double depth = 1e-18; depth < 100.0; depth *= 1.9)
  {
    const long double truth = -std::expm1(-static_cast<long double>(depth));
    EXPECT_NEAR(opacity_from_optical_depth(depth) / truth, 1.0, 3e-16) << depth;
    EXPECT_NEAR(transmittance_from_optical_depth(depth) /
        std::exp(-static_cast<long double>(depth)), 1.0, 3e-16) << depth;
  }
  EXPECT_EQ(opacity_from_optical_depth(0.0), 0.0);
  EXPECT_EQ(opacity_from_optical_depth(std::numeric_limits<double>::infinity()), 1.0);
}

TEST(OpacityFromOpticalDepth, UndoesExtinctionFromOpacity)
{
  for (double alpha : { 1e-9, 0.1, 0.5, 0.99 })
  {
    EXPECT_NEAR(opacity_from_optical_depth(3.0 * extinction_from_opacity(alpha, 3.0)), alpha,
      2e-16);
  }
}
