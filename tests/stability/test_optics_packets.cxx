// Hard cases of the formulas that the kernels use, on every SIMD target, in single precision
// against double and long double.
#include "hard_case.h"
#include "optics_packets.h"
#include "property.h"

#include "Transport/exponential_integral.h"
#include "Transport/marcher.h"
#include "Transport/optics.h"
#include "Transport/phase_sampler.h"

#include "data-generators/shaping.h"

#include <boost/math/special_functions/expint.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

using namespace brume;
using namespace brume_tests;
using optics_packets::Numbers;

namespace
{

constexpr double pi = 3.14159265358979323846;
const float infinity = std::numeric_limits<float>::infinity();

/// Calls `run` with each SIMD target of this machine chosen.
void for_each_target(const std::function<void(const std::string&)>& run)
{
  std::istringstream targets(simd_targets());
  for (std::string target; targets >> target;)
  {
    ASSERT_TRUE(force_simd_target(target));
    run(target);
  }
  force_simd_target("");
}

/// How far a float is from the truth, in steps of floats as large as the truth.
double ulps(float value, long double truth)
{
  if (truth == 0.0L)
  {
    return value == 0.0f ? 0.0 : INFINITY;
  }
  const long double step = std::ldexp(1.0L, std::max(std::ilogb(truth) - 23, -149));
  return static_cast<double>(std::abs(value - truth) / step);
}

/// From 1e-30 to 1e4, evenly by their logarithm, with the places where series and closed forms
/// meet.
Numbers optical_depths()
{
  Numbers x;
  for (double depth = 1e-30; depth <= 1e4; depth *= 1.0077)
  {
    x.push_back(static_cast<float>(depth));
  }
  for (const float place : { 0.5f, 1.0f, 87.0f, 88.7f, 103.9f })
  {
    float near = place;
    for (int i = 0; i < 20; ++i)
    {
      x.push_back(near);
      near = std::nextafter(near, 0.0f);
    }
  }
  std::sort(x.begin(), x.end());
  return x;
}

/// The largest of what each place gives; NaN stays.
template <class Of>
double worst(std::size_t count, const Of& of)
{
  double most = 0.0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const double here = of(i);
    most = here <= most ? most : here;
  }
  return most;
}

/// How far a curve that should never fall does, in steps of floats as large as itself.
double largest_fall(const Numbers& y)
{
  return worst(y.size() - 1,
    [&](std::size_t i) { return std::max(0.0, y[i + 1] < y[i] ? ulps(y[i + 1], y[i]) : 0.0); });
}

}

TEST(OpticsPackets, Opacity)
{
  HardCase one("Optics",
    "opacity 1 − e^(−τ) of a segment, τ from 1e-30 to 1e4",
    "1 − e^(−τ) is 0 in single precision below τ = 6e-8; series and closed form meet at ½",
    "within 4 ulp of long double, never above 1, and nowhere falling by more than 1 ulp as τ "
    "grows");
  const Numbers depths = optical_depths();
  for_each_target(
    [&](const std::string& target)
    {
      const Numbers got = optics_packets::opacity(depths);
      one.measure(worst(got.size(),
                    [&](std::size_t i)
                    { return ulps(got[i], -std::expm1(-static_cast<long double>(depths[i]))); }),
        4.0,
        "ulp",
        target);
      one.measure(largest_fall(got), 1.0, "ulp of fall", target);
      one.holds(*std::max_element(got.begin(), got.end()) <= 1.0f, "at most 1", target);
    });
  const auto in_double = [](double x) { return opacity_from_optical_depth(x); };
  one.measure(worst(depths.size(),
                [&](std::size_t i)
                {
                  const long double truth = -std::expm1(-static_cast<long double>(depths[i]));
                  return static_cast<double>(std::abs(in_double(depths[i]) / truth - 1.0L)) *
                         std::ldexp(1.0, 23);
                }),
    4.0,
    "ulp",
    "double");
}

