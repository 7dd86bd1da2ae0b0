#include "../support/transport_scenes.h"

#include "Transport/lookup_table.h"
#include "Transport/optics.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>

using namespace transport_scenes;

namespace
{

const auto white = [](double) { return glm::dvec3(1.0); };

TEST(TablePosition, ClampsAndInterpolates)
{
  const double nodes[] = { 1.0, 3.0, 2.0 };
  const auto at = [&](double v) { return interpolate(nodes, table_position(v, 10.0, 20.0, 3)); };
  EXPECT_DOUBLE_EQ(at(10.0), 1.0);
  EXPECT_DOUBLE_EQ(at(12.5), 2.0);
  EXPECT_DOUBLE_EQ(at(15.0), 3.0);
  EXPECT_DOUBLE_EQ(at(20.0), 2.0);
  EXPECT_DOUBLE_EQ(at(-1e300), 1.0);
  EXPECT_DOUBLE_EQ(at(1e300), 2.0);
  EXPECT_DOUBLE_EQ(at(std::numeric_limits<double>::quiet_NaN()), 1.0);
}

TEST(LookupTable, HoldsExtinctionAndColour)
{
  Classification c = classify(
    -100.0, 300.0, [](double v) { return v > 0 ? 0.002 * v : 0.0; },
    [](double v) { return glm::dvec3(0.5, (v + 100) / 400, 0.0); });
  c.unit_distance = 0.25;
  const LookupTable table = make_lookup_table(c);
  for (std::size_t i = 0; i < table.nodes.size(); ++i)
  {
    const double v = -100.0 + 400.0 * i / (table.nodes.size() - 1);
    const double depth = v > 0 ? -std::log1p(-0.002 * v) / 0.25 : 0.0;
    EXPECT_NEAR(table.nodes[i].extinction, depth, 1e-5 * depth + 1e-9);
    EXPECT_NEAR(table.nodes[i].green, (v + 100) / 400, 1e-6);
  }
  EXPECT_FLOAT_EQ(table.brightest, 1.0f);
  EXPECT_FLOAT_EQ(table.empty_value, -100.0f);
  EXPECT_TRUE(table.gradient_factor.empty());
}

TEST(LookupTable, EmptyValueHasNoOpticalDepthWhereOneHasNone)
{
  Classification c =
    classify(0.0, 1.0, [](double v) { return v < 0.5 ? 0.5 : 0.0; }, white);
  const LookupTable table = make_lookup_table(c);
  EXPECT_FALSE(table.can_show(table.empty_value, table.empty_value));
  c = classify(2.0, 3.0, [](double) { return 0.5; }, white);
  EXPECT_FLOAT_EQ(make_lookup_table(c).empty_value, 2.0f); // nothing is empty here
}

// No value that the kernel would draw may be in a range that cannot show.
TEST(LookupTable, CanShowIsRightForEveryRange)
{
  std::mt19937 random(5);
  const auto uniform = [&](double a, double b)
  { return a + (b - a) * (random() / double(random.max())); };
  for (int round = 0; round < 30; ++round)
  {
    const double from = uniform(0.0, 100.0);
    const double to = from + uniform(0.01, 20.0);
    const Classification c = classify(
      0.0, 100.0, [&](double v) { return v > from && v < to ? 0.3 : 0.0; }, white, 2001);
    const LookupTable table = make_lookup_table(c);
    const auto depth = [&](double v)
    {
      const TablePosition at = table_position(v, 0.0, 100.0, table.nodes.size());
      return table.nodes[at.index].extinction * (1.0 - at.fraction) +
             table.nodes[at.index + 1].extinction * at.fraction;
    };
    for (int i = 0; i < 300; ++i)
    {
      const float a = static_cast<float>(uniform(-10.0, 110.0));
      const float b = a + static_cast<float>(uniform(0.0, i % 2 ? 0.1 : 30.0));
      bool shows = false;
      for (int s = 0; s <= 400; ++s)
      {
        shows = shows || depth(a + (b - a) * s / 400.0) > 0.0;
      }
      if (shows)
      {
        ASSERT_TRUE(table.can_show(a, b)) << a << " " << b << " in " << from << " " << to;
      }
      // And it is no more cautious than one interval of the table to each side.
      const double interval = 100.0 / table.intervals;
      bool near = false;
      for (int s = 0; s <= 4000; ++s)
      {
        near = near || depth(a - 1.01 * interval + (b - a + 2.02 * interval) * s / 4000.0) > 0.0;
      }
      if (!near)
      {
        ASSERT_FALSE(table.can_show(a, b)) << a << " " << b << " in " << from << " " << to;
      }
    }
  }
}

TEST(LookupTable, GradientFactorIsClampedToZeroToOne)
{
  Classification c = classify(0.0, 1.0, [](double v) { return v; }, white, 3);
  c.gradient_opacity = { -1.0, 2.0 };
  c.gradient_upper = 8.0;
  const LookupTable table = make_lookup_table(c);
  ASSERT_EQ(table.gradient_factor.size(), table.nodes.size());
  EXPECT_EQ(table.gradient_factor.front(), 0.0f);
  EXPECT_EQ(table.gradient_factor.back(), 1.0f);
  EXPECT_NEAR(table.gradient_factor[table.nodes.size() / 2], 0.5f, 1e-3);
}

// A peak far narrower than a thousandth of the range must not fall between the table's nodes: 16-bit
// scans use theirs to the last value.
TEST(LookupTable, KeepsAPeakOfSixteenBitData)
{
  const Classification c = classify(
    0.0, 65535.0, [](double v) { return std::max(0.0, 0.5 - std::abs(v - 30007.0) * 0.125); }, white,
    65537);
  const LookupTable table = make_lookup_table(c);
  EXPECT_TRUE(table.can_show(30007.0f, 30007.0f));
  const TablePosition at = table_position(30007.0, 0.0, 65535.0, table.nodes.size());
  const double depth = table.nodes[at.index].extinction * (1.0 - at.fraction) +
                       table.nodes[at.index + 1].extinction * at.fraction;
  EXPECT_NEAR(depth, std::log(2.0), 0.15); // the peak may fall between two nodes by half a value
}

TEST(LookupTable, RefusesWhatIsNoFunction)
{
  const Classification good = classify(0.0, 1.0, [](double v) { return v; }, white, 3);
  const auto refuses = [&](const auto& change)
  {
    Classification c = good;
    change(c);
    EXPECT_THROW(make_lookup_table(c), std::invalid_argument);
  };
  refuses([](Classification& c) { c.opacity.resize(1); });
  refuses([](Classification& c) { c.rgb.resize(6); });
  refuses([](Classification& c) { c.upper = c.lower; });
  refuses([](Classification& c) { c.upper = std::numeric_limits<double>::quiet_NaN(); });
  refuses([](Classification& c) { c.unit_distance = 0.0; });
  refuses([](Classification& c) { c.unit_distance = std::numeric_limits<double>::quiet_NaN(); });
  refuses([](Classification& c) { c.gradient_opacity = { 1.0 }; });
  refuses([](Classification& c) { c.gradient_opacity = { 1.0, 1.0 }; c.gradient_upper = 0.0; });
}

}
