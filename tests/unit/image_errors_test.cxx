// The figures of measure(): by hand, against a second implementation, and against OpenImageIO.
#include "Analysis/image_errors.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace
{

constexpr float infinity = std::numeric_limits<float>::infinity();
const float nan_value = std::nanf("");

brume::Picture filled(int width, int height, float value)
{
  return { width, height, std::vector<float>(3u * width * height, value) };
}

brume::Picture noise(int width, int height, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(-0.2f, 1.4f);
  brume::Picture picture = filled(width, height, 0.f);
  std::generate(picture.rgb.begin(), picture.rgb.end(), [&] { return value(random); });
  return picture;
}

TEST(ImageErrors, of_a_picture_with_itself_are_zero)
{
  const brume::Picture picture = noise(7, 5, 1);
  const brume::ImageErrors errors = brume::measure(picture, picture);
  EXPECT_EQ(errors.mean_shift, 0.0);
  EXPECT_EQ(errors.mean_absolute, 0.0);
  EXPECT_EQ(errors.rms, 0.0);
  EXPECT_EQ(errors.percentile_999, 0.0);
  EXPECT_EQ(errors.largest, 0.0);
  EXPECT_EQ(errors.values, 105u);
  EXPECT_EQ(errors.non_finite_pixels, 0u);
}

TEST(ImageErrors, by_hand)
{
  // Errors +0.5, -0.25, 0, 0, +1, -2 (exact in binary), nothing clamped.
  const brume::Picture test{ 2, 1, { 0.75f, 0.f, 0.5f, 1.f, 2.f, -1.f } };
  const brume::Picture truth{ 2, 1, { 0.25f, 0.25f, 0.5f, 1.f, 1.f, 1.f } };
  const brume::ImageErrors errors = brume::measure(test, truth);
  EXPECT_DOUBLE_EQ(errors.mean_shift, -0.75 / 6.0);
  EXPECT_DOUBLE_EQ(errors.mean_absolute, 3.75 / 6.0);
  EXPECT_DOUBLE_EQ(errors.rms, std::sqrt((0.25 + 0.0625 + 1.0 + 4.0) / 6.0));
  EXPECT_DOUBLE_EQ(errors.percentile_999, 2.0);
  EXPECT_DOUBLE_EQ(errors.largest, 2.0);
  EXPECT_DOUBLE_EQ(brume::measure(truth, test).mean_shift, 0.75 / 6.0);
}

TEST(ImageErrors, percentile_leaves_out_one_value_in_a_thousand)
{
  // 3000 values: three may lie above the percentile, so the fourth largest is the answer.
  const brume::Picture truth = filled(100, 10, 0.f);
  brume::Picture test = truth;
  test.rgb[17] = 4.f;
  test.rgb[1801] = -3.f;
  test.rgb[2999] = 2.f;
  EXPECT_EQ(brume::measure(test, truth).percentile_999, 0.0);
  test.rgb[3] = -0.5f;
  EXPECT_EQ(brume::measure(test, truth).percentile_999, 0.5);
  EXPECT_EQ(brume::measure(test, truth).largest, 4.0);
}

TEST(ImageErrors, agree_with_a_sort_and_plain_sums)
{
  for (const auto& [width, height] : { std::pair{ 1, 1 }, { 333, 1 }, { 334, 1 }, { 61, 47 } })
  {
    const brume::Picture test = noise(width, height, 2);
    const brume::Picture truth = noise(width, height, 3);
    std::vector<long double> sorted;
    long double shift = 0, absolute = 0, squares = 0;
    for (std::size_t i = 0; i < test.rgb.size(); ++i)
    {
      const long double e = static_cast<long double>(test.rgb[i]) - truth.rgb[i];
      shift += e;
      absolute += std::abs(e);
      squares += e * e;
      sorted.push_back(std::abs(e));
    }
    std::sort(sorted.begin(), sorted.end());
    const long double n = sorted.size();
    std::size_t enough = 0; // the definition, word by word
    while (static_cast<long double>(enough + 1) * 1000 < 999 * n)
    {
      ++enough;
    }
    const brume::ImageErrors errors = brume::measure(test, truth);
    EXPECT_NEAR(errors.mean_shift, static_cast<double>(shift / n), 1e-14);
    EXPECT_NEAR(errors.mean_absolute, static_cast<double>(absolute / n), 1e-14);
    EXPECT_NEAR(errors.rms, static_cast<double>(std::sqrt(squares / n)), 1e-14);
    EXPECT_EQ(errors.percentile_999, static_cast<double>(sorted[enough])) << width;
    EXPECT_EQ(errors.largest, static_cast<double>(sorted.back()));
  }
}

TEST(ImageErrors, agree_with_OpenImageIO)
{
  brume::Picture test = noise(64, 40, 4);
  brume::Picture truth = noise(64, 40, 5);
  const OIIO::ImageSpec spec(64, 40, 3, OIIO::TypeDesc::FLOAT);
  const OIIO::ImageBuf test_buffer(spec, test.rgb.data());
  const OIIO::ImageBuf truth_buffer(spec, truth.rgb.data());
  const OIIO::ImageBufAlgo::CompareResults theirs =
    OIIO::ImageBufAlgo::compare(test_buffer, truth_buffer, 0.f, 0.f);
  const brume::ImageErrors errors = brume::measure(test, truth);
  EXPECT_NEAR(errors.mean_absolute, theirs.meanerror, 1e-6);
  EXPECT_NEAR(errors.rms, theirs.rms_error, 1e-6);
  EXPECT_NEAR(errors.largest, theirs.maxerror, 1e-6); // subtracts in float
}

TEST(ImageErrors, count_non_finite_values_as_infinite)
{
  const brume::Picture truth = filled(100, 10, 0.5f);
  brume::Picture test = truth;
  test.rgb[4] = nan_value;
  test.rgb[5] = -infinity;
  const brume::ImageErrors errors = brume::measure(test, truth);
  EXPECT_EQ(errors.non_finite_test, 2u);
  EXPECT_EQ(errors.non_finite_truth, 0u);
  EXPECT_EQ(errors.non_finite_pixels, 1u);
  for (const double e :
    { errors.mean_shift, errors.mean_absolute, errors.rms, errors.largest })
  {
    EXPECT_EQ(e, std::numeric_limits<double>::infinity());
  }
  EXPECT_EQ(errors.percentile_999, 0.0) << "2 of 3000 values are within the 0.1 %";

  test.rgb[6] = test.rgb[7] = infinity;
  EXPECT_EQ(brume::measure(test, truth).percentile_999, std::numeric_limits<double>::infinity());
}

TEST(ImageErrors, a_value_that_is_infinite_in_both_is_no_agreement)
{
  brume::Picture both = filled(2, 2, 0.5f);
  both.rgb[0] = infinity;
  const brume::ImageErrors errors = brume::measure(both, both);
  EXPECT_EQ(errors.non_finite_test, 1u);
  EXPECT_EQ(errors.non_finite_truth, 1u);
  EXPECT_EQ(errors.largest, std::numeric_limits<double>::infinity());
}

TEST(ImageErrors, refuse_pictures_that_cannot_be_compared)
{
  const brume::Picture picture = filled(4, 3, 0.f);
  EXPECT_THROW(brume::measure(picture, filled(3, 4, 0.f)), std::invalid_argument);
  EXPECT_THROW(brume::measure(brume::Picture{}, brume::Picture{}), std::invalid_argument);
  brume::Picture torn = picture;
  torn.rgb.pop_back();
  EXPECT_THROW(brume::measure(picture, torn), std::invalid_argument);
  EXPECT_THROW(brume::measure(torn, picture), std::invalid_argument);
}

}