TEST(OpticsPackets, MeanTransmittance)
{
  HardCase one("Optics",
    "mean transmittance (1 − e^(−τ))/τ of a segment, τ from 1e-30 to 1e4",
    "0/0 at τ = 0, cancellation before it",
    "within 4 ulp of long double, 1 at 0, never above 1, and nowhere rising by more than 2 ulp");
  const Numbers depths = optical_depths();
  const auto truth = [&](std::size_t i)
  { return -std::expm1(-static_cast<long double>(depths[i])) / depths[i]; };
  for_each_target(
    [&](const std::string& target)
    {
      Numbers got = optics_packets::mean_transmittance(depths);
      one.measure(worst(got.size(), [&](std::size_t i) { return ulps(got[i], truth(i)); }),
        4.0,
        "ulp",
        target);
      one.holds(*std::max_element(got.begin(), got.end()) <= 1.0f, "at most 1", target);
      one.holds(optics_packets::mean_transmittance({ 0.0f, -0.0f }) == Numbers{ 1.0f, 1.0f },
        "1 at 0 and −0",
        target);
      std::reverse(got.begin(), got.end());
      one.measure(largest_fall(got), 2.0, "ulp of rise", target);
    });
}

namespace
{

/// Henyey and Greenstein, Schlick (of 1 − k), Rayleigh as books have them, in long double and of
/// 1 ∓ cos θ, so that the truth does not cancel.
long double book(const PhaseLobe& lobe, long double one_minus_cosine, long double one_plus_cosine)
{
  const long double size = std::min<long double>(std::abs(lobe.anisotropy), most_anisotropy);
  const long double away = lobe.anisotropy >= 0.0 ? one_minus_cosine : one_plus_cosine;
  switch (lobe.function)
  {
    case PhaseFunction::HenyeyGreenstein:
      return (1.0L - size) * (1.0L + size) / (4.0L * pi) /
             std::pow((1.0L - size) * (1.0L - size) + 2.0L * size * away, 1.5L);
    case PhaseFunction::Schlick:
    {
      const long double rest = schlick_one_minus_k(static_cast<double>(size));
      return rest * (2.0L - rest) / (4.0L * pi) / std::pow(rest + (1.0L - rest) * away, 2.0L);
    }
    case PhaseFunction::Rayleigh:
      return 3.0L / (16.0L * pi) * (1.0L + (1.0L - one_minus_cosine) * (1.0L - one_minus_cosine));
    default:
      return 1.0L / (4.0L * pi);
  }
}

struct PhaseCase
{
  const char* name;
  PhaseFunction function;
  std::vector<double> anisotropies;
  const char* why;
};

}

TEST(OpticsPackets, PhaseFunctions)
{
  const std::vector<double> all = {
    0.0, 1e-8, -1e-8, 0.5, 0.999, -0.999, 0.999999, -0.999999, 1.0, -1.0
  };
  const PhaseCase cases[] = {
    { "Henyey and Greenstein, |g| = 0, 1e-8, 0.999, 0.999999, 1, from cos θ = 1 to −1",
      PhaseFunction::HenyeyGreenstein,
      all,
      "1 + g² − 2g cos θ cancels where it matters most; at g = 1 it is 0/0" },
    { "Schlick, |g| = 0, 1e-8, 0.999, 0.999999, 1, from cos θ = 1 to −1",
      PhaseFunction::Schlick,
      all,
      "1 − k cos θ cancels, and is squared" },
    { "Rayleigh, from cos θ = 1 to −1",
      PhaseFunction::Rayleigh,
      { 0.0 },
      "none of it but the ends" },
  };
  // 1 − cos θ down to what no cosine in single precision can tell from 0, and its mirror image.
  Numbers minus, plus;
  for (double rest = 2.0; rest > 1e-14; rest *= 0.9)
  {
    minus.insert(minus.end(), { static_cast<float>(rest), static_cast<float>(2.0 - rest) });
    plus.insert(plus.end(), { static_cast<float>(2.0 - rest), static_cast<float>(rest) });
  }
  minus.insert(minus.end(), { 0.0f, 2.0f });
  plus.insert(plus.end(), { 2.0f, 0.0f });
  for (const PhaseCase& each : cases)
  {
    HardCase one("Optics",
      each.name,
      each.why,
      "within 16 ulp in single precision and a relative 1e-12 in double; |g| counts as 0.9999 at "
      "the most, "
      "and as 0 below 1e-6");
    for (const double g : each.anisotropies)
    {
      const PhaseLobe lobe{ each.function, 1.0, g };
      const PhaseLobe meant{ std::abs(g) < 1e-6 && each.function != PhaseFunction::Rayleigh
                               ? PhaseFunction::Isotropic
                               : each.function,
        1.0,
        g };
      const PhaseModel model = prepare_phase({ lobe });
      // The smaller of both is the one that has its digits.
      const auto truth = [&](std::size_t i)
      {
        const long double near = std::min(minus[i], plus[i]);
        return minus[i] <= plus[i] ? book(meant, near, 2.0L - near)
                                   : book(meant, 2.0L - near, near);
      };
      for_each_target(
        [&](const std::string& target)
        {
          const Numbers got = optics_packets::phase(model, minus, plus);
          one.measure(worst(got.size(), [&](std::size_t i) { return ulps(got[i], truth(i)); }),
            16.0,
            "ulp",
            target);
        });
      one.measure(worst(minus.size(),
                    [&](std::size_t i)
                    {
                      const double near = std::min(minus[i], plus[i]);
                      const double far = 2.0 - near;
                      const bool forward = minus[i] <= plus[i];
                      const double value =
                        scalar::phase<double>(model, forward ? near : far, forward ? far : near);
                      return static_cast<double>(std::abs(value / truth(i) - 1.0L));
                    }),
        1e-12,
        "relative",
        "double");
    }
  }
}

