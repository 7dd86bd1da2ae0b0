// Phase functions: against the formulas of books, their integrals, and in single precision.
#include "phase_packets.h"

#include "Transport/marcher.h"
#include "Transport/phase.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

using namespace brume;

namespace
{

constexpr double pi = 3.14159265358979323846;
const double anisotropies[] = { -0.999, -0.9, -0.5, -1e-3, 0.0, 1e-3, 0.3, 0.76, 0.95, 0.999 };

double value(const PhaseModel& model, double cosine)
{
  return scalar::phase<double>(model, 1.0 - cosine, 1.0 + cosine);
}

/// ∫ f(µ) p dω over the sphere. µ = ±(1 − e^−u) spreads the narrow lobes at both ends.
template <class F>
double over_the_sphere(const PhaseModel& model, const F& f)
{
  double sum = 0.0;
  for (const bool forward : { true, false })
  {
    for (double u = 0.0; u < 40.0; u += 1.0)
    {
      sum += boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
        [&](double v)
        {
          const double rest = std::exp(-v); // 1 − |µ|
          const double near = rest;
          const double far = 2.0 - rest;
          const double p = scalar::phase<double>(model, forward ? near : far, forward ? far : near);
          return 2.0 * pi * p * f(forward ? 1.0 - rest : rest - 1.0) * rest;
        },
        u,
        u + 1.0,
        8,
        1e-12);
    }
  }
  return sum;
}

std::vector<PhaseLobe> one(PhaseFunction function, double g)
{
  return { { function, 1.0, g } };
}

}

TEST(Phase, IntegratesToOneWithItsMeanCosine)
{
  for (const PhaseFunction function : { PhaseFunction::HenyeyGreenstein, PhaseFunction::Schlick })
  {
    for (const double g : anisotropies)
    {
      const PhaseModel model = prepare_phase(one(function, g));
      EXPECT_NEAR(over_the_sphere(model, [](double) { return 1.0; }), 1.0, 1e-9) << g;
      EXPECT_NEAR(over_the_sphere(model, [](double mu) { return mu; }), g, 1e-9) << g;
    }
  }
  for (const PhaseFunction function : { PhaseFunction::Isotropic, PhaseFunction::Rayleigh })
  {
    const PhaseModel model = prepare_phase(one(function, 0.5)); // which they do not read
    EXPECT_NEAR(over_the_sphere(model, [](double) { return 1.0; }), 1.0, 1e-9);
    EXPECT_NEAR(over_the_sphere(model, [](double mu) { return mu; }), 0.0, 1e-9);
  }
}

TEST(Phase, IsTheFormula)
{
  for (double mu = -1.0; mu <= 1.0; mu += 0.125)
  {
    EXPECT_NEAR(value(prepare_phase({}), mu), 1.0 / (4.0 * pi), 1e-16);
    EXPECT_NEAR(value(prepare_phase(one(PhaseFunction::Rayleigh, 0.0)), mu),
      3.0 / (16.0 * pi) * (1.0 + mu * mu),
      1e-15);
    for (const double g : anisotropies)
    {
      const double hg = (1.0 - g * g) / (4.0 * pi) / std::pow(1.0 + g * g - 2.0 * g * mu, 1.5);
      EXPECT_NEAR(value(prepare_phase(one(PhaseFunction::HenyeyGreenstein, g)), mu) / hg, 1.0, 1e-7)
        << g << " " << mu; // the book's form cancels at |g| = 0.999
      const double k = std::copysign(1.0 - schlick_one_minus_k(g), g);
      const double schlick = (1.0 - k * k) / (4.0 * pi) / std::pow(1.0 - k * mu, 2.0);
      EXPECT_NEAR(value(prepare_phase(one(PhaseFunction::Schlick, g)), mu) / schlick, 1.0, 1e-7)
        << g << " " << mu;
    }
  }
}

