#include "Transport/black_body.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

using namespace brume;

namespace
{

double luminance(const glm::dvec3& rgb)
{
  return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z; // IEC 61966-2-1
}

}

// The SI's candela was once defined by it: at the freezing point of platinum, 2041.4 K, a black
// body has 60 cd/cm² (resolution 3 of the 9th CGPM, 1948). The fits of the matching functions are
// within about 1 %.
TEST(BlackBody, PlatinumFreezesAt60CandelaOverASquareCentimetre)
{
  EXPECT_NEAR(683.0 * black_body_xyz(2041.4).y / 6e5, 1.0, 0.015);
}

// CIE standard illuminant A, 2855.5 K (CIE 15): x = 0.44757, y = 0.40745; and the Planckian locus
// at 6500 K: 0.3135, 0.3237 (G. Wyszecki, W. S. Stiles, Color Science, 1982).
TEST(BlackBody, ChromaticitiesAreThePublishedOnes)
{
  const auto expect = [](double temperature, double x, double y, double off = 0.003)
  {
    const glm::dvec3 xyz = black_body_xyz(temperature);
    const double sum = xyz.x + xyz.y + xyz.z;
    EXPECT_NEAR(xyz.x / sum, x, off) << temperature;
    EXPECT_NEAR(xyz.y / sum, y, off) << temperature;
  };
  expect(2855.5, 0.44757, 0.40745);
  expect(6500.0, 0.3135, 0.3237);
  expect(2000.0, 0.5267, 0.4133);
  expect(1000.0, 0.6528, 0.3444, 0.012); // the fits end before the far red
}

// The sum over nanometres against an adaptive quadrature of the same integrand, written anew.
TEST(BlackBody, LuminanceIsTheIntegral)
{
  const auto integrand = [](double nm, double kelvin)
  {
    const auto lobe = [nm](double middle, double below, double above)
    { return std::exp(-0.5 * std::pow((nm - middle) / (nm < middle ? below : above), 2)); };
    const double y = 0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1);
    const double metres = nm * 1e-9;
    return y * 1.191042972e-16 / std::pow(metres, 5) /
           std::expm1(0.01438776877 / (metres * kelvin)) * 1e-9;
  };
  for (double kelvin : { 800.0, 1500.0, 6500.0, 1e5 })
  {
    double truth = 0.0;
    const double ends[] = { 360.0, 530.9, 568.8, 830.0 };
    for (int i = 0; i < 3; ++i)
    {
      truth += boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
        [&](double nm) { return integrand(nm, kelvin); }, ends[i], ends[i + 1], 10, 1e-12);
    }
    EXPECT_NEAR(black_body_xyz(kelvin).y / truth, 1.0, 1e-6) << kelvin;
  }
}

TEST(BlackBody, RadianceIsInUnitsOfTheReference)
{
  for (double reference : { 800.0, 1500.0, 1900.0, 6500.0, 1e5 })
  {
    const double of_itself = luminance(black_body_radiance(reference, reference));
    EXPECT_GE(of_itself, 1.0 - 1e-3) << reference;
    EXPECT_LE(of_itself, 1.05) << reference;
  }
  const glm::dvec3 white = black_body_radiance(6500.0, 6500.0);
  EXPECT_NEAR(white.x, 1.0, 0.05);
  EXPECT_NEAR(white.y, 1.0, 0.05);
  EXPECT_NEAR(white.z, 1.0, 0.05);
  // A candle is orange, a star blue.
  const glm::dvec3 candle = black_body_radiance(1900.0, 1500.0);
  EXPECT_GT(candle.x, candle.y);
  EXPECT_GT(candle.y, candle.z);
  const glm::dvec3 star = black_body_radiance(2e4, 6500.0);
  EXPECT_GT(star.z, star.x);
}

TEST(BlackBody, IsFiniteNotNegativeAndGrows)
{
  glm::dvec3 last(0.0);
  for (double kelvin = 0.0; kelvin <= 1e5; kelvin = kelvin * 1.01 + 0.5)
  {
    const glm::dvec3 now = black_body_radiance(kelvin, 800.0);
    for (int c = 0; c < 3; ++c)
    {
      ASSERT_TRUE(std::isfinite(now[c])) << kelvin;
      ASSERT_GE(now[c], 0.0) << kelvin;
      ASSERT_TRUE(now[c] >= last[c] || kelvin < 800.0) << kelvin;
    }
    last = now;
  }
  EXPECT_EQ(black_body_radiance(0.0, 1500.0), glm::dvec3(0.0));
  EXPECT_EQ(black_body_radiance(-10.0, 1500.0), glm::dvec3(0.0));
  EXPECT_EQ(black_body_radiance(std::numeric_limits<double>::quiet_NaN(), 1500.0), glm::dvec3(0.0));
  EXPECT_EQ(black_body_radiance(1e9, 1500.0), black_body_radiance(1e5, 1500.0));
}

TEST(BlackBody, ReferencesThatNobodySeesAreRefused)
{
  for (double reference : { 0.0, -5.0, 799.0, 1e6, std::numeric_limits<double>::quiet_NaN() })
  {
    EXPECT_THROW(black_body_radiance(1000.0, reference), std::invalid_argument) << reference;
    EXPECT_THROW(make_black_body_table(1000.0, reference), std::invalid_argument) << reference;
  }
}

TEST(BlackBodyTable, IsAsCloseAsItSays)
{
  for (double hottest : { 900.0, 2500.0, 12000.0, 1e5 })
  {
    const BlackBodyTable table = make_black_body_table(hottest, 1500.0);
    ASSERT_EQ(table.nodes.size(), static_cast<std::size_t>(table.intervals) + 2);
    ASSERT_LT(table.intervals, BlackBodyTable::most_intervals) << "the bound does not hold there";
    double worst = 0.0;
    for (double kelvin = 0.0; kelvin <= hottest; kelvin += hottest / 7777.7)
    {
      const double position = std::min(kelvin * table.scale, double(table.intervals));
      const int index = static_cast<int>(position);
      const BlackBodyNode& a = table.nodes[index];
      const BlackBodyNode& b = table.nodes[index + 1];
      const double f = position - index;
      const glm::dvec3 got(a.red + f * (b.red - a.red),
        a.green + f * (b.green - a.green),
        a.blue + f * (b.blue - a.blue));
      const glm::dvec3 truth = black_body_radiance(kelvin, 1500.0);
      for (int c = 0; c < 3; ++c)
      {
        const double allowed = 1e-4 * truth[c] + 1e-6 * table.brightest;
        worst = std::max(worst, std::abs(got[c] - truth[c]) / allowed);
      }
    }
    // A tenth more for single precision, and since an interval's middle is not quite its worst.
    EXPECT_LE(worst, 1.1) << hottest << " K, " << table.intervals << " intervals";
    std::cout << hottest << " K: " << table.intervals << " intervals\n";
  }
}