// What integrators hand to phase functions comes from vectors whose length is 1 up to rounding: the
// cosine may be a bit beyond ±1. Held against the exact angle's value.
TEST(OpticsPackets, PhaseOfDirectionsThatAreNotQuiteUnit)
{
  HardCase one("Optics",
    "phase functions at cos θ a bit beyond ±1",
    "unit vectors are off by rounding, so that a · b passes 1, and a denominator of 1e-8 turns "
    "negative",
    "finite, positive, never above the function's largest value, and at g = 0.9999 within 1 % of "
    "straight on: 1 − cos θ is "
    "taken as ½|a − b|²");
  for (const PhaseFunction function : { PhaseFunction::HenyeyGreenstein, PhaseFunction::Schlick })
  {
    for (const double g : { 0.999, 0.9999, -0.9999 })
    {
      const PhaseSampler sampler({ { function, 1.0, g } });
      const double most = largest_phase(sampler.model());
      double above = 0.0;
      double below = 0.0;
      expect_property("straight on",
        200,
        [&]()
        {
          const auto coordinate = []() { return *rc::gen::inRange(-1000, 1000) * 1e-3 + 1e-4; };
          const double x = coordinate();
          const double y = coordinate();
          const glm::dvec3 exact = glm::normalize(glm::dvec3(x, y, coordinate()));
          // Off by rounding of single precision, as the kernels' vectors are.
          const glm::vec3 rounded(exact);
          const glm::dvec3 from(rounded);
          const glm::dvec3 to = g > 0.0 ? exact : -exact;
          const double value = sampler.value(from, to);
          RC_ASSERT(std::isfinite(value) && value > 0.0);
          above = std::max(above, value / most - 1.0);
          below = std::max(below, 1.0 - value / most);
        });
      one.measure(above, 1e-12, "relative above the largest", "double");
      one.measure(below, 0.01, "relative below straight on", "double");
    }
  }
}