// θ is the angle between directions of travel: g > 0 scatters forward.
TEST(Phase, ForwardIsStraightOn)
{
  for (const PhaseFunction function : { PhaseFunction::HenyeyGreenstein, PhaseFunction::Schlick })
  {
    const PhaseModel model = prepare_phase(one(function, 0.6));
    EXPECT_GT(value(model, 1.0), 4.0 * value(model, 0.0));
    EXPECT_GT(value(model, 0.0), value(model, -1.0));
    EXPECT_EQ(value(prepare_phase(one(function, -0.6)), -1.0), value(model, 1.0));
  }
}

// P. Blasi, B. Le Saëc, C. Schlick, A Rendering Algorithm for Discrete Volume Density Objects,
// Eurographics 1993, have k = 1.55 g − 0.55 g³, whose mean cosine is a little more than g.
TEST(Phase, SchlicksKIsNearThePublishedOne)
{
  for (double g = 0.05; g < 1.0; g += 0.05)
  {
    EXPECT_NEAR(1.0 - schlick_one_minus_k(g), 1.55 * g - 0.55 * g * g * g, 0.045) << g;
  }
}

TEST(Phase, LobesAreWeighted)
{
  const std::vector<PhaseLobe> lobes = { { PhaseFunction::HenyeyGreenstein, 3.0, 0.8 },
    { PhaseFunction::Rayleigh, 1.0, 0.0 },
    { PhaseFunction::Isotropic, 0.5, 0.9 },
    { PhaseFunction::Schlick, 0.5, -0.4 },
    { PhaseFunction::HenyeyGreenstein, 0.0, 0.1 } };
  for (const double factor : { 1.0, 0.5, 0.0 })
  {
    const PhaseModel model = prepare_phase(lobes, factor);
    EXPECT_NEAR(over_the_sphere(model, [](double) { return 1.0; }), 1.0, 1e-9);
    EXPECT_NEAR(over_the_sphere(model, [](double mu) { return mu; }),
      factor * (3.0 * 0.8 - 0.5 * 0.4) / 5.0,
      1e-9);
    EXPECT_EQ(model.is_isotropic(), false); // Rayleigh's part stays
  }
  EXPECT_TRUE(prepare_phase(one(PhaseFunction::HenyeyGreenstein, 0.9), 0.0).is_isotropic());
  EXPECT_TRUE(prepare_phase({ { PhaseFunction::HenyeyGreenstein, 0.0, 0.9 } }).is_isotropic());
}

// Toward 0 all become the isotropic one, without a jump where that takes over.
TEST(Phase, SmallAnisotropiesAreIsotropic)
{
  for (const double g : { 2e-6, 1e-6, 5e-7, 0.0, -5e-7, -2e-6 })
  {
    for (const PhaseFunction function : { PhaseFunction::HenyeyGreenstein, PhaseFunction::Schlick })
    {
      for (const double mu : { -1.0, 0.0, 1.0 })
      {
        EXPECT_NEAR(
          value(prepare_phase(one(function, g)), mu) * 4.0 * pi, 1.0 + 3.0 * g * mu, 4e-6);
      }
    }
  }
}

TEST(Phase, OutOfRangeIsCut)
{
  for (const PhaseFunction function : { PhaseFunction::HenyeyGreenstein, PhaseFunction::Schlick })
  {
    const double most = value(prepare_phase(one(function, 0.9999)), 1.0);
    EXPECT_TRUE(std::isfinite(most));
    for (const double g : { 1.0, 7.0, std::numeric_limits<double>::infinity() })
    {
      EXPECT_EQ(value(prepare_phase(one(function, g)), 1.0), most);
      EXPECT_EQ(value(prepare_phase(one(function, -g)), -1.0), most);
    }
    EXPECT_EQ(value(prepare_phase(one(function, std::numeric_limits<double>::quiet_NaN())), 1.0),
      1.0 / (4.0 * pi));
  }
}

