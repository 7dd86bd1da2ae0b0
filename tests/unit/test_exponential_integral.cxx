#include "phase_packets.h"

#include "Transport/exponential_integral.h"

#include <boost/math/special_functions/expint.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

using brume::exponential_integral_2;

TEST(ExponentialIntegral, AgreesWithBoost)
{
  double worst = 0.0;
  double at = 0.0;
  const auto look = [&](double x)
  {
    const long double truth = boost::math::expint(2u, static_cast<long double>(x));
    const double error = static_cast<double>(std::abs(exponential_integral_2(x) / truth - 1.0L));
    if (!(error <= worst))
    {
      worst = error;
      at = x;
    }
  };
  for (double x = 1e-300; x < 1e-3; x *= 1.7)
  {
    look(x);
  }
  for (double x = 1e-3; x < 700.0; x *= 1.0013)
  {
    look(x);
  }
  for (double x : { std::nextafter(1.0, 0.0), 1.0, std::nextafter(1.0, 2.0), 700.0 })
  {
    look(x);
  }
  EXPECT_LE(worst, 1e-14) << "at " << at;
  RecordProperty("worst", std::to_string(worst));
}

// M. Abramowitz, I. Stegun, Handbook of Mathematical Functions, table 5.4.
TEST(ExponentialIntegral, AgreesWithPublishedValues)
{
  EXPECT_NEAR(exponential_integral_2(0.01), 0.9496705, 5e-8);
  EXPECT_NEAR(exponential_integral_2(0.1), 0.7225450, 5e-8);
  EXPECT_NEAR(exponential_integral_2(0.5), 0.3266439, 5e-8);
  EXPECT_NEAR(exponential_integral_2(1.0), 0.1484955, 5e-8);
  EXPECT_NEAR(exponential_integral_2(2.0), 0.0375343, 5e-8);
}

TEST(ExponentialIntegral, EndsAreFinite)
{
  EXPECT_EQ(exponential_integral_2(0.0), 1.0);
  EXPECT_EQ(exponential_integral_2(-3.0), 1.0);
  EXPECT_EQ(exponential_integral_2(1e6), 0.0);
  EXPECT_EQ(exponential_integral_2(std::numeric_limits<double>::infinity()), 0.0);
  EXPECT_TRUE(std::isnan(exponential_integral_2(std::numeric_limits<double>::quiet_NaN())));
}

// As the kernels have it, in packets of single precision.
TEST(ExponentialIntegral, PacketsAgree)
{
  std::vector<float> x{ 0.0f, 1e-30f, 1e-8f, 0.999999f, 1.0f, 1.000001f, 80.0f, 1e30f };
  for (float at = 1e-6f; at < 30.0f; at *= 1.01f)
  {
    x.push_back(at);
  }
  x.resize((x.size() + 15) / 16 * 16, 0.5f);
  std::vector<float> result(x.size());
  packet_second_exponential_integral(x.data(), x.size(), result.data());
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    const double truth = exponential_integral_2(x[i]);
    EXPECT_NEAR(result[i], truth, 1e-6) << "at " << x[i];
    if (x[i] >= 1.0f)
    {
      EXPECT_NEAR(result[i], truth, 3e-6 * truth + 1e-37) << "at " << x[i];
    }
  }
}