TEST(OpticsPackets, SecondExponentialIntegral)
{
  HardCase one("Optics",
    "E₂(x) from 0 to 700",
    "x E₁(x) is 0 · ∞ at 0; series and continued fraction meet at 1; the value underflows beyond "
    "700",
    "in double within a relative 1e-14 of Boost.Math, in single precision within 4e-7 absolute "
    "(and "
    "3e-6 relative from 1 to 80, where it is used for light), in [0, 1], 1 at 0");
  Numbers x = { 0.0f, 1e-30f, 1e-8f };
  for (double at = 1e-7; at < 700.0; at *= 1.004)
  {
    x.push_back(static_cast<float>(at));
  }
  for (float near : { std::nextafter(1.0f, 0.0f), 1.0f, std::nextafter(1.0f, 2.0f), 700.0f })
  {
    x.push_back(near);
  }
  const auto truth = [&](std::size_t i)
  { return boost::math::expint(2u, static_cast<long double>(x[i])); };
  for_each_target(
    [&](const std::string& target)
    {
      const Numbers got = optics_packets::second_exponential_integral(x);
      one.measure(
        worst(got.size(), [&](std::size_t i) { return std::abs(double(got[i] - truth(i))); }),
        4e-7,
        "absolute",
        target);
      one.measure(
        worst(got.size(),
          [&](std::size_t i) {
            return x[i] >= 1.0f && x[i] <= 80.0f ? std::abs(double(got[i] / truth(i) - 1.0L)) : 0.0;
          }),
        3e-6,
        "relative from 1 to 80",
        target);
      one.holds(std::all_of(got.begin(), got.end(), [](float v) { return v >= 0.0f && v <= 1.0f; }),
        "in [0, 1]",
        target);
    });
  one.measure(worst(x.size(),
                [&](std::size_t i)
                { return std::abs(double(exponential_integral_2(x[i]) / truth(i) - 1.0L)); }),
    1e-14,
    "relative",
    "double");
  one.holds(exponential_integral_2(0.0) == 1.0 && exponential_integral_2(INFINITY) == 0.0,
    "the ends are exact",
    "double");
}

TEST(OpticsPackets, BlackBodyTable)
{
  HardCase one("Optics",
    "black bodies by table, beyond both ends of it",
    "temperatures of data may be negative, infinite or hotter than the table, and gathers read "
    "what is there",
    "the table's ends hold: finite, 0 at and below 0 K, within 1e-5 of the brightest elsewhere");
  const BlackBodyTable table = make_black_body_table(20000.0, 1500.0);
  const Numbers ends = { -1e30f, -1.0f, -0.0f, 0.0f, 1e-30f, 20000.0f, 20001.0f, 1e30f, infinity };
  Numbers inside;
  for (float kelvin = 1.0f; kelvin < 20000.0f; kelvin *= 1.01f)
  {
    inside.push_back(kelvin);
  }
  const double hottest = black_body_radiance(20000.0, 1500.0).x;
  for_each_target(
    [&](const std::string& target)
    {
      const Numbers at_ends = optics_packets::black_body(table, ends);
      for (std::size_t i = 0; i < ends.size(); ++i)
      {
        const double wanted = ends[i] > 1.0f ? hottest : 0.0;
        one.measure(
          std::abs(at_ends[i] - wanted) / table.brightest, 1e-5, "of the brightest", target);
      }
      const Numbers got = optics_packets::black_body(table, inside);
      one.measure(worst(got.size(),
                    [&](std::size_t i) {
                      return std::abs(got[i] - black_body_radiance(inside[i], 1500.0).x) /
                             table.brightest;
                    }),
        1e-5,
        "of the brightest",
        target);
    });
}