TEST(Phase, SilverLiningAddsTwoLobes)
{
  const PhaseModel plain = prepare_phase(one(PhaseFunction::Rayleigh, 0.0));
  PhaseModel lined = plain;
  add_silver_lining({ true, 0.6, 0.2, 0.25 }, lined);
  const PhaseModel forward = prepare_phase(one(PhaseFunction::HenyeyGreenstein, 0.8));
  const PhaseModel back = prepare_phase(one(PhaseFunction::HenyeyGreenstein, -0.8));
  for (double mu = -1.0; mu <= 1.0; mu += 0.25)
  {
    const double more = 0.6 * (0.75 * value(forward, mu) + 0.25 * value(back, mu));
    EXPECT_NEAR(value(lined, mu), value(plain, mu) + more, 1e-13 * more) << mu;
  }
  // All round, where the lobe is as wide as the sphere.
  lined = plain;
  add_silver_lining({ true, 0.6, 1.0, 0.25 }, lined);
  EXPECT_NEAR(value(lined, 0.3), value(plain, 0.3) + 0.6 / (4.0 * pi), 1e-15);
  // Off, or of no strength: the same to the bit.
  for (const SilverLining& lining :
    { SilverLining{ false, 0.6, 0.2, 0.25 }, SilverLining{ true, 0.0, 0.2, 0.25 } })
  {
    lined = plain;
    add_silver_lining(lining, lined);
    EXPECT_EQ(lined.isotropic, plain.isotropic);
    EXPECT_EQ(lined.terms.size(), plain.terms.size());
  }
}

TEST(Phase, LargestIsABound)
{
  const std::vector<PhaseLobe> lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.8 },
    { PhaseFunction::Rayleigh, 2.0, 0.0 },
    { PhaseFunction::Schlick, 1.0, -0.7 } };
  const PhaseModel model = prepare_phase(lobes);
  for (const double low : { -1.0, -0.4, 0.3 })
  {
    for (const double high : { 0.5, 0.9, 1.0 })
    {
      double most = 0.0;
      for (int i = 0; i <= 1000; ++i)
      {
        most = std::max(most, value(model, low + (high - low) * i / 1000.0));
      }
      EXPECT_NEAR(largest_phase(model, low, high) / most, 1.0, 1e-12) << low << " " << high;
    }
  }
}

// Every instruction set, from straight on to straight back, closer to both than a cosine in single
// precision can tell.
TEST(Phase, PacketsAgreeWithDoublePrecision)
{
  std::vector<float> minus;
  std::vector<float> plus;
  for (double rest = 2.0; rest > 1e-12; rest *= 0.8)
  {
    minus.push_back(static_cast<float>(rest));
    plus.push_back(static_cast<float>(2.0 - rest));
    minus.push_back(static_cast<float>(2.0 - rest));
    plus.push_back(static_cast<float>(rest));
  }
  minus.resize((minus.size() + 15) / 16 * 16, 1.0f);
  plus.resize(minus.size(), 1.0f);
  std::vector<float> packets(minus.size());
  std::istringstream targets(simd_targets());
  for (std::string target; targets >> target;)
  {
    ASSERT_TRUE(force_simd_target(target));
    double worst = 0.0;
    for (const PhaseFunction function : { PhaseFunction::HenyeyGreenstein,
           PhaseFunction::Schlick,
           PhaseFunction::Rayleigh,
           PhaseFunction::Isotropic })
    {
      for (const double g : anisotropies)
      {
        PhaseModel model = prepare_phase({ { function, 1.0, g }, { function, 0.5, -g } });
        add_silver_lining({ true, 1.0, 0.01, 0.5 }, model);
        packet_phase(model, minus.data(), plus.data(), minus.size(), packets.data());
        for (std::size_t i = 0; i < minus.size(); ++i)
        {
          const double truth = scalar::phase<double>(model, minus[i], plus[i]);
          const double error = std::abs(packets[i] / truth - 1.0);
          worst = error <= worst ? worst : error;
        }
      }
    }
    // The powers of a reciprocal square root that is right to two units in the last place.
    EXPECT_LE(worst, 2e-6) << target;
  }
  force_simd_target("");
}
