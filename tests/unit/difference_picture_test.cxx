// The gain, the colours and the legend of difference pictures, and the panel, all without display.
#include "Analysis/difference_picture.h"
#include "Analysis/panel.h"
#include "sample_comparison.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <stdexcept>

namespace
{

using brume::DifferenceKind;

const float not_a_number = std::nanf("");

brume::ImageErrors errors_of(double percentile, double largest)
{
  brume::ImageErrors errors;
  errors.values = 3000;
  errors.percentile_999 = percentile;
  errors.largest = largest;
  return errors;
}

brume::Picture filled(int width, int height, float value)
{
  return { width, height, std::vector<float>(3u * width * height, value) };
}

std::array<int, 3> pixel(const brume::Bitmap& bitmap, int x, int y)
{
  const unsigned char* rgb = &bitmap.rgb[3u * (y * bitmap.width + x)];
  return { rgb[0], rgb[1], rgb[2] };
}

/// Relative luminance of a displayed colour (IEC 61966-2-1).
double luminance(const std::array<unsigned char, 3>& colour)
{
  const double weights[] = { 0.2126, 0.7152, 0.0722 };
  double sum = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    const double v = colour[i] / 255.0;
    sum += weights[i] * (v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
  }
  return sum;
}

TEST(DifferenceGain, is_the_largest_power_of_two_that_keeps_the_percentile_on_the_scale)
{
  EXPECT_EQ(brume::automatic_gain(errors_of(0.25, 0.5)), 4.0);
  EXPECT_EQ(brume::automatic_gain(errors_of(0.2500001, 0.5)), 2.0);
  EXPECT_EQ(brume::automatic_gain(errors_of(0.2499999, 0.5)), 4.0);
  for (double e = 1e-8; e <= 1.0; e *= 1.37)
  {
    const double gain = brume::automatic_gain(errors_of(e, 1.0));
    EXPECT_GT(gain * e, 0.5) << e;
    EXPECT_LE(gain * e, 1.0) << e;
    int exponent = 0;
    EXPECT_EQ(std::frexp(gain, &exponent), 0.5) << "a power of two";
  }
}

TEST(DifferenceGain, of_odd_errors)
{
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(brume::automatic_gain(errors_of(0.0, 0.0)), 1.0);
  EXPECT_EQ(brume::automatic_gain(errors_of(0.0, 0.125)), 8.0) << "the largest takes its place";
  EXPECT_EQ(brume::automatic_gain(errors_of(infinity, infinity)), 1.0);
  EXPECT_EQ(brume::automatic_gain(errors_of(7.0, 9.0)), 1.0) << "never made smaller";
  EXPECT_EQ(brume::automatic_gain(errors_of(1e-300, 1e-300)), std::ldexp(1.0, 30));
}

TEST(DifferenceGain, shared_is_the_smallest_of_those_that_count)
{
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(brume::shared_gain({}), 1.0);
  EXPECT_EQ(brume::shared_gain({ errors_of(0.01, 1), errors_of(0.1, 1) }), 8.0);
  EXPECT_EQ(brume::shared_gain({ errors_of(0, 0), errors_of(0.1, 1), errors_of(infinity, infinity) }),
    8.0);
}

TEST(DifferencePicture, shows_the_channel_that_differs_most)
{
  const brume::Picture truth = filled(3, 1, 0.5f);
  brume::Picture test = truth;
  test.rgb[1] += 0.125f;                         // pixel 0: half the scale at gain 4
  test.rgb[3] += 0.03125f, test.rgb[5] -= 0.25f; // pixel 1: the end, downward
  const auto absolute =
    brume::difference_picture(test, truth, DifferenceKind::Absolute, 4.0);
  EXPECT_EQ(absolute.gain, 4.0);
  const auto colour = [](DifferenceKind kind, double at) {
    const auto c = brume::legend_colour(kind, at);
    return std::array<int, 3>{ c[0], c[1], c[2] };
  };
  EXPECT_EQ(pixel(absolute.bitmap, 0, 0), colour(DifferenceKind::Absolute, 0.5));
  EXPECT_EQ(pixel(absolute.bitmap, 1, 0), colour(DifferenceKind::Absolute, 1.0));
  EXPECT_EQ(pixel(absolute.bitmap, 2, 0), colour(DifferenceKind::Absolute, 0.0));
  EXPECT_EQ(absolute.pixels_beyond_scale, 0u);

  const auto both_ways = brume::difference_picture(test, truth, DifferenceKind::Signed, 8.0);
  EXPECT_EQ(pixel(both_ways.bitmap, 0, 0), colour(DifferenceKind::Signed, 1.0));
  EXPECT_EQ(pixel(both_ways.bitmap, 1, 0), colour(DifferenceKind::Signed, 0.0));
  EXPECT_EQ(pixel(both_ways.bitmap, 2, 0), colour(DifferenceKind::Signed, 0.5));
  EXPECT_EQ(both_ways.pixels_beyond_scale, 1u);
}

TEST(DifferencePicture, marks_what_is_not_finite)
{
  const brume::Picture truth = filled(20, 20, 0.5f);
  brume::Picture test = truth;
  test.rgb[0] = not_a_number;
  const auto difference = brume::difference_picture(test, truth);
  EXPECT_EQ(difference.non_finite_pixels, 1u);
  EXPECT_EQ(pixel(difference.bitmap, 0, 0), (std::array<int, 3>{ 0, 255, 64 }));
  EXPECT_EQ(pixel(difference.bitmap, 1, 0), (std::array<int, 3>{ 0, 0, 0 }));
}

TEST(DifferencePicture, refuses_a_gain_that_is_none)
{
  const brume::Picture picture = filled(2, 2, 0.f);
  EXPECT_THROW(brume::difference_picture(picture, picture, DifferenceKind::Absolute, -1.0),
    std::invalid_argument);
  EXPECT_THROW(brume::difference_picture(picture, picture, DifferenceKind::Absolute, not_a_number),
    std::invalid_argument);
}

TEST(DifferenceColours, grow_lighter_with_the_error)
{
  for (int i = 1; i <= 50; ++i)
  {
    EXPECT_GE(luminance(brume::legend_colour(DifferenceKind::Absolute, i / 50.0)),
      luminance(brume::legend_colour(DifferenceKind::Absolute, (i - 1) / 50.0)))
      << i;
  }
  EXPECT_LT(luminance(brume::legend_colour(DifferenceKind::Absolute, 0.0)), 0.001);
  EXPECT_GT(luminance(brume::legend_colour(DifferenceKind::Absolute, 1.0)), 0.85);
}

TEST(DifferenceColours, tell_bright_from_dark)
{
  const auto dark = brume::legend_colour(DifferenceKind::Signed, 0.0);
  const auto none = brume::legend_colour(DifferenceKind::Signed, 0.5);
  const auto bright = brume::legend_colour(DifferenceKind::Signed, 1.0);
  EXPECT_GT(dark[2], dark[0] + 100);
  EXPECT_GT(bright[0], bright[2] + 100);
  EXPECT_NEAR(none[0], none[2], 3);
  EXPECT_GT(luminance(none), 2.0 * std::max(luminance(dark), luminance(bright)));
}

TEST(DifferenceLegend, has_marks_at_round_errors)
{
  for (double gain = 1.0; gain <= 1048576.0; gain *= 2.0)
  {
    for (const DifferenceKind kind : { DifferenceKind::Absolute, DifferenceKind::Signed })
    {
      const auto ticks = brume::legend_ticks(kind, gain);
      EXPECT_GE(ticks.size(), 3u) << gain;
      EXPECT_LE(ticks.size(), 5u) << gain;
      for (const auto& tick : ticks)
      {
        const double error = std::stod(tick.text) / 255.0;
        const double along = kind == DifferenceKind::Absolute ? error * gain
                                                              : (error * gain + 1.0) / 2.0;
        EXPECT_NEAR(tick.position, along, 0.005) << tick.text;
      }
    }
  }
  EXPECT_EQ(brume::difference_label(DifferenceKind::Absolute, 64.0), "absolute difference × 64");
  EXPECT_EQ(brume::difference_label(DifferenceKind::Signed, 1.0), "signed difference, not amplified");
}

TEST(DifferenceLegend, stands_below_the_picture)
{
  unsetenv("DISPLAY");
  brume::Picture truth = filled(400, 30, 0.5f);
  brume::Picture test = truth;
  test.rgb[5] = 0.6f;
  const auto difference = brume::difference_picture(test, truth);
  const brume::Bitmap sheet = brume::with_legend(difference);
  EXPECT_EQ(sheet.width, 400);
  ASSERT_GT(sheet.height, 30);
  const int strip = sheet.height - 30;
  for (int x = 0; x < 400; ++x)
  {
    EXPECT_EQ(pixel(sheet, x, strip), pixel(difference.bitmap, x, 0));
  }
  std::set<std::array<int, 3>> colours;
  for (int x = 0; x < 400; ++x)
  {
    for (int y = 0; y < strip; ++y)
    {
      colours.insert(pixel(sheet, x, y));
    }
  }
  EXPECT_GT(colours.size(), 200u) << "the bar and anti-aliased lettering";
}

TEST(Panel, has_a_column_for_each_mapper_and_the_truth)
{
  unsetenv("DISPLAY");
  brume::Comparison comparison = sample::comparison(200, 120); // enlarged twice
  const brume::ComparisonEntry last = comparison.entries.back();
  std::vector<int> widths;
  comparison.entries.resize(1);
  for (int count = 1; count <= 5; ++count)
  {
    const brume::Bitmap sheet = brume::panel(comparison);
    EXPECT_GE(sheet.width, (count + 1) * 400);
    EXPECT_GE(sheet.height, 2 * 240);
    widths.push_back(sheet.width);
    comparison.entries.push_back(last);
  }
  for (std::size_t i = 1; i < widths.size(); ++i)
  {
    EXPECT_EQ(widths[i] - widths[i - 1], widths[1] - widths[0]);
  }
}

/// The place of the bitmap's middle row in the sheet, or the sheet's end.
std::size_t place_of(const brume::Bitmap& bitmap, const brume::Bitmap& sheet)
{
  const auto row = bitmap.rgb.begin() + 3 * bitmap.width * (bitmap.height / 2);
  return std::search(sheet.rgb.begin(), sheet.rgb.end(), row, row + 3 * bitmap.width) -
    sheet.rgb.begin();
}

TEST(Panel, holds_the_pictures_above_their_differences_at_one_gain)
{
  const brume::Comparison comparison = sample::comparison(320, 200); // not scaled
  const brume::Bitmap sheet = brume::panel(comparison);
  const double gain = brume::automatic_gain(comparison.entries[2].against_truth);
  EXPECT_GT(brume::automatic_gain(comparison.entries[0].against_truth), gain);
  for (const brume::ComparisonEntry& entry : comparison.entries)
  {
    const std::size_t picture = place_of(brume::to_bitmap(entry.picture), sheet);
    const std::size_t difference = place_of(brume::difference_picture(entry.picture,
      comparison.truth.picture, DifferenceKind::Absolute, gain).bitmap, sheet);
    EXPECT_LT(picture, sheet.rgb.size()) << entry.title;
    EXPECT_LT(difference, picture) << entry.title << ": rows run upward";
  }
  EXPECT_LT(place_of(brume::to_bitmap(comparison.truth.picture), sheet), sheet.rgb.size());
}

TEST(Panel, letters_are_light)
{
  const brume::Bitmap sheet = brume::panel(sample::comparison(320, 200));
  int brightest = 0;
  for (int y = sheet.height - 60; y < sheet.height; ++y) // the head
  {
    for (int x = 0; x < sheet.width; ++x)
    {
      brightest = std::max(brightest, pixel(sheet, x, y)[1]);
    }
  }
  EXPECT_GT(brightest, 220);
}

TEST(Panel, cuts_titles_to_their_column)
{
  brume::Comparison comparison = sample::comparison(320, 200);
  const brume::Bitmap plain = brume::panel(comparison);
  comparison.entries[0].title = std::string(500, 'W') + " \xff\xfe $x_1$ × …";
  const brume::Bitmap cut = brume::panel(comparison);
  ASSERT_EQ(cut.width, plain.width);
  ASSERT_EQ(cut.height, plain.height);
  EXPECT_NE(cut.rgb, plain.rgb);
  constexpr int second_column = 24 + 320 + 12; // margin, cell, gap
  for (int y = 0; y < plain.height; ++y)
  {
    for (int x = second_column; x < plain.width; ++x)
    {
      ASSERT_EQ(pixel(cut, x, y), pixel(plain, x, y)) << x << ", " << y;
    }
  }
  comparison.scene.input = std::string(5000, '/');
  EXPECT_EQ(brume::panel(comparison).width, plain.width);
}

TEST(Panel, without_truth_has_one_row)
{
  brume::Comparison comparison = sample::comparison(320, 200);
  const brume::Bitmap with_truth = brume::panel(comparison);
  comparison.truth.picture = {};
  const brume::Bitmap without = brume::panel(comparison);
  EXPECT_LT(without.height, with_truth.height - 200);
  EXPECT_LT(without.width, with_truth.width - 300);
}

TEST(Panel, names_what_was_skipped)
{
  brume::Comparison comparison = sample::comparison(320, 200);
  const brume::Bitmap all = brume::panel(comparison);
  comparison.entries[2].skipped = "no display";
  const brume::Bitmap fewer = brume::panel(comparison);
  EXPECT_LT(fewer.width, all.width);
  EXPECT_GT(fewer.height, all.height);
  for (brume::ComparisonEntry& entry : comparison.entries)
  {
    entry.skipped = "no display";
  }
  EXPECT_THROW(brume::panel(comparison), std::invalid_argument);
}

TEST(Panel, refuses_pictures_of_two_sizes)
{
  brume::Comparison comparison = sample::comparison(32, 20);
  comparison.truth.picture = {};
  comparison.entries[1].picture = sample::ball(20, 32);
  EXPECT_THROW(brume::panel(comparison), std::invalid_argument);
}

TEST(Png, comes_back_as_it_went)
{
  const brume::Bitmap bitmap = brume::to_bitmap(sample::ball(37, 23));
  std::vector<unsigned char> png = brume::encode_png(bitmap);
  OIIO::Filesystem::IOMemReader memory(png.data(), png.size());
  const auto reader = OIIO::ImageInput::open("memory.png", nullptr, &memory);
  ASSERT_TRUE(reader);
  EXPECT_EQ(reader->spec().width, 37);
  EXPECT_EQ(reader->spec().height, 23);
  EXPECT_EQ(reader->spec().nchannels, 3);
  std::vector<unsigned char> rows(bitmap.rgb.size());
  ASSERT_TRUE(reader->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, rows.data()));
  for (int y = 0; y < 23; ++y) // the file's rows run downward
  {
    EXPECT_TRUE(std::equal(rows.begin() + y * 37 * 3, rows.begin() + (y + 1) * 37 * 3,
      bitmap.rgb.begin() + (22 - y) * 37 * 3));
  }
}

TEST(DisplayCurve, clamps_rounds_and_marks)
{
  const brume::Picture picture{ 3, 1,
    { -1.f, 0.5f, 2.f, 0.f, 1.f, 0.2140411f, 0.f, not_a_number, 0.f } };
  const brume::Bitmap identity = brume::to_bitmap(picture);
  EXPECT_EQ(pixel(identity, 0, 0), (std::array<int, 3>{ 0, 128, 255 }));
  EXPECT_EQ(pixel(identity, 1, 0), (std::array<int, 3>{ 0, 255, 55 }));
  EXPECT_EQ(pixel(identity, 2, 0), (std::array<int, 3>{ 255, 0, 255 }));
  const brume::Bitmap srgb = brume::to_bitmap(picture, brume::DisplayCurve::Srgb);
  EXPECT_EQ(pixel(srgb, 0, 0), (std::array<int, 3>{ 0, 188, 255 }));
  EXPECT_NEAR(pixel(srgb, 1, 0)[2], 128, 1) << "linear 0.214 is half of a display's range";
}

}