TEST(OpticsPackets, Powder)
{
  HardCase one("Optics",
    "remaps and powers of powder at and beyond their ends",
    "`d^R(h; 0.3, 0.9 → 0.5, 1)` is 0⁰-like at d = 0, NaN for d < 0, and heights lie outside of "
    "both remaps",
    "within 4e-7 of the formula in double with d and h cut to [0, 1]; in [0, 1] for any d and h, "
    "also infinite ones");
  Numbers value, height;
  for (const float d :
    { -infinity, -1.0f, -0.0f, 0.0f, 1e-38f, 1e-30f, 1e-6f, 0.3f, 1.0f, 1.0001f, 50.0f, infinity })
  {
    for (const float h : { -infinity,
           -0.1f,
           0.0f,
           0.15f,
           std::nextafter(0.3f, 0.0f),
           0.3f,
           0.6f,
           0.9f,
           1.0f,
           1.5f,
           infinity })
    {
      value.push_back(d);
      height.push_back(h);
    }
  }
  for (const Powder::Form form : { Powder::Form::Exponential, Powder::Form::Height })
  {
    for (const double strength : { 0.0, 0.7, 1.0 })
    {
      const Powder powder{ true, strength, form, 1.5 };
      const auto truth = [&](std::size_t i)
      {
        const double d = saturate(1.5 * value[i]);
        if (form == Powder::Form::Exponential)
        {
          return 1.0 - strength * std::exp(-2.0 * d);
        }
        const double h = saturate(height[i]);
        return 1.0 - saturate(strength * std::pow(d, remap(h, 0.3, 0.9, 0.5, 1.0))) *
                       std::pow(saturate(remap(h, 0.0, 0.3, 0.8, 1.0)), 0.8);
      };
      for_each_target(
        [&](const std::string& target)
        {
          const Numbers got = optics_packets::powder(powder, value, height);
          one.measure(worst(got.size(), [&](std::size_t i) { return std::abs(got[i] - truth(i)); }),
            4e-7,
            "absolute",
            target);
          one.holds(
            std::all_of(got.begin(), got.end(), [](float v) { return v >= 0.0f && v <= 1.0f; }),
            "in [0, 1]",
            target);
        });
    }
  }
}

TEST(OpticsPackets, Remaps)
{
  HardCase one("Optics",
    "linear remaps R(x; a, b → c, d) at and beyond their ends",
    "a = b divides by 0, x may be infinite or NaN, and a · (1 − t) + b · t leaves [c, d] by "
    "rounding",
    "finite and between c and d for any x; NaN counts as the lower end; a = b is the step at that "
    "place");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  double beyond = 0.0;
  for (const double x :
    { -double(INFINITY), -1e300, -1.0, -0.0, 0.0, 0.3, 0.5, 1.0, 1e300, double(INFINITY), nan })
  {
    for (const auto& [a, b] :
      { std::pair{ 0.3, 0.9 }, { 0.0, 0.3 }, { 0.5, 0.5 }, { 1.0, 0.0 }, { 0.0, 1e-320 } })
    {
      const double got = remap(x, a, b, 0.8, 1.0);
      beyond = got >= 0.8 && got <= 1.0 ? beyond
               : std::isfinite(got)     ? std::max(beyond, std::max(0.8 - got, got - 1.0))
                                        : INFINITY;
    }
  }
  one.measure(beyond, 0.0, "beyond the range", "double");
  one.holds(remap(nan, 0.3, 0.9, 0.5, 1.0) == 0.5, "NaN is the lower end", "double");
  one.holds(remap(0.4999, 0.5, 0.5, 0.0, 1.0) == 0.0 && remap(0.5, 0.5, 0.5, 0.0, 1.0) == 1.0,
    "a step",
    "double");
}

TEST(OpticsPackets, ReciprocalSquareRoot)
{
  HardCase one("Optics",
    "1/√x of lengths, x from denormals to 1e38",
    "processors guess it to 12 bits, and refine 0 and infinity to NaN; directions are divided by "
    "it",
    "within 3 ulp from 1e-37 to 1e37; 0 at and below 0; finite everywhere");
  Numbers x;
  for (double at = 1.01e-37; at < 1e37; at *= 1.01)
  {
    x.push_back(static_cast<float>(at));
  }
  const Numbers ends = { 0.0f, -0.0f, -1.0f, -infinity, 1e-45f, 1e-38f, 1e38f, 3.4e38f, infinity };
  for_each_target(
    [&](const std::string& target)
    {
      const Numbers got = optics_packets::reciprocal_square_root(x);
      one.measure(worst(got.size(),
                    [&](std::size_t i)
                    { return ulps(got[i], 1.0L / std::sqrt(static_cast<long double>(x[i]))); }),
        3.0,
        "ulp",
        target);
      const Numbers at_ends = optics_packets::reciprocal_square_root(ends);
      one.holds(
        std::all_of(at_ends.begin(), at_ends.end(), [](float v) { return std::isfinite(v); }),
        "finite at the ends",
        target);
      one.holds(
        std::all_of(at_ends.begin(), at_ends.begin() + 4, [](float v) { return v == 0.0f; }),
        "0 at and below 0",
        target);
    });
}
