// What a study is measured with and made of: fronts, errors against a truth with noise, where errors
// lie, words, cost.csv and cost.json.
#include "Analysis/error_classes.h"
#include "Analysis/image_filters.h"
#include "Analysis/pareto_front.h"
#include "Analysis/study.h"
#include "Analysis/study_errors.h"
#include "Analysis/study_json.h"
#include "Analysis/study_words.h"
#include "Analysis/study_report.h"
#include "html_check.h"
#include "sample_study.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <sstream>

namespace
{

using brume::Cost;
using nlohmann::json;

constexpr double infinity = std::numeric_limits<double>::infinity();

bool contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

TEST(ParetoFront, keeps_what_nothing_beats)
{
  using Indices = std::vector<std::size_t>;
  EXPECT_EQ(brume::pareto_front({}), Indices{});
  EXPECT_EQ(brume::pareto_front({ { 1, 1 } }), Indices{ 0 });
  EXPECT_EQ(brume::pareto_front({ { 3, 1 }, { 1, 3 }, { 2, 2 }, { 2.5, 2.5 }, { 4, 1 } }),
    (Indices{ 1, 2, 0 }));
  EXPECT_EQ(brume::pareto_front({ { 1, 2 }, { 1, 2 }, { 1, 1 }, { 2, 1 } }), Indices{ 2 });
  EXPECT_EQ(brume::pareto_front({ { 1, infinity }, { std::nan(""), 0 }, { 5, 5 } }), Indices{ 2 });
}

TEST(ParetoFront, is_a_front_of_any_costs)
{
  std::mt19937 random(7);
  std::uniform_int_distribution<int> figure(0, 12); // few, so that many are equal
  std::vector<Cost> costs(300);
  for (Cost& c : costs)
  {
    c = { double(figure(random)), double(figure(random)) };
  }
  const auto beats = [](const Cost& a, const Cost& b)
  { return a.seconds <= b.seconds && a.error <= b.error && (a.seconds < b.seconds || a.error < b.error); };
  const std::vector<std::size_t> front = brume::pareto_front(costs);
  for (const std::size_t i : front)
  {
    for (const Cost& other : costs)
    {
      EXPECT_FALSE(beats(other, costs[i]));
    }
  }
  for (const Cost& cost : costs)
  {
    bool covered = false;
    for (const std::size_t i : front)
    {
      covered = covered || beats(costs[i], cost) ||
        (costs[i].seconds == cost.seconds && costs[i].error == cost.error);
    }
    EXPECT_TRUE(covered);
  }
}

/// Halves of a truth of 0.5 with noise of this standard deviation each.
brume::TruthHalves noisy(int size, double sigma, unsigned seed)
{
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0.5f, static_cast<float>(sigma));
  brume::TruthHalves halves;
  for (brume::Picture* half : { &halves.a, &halves.b })
  {
    *half = { size, size, {} };
    for (int i = 0; i < 3 * size * size; ++i)
    {
      half->rgb.push_back(noise(random));
    }
  }
  return halves;
}

brume::Picture flat(int size, float value)
{
  return { size, size, std::vector<float>(3 * static_cast<std::size_t>(size) * size, value) };
}

TEST(StudyErrors, are_freed_of_the_truths_noise)
{
  constexpr int size = 64;
  double mean = 0.0;
  double off = 0.0;
  constexpr int seeds = 40;
  for (unsigned seed = 0; seed < seeds; ++seed)
  {
    const brume::TruthHalves halves = noisy(size, 0.2, seed);
    const brume::TruthNoise noise = brume::noise_of(halves);
    EXPECT_NEAR(noise.rms, 0.2 / std::sqrt(2.0), 0.005);
    const brume::StudyErrors errors = brume::measure_against(
      flat(size, 0.55f), brume::mean_of(halves), halves, noise);
    EXPECT_GT(errors.measured.rms, 0.14) << "the noise is in what was measured";
    EXPECT_LE(errors.rms, errors.rms_upper);
    EXPECT_LT(std::abs(errors.measured.mean_shift - 0.05), 4.0 * errors.mean_shift_error);
    mean += errors.rms * errors.rms / seeds;
    const double square_error =
      0.5 * (errors.rms_upper * errors.rms_upper - errors.rms * errors.rms);
    off += std::pow((errors.rms * errors.rms - 0.05 * 0.05) / square_error, 2) / seeds;
  }
  EXPECT_NEAR(mean, 0.05 * 0.05, 1e-4);
  EXPECT_NEAR(off, 1.0, 0.6) << "the standard error that is told is the one that there is";
}

TEST(StudyErrors, tell_what_the_truth_cannot)
{
  const brume::TruthHalves halves = noisy(32, 0.2, 3);
  const brume::TruthNoise noise = brume::noise_of(halves);
  const brume::Picture truth = brume::mean_of(halves);
  brume::StudyErrors errors = brume::measure_against(flat(32, 0.5f), truth, halves, noise);
  EXPECT_TRUE(errors.rms_limited);
  EXPECT_TRUE(errors.percentile_limited);
  errors = brume::measure_against(flat(32, 1.9f), truth, halves, noise);
  EXPECT_FALSE(errors.rms_limited);
  EXPECT_FALSE(errors.percentile_limited);
  brume::Picture broken = flat(32, 0.5f);
  broken.rgb[5] = std::nanf("");
  EXPECT_EQ(brume::measure_against(broken, truth, halves, noise).rms, infinity);
}

TEST(StudyErrors, count_pixels_by_their_worst_channel)
{
  const brume::Picture truth = flat(10, 0.5f);
  brume::Picture picture = truth;
  picture.rgb[0] = 0.52f;
  picture.rgb[1] = 0.7f;
  picture.rgb[3] = 0.52f;
  picture.rgb[6] = std::nanf("");
  EXPECT_DOUBLE_EQ(brume::share_within(picture, truth, 0.05), 0.98);
  EXPECT_DOUBLE_EQ(brume::share_within(picture, truth, 0.01), 0.97);
  EXPECT_DOUBLE_EQ(brume::share_within(picture, truth, 1.0), 0.99);
}

TEST(ImageFilters, tell_what_an_eye_would)
{
  const brume::Picture grey = flat(64, 0.4f);
  EXPECT_EQ(brume::perceptual_difference(grey, grey), 0.0);
  EXPECT_EQ(brume::perceptual_difference(flat(64, 0.4001f), grey), 0.0);
  const brume::TruthHalves grainy = noisy(64, 0.2, 5);
  EXPECT_GT(brume::perceptual_difference(grainy.a, grainy.b), 0.9);
  EXPECT_LT(brume::perceptual_difference(noisy(64, 0.002, 5).a, grey), 0.01);
  brume::Picture spot = grey;
  for (int y = 20; y < 32; ++y)
  {
    for (int x = 20; x < 32; ++x)
    {
      spot.rgb[3 * (64 * y + x)] = 1.0f;
    }
  }
  const double share = brume::perceptual_difference(spot, grey);
  EXPECT_GT(share, 0.02);
  EXPECT_LT(share, 0.3);
  brume::Picture broken = grey;
  broken.rgb[7] = std::nanf("");
  EXPECT_NEAR(brume::perceptual_difference(broken, grey), 1.0 / (64 * 64), 1e-9);
  EXPECT_THROW(brume::perceptual_difference(flat(32, 0.4f), grey), std::invalid_argument);
}

TEST(ImageFilters, scale_linearly)
{
  brume::Picture ramp{ 8, 4, {} };
  for (int i = 0; i < 32; ++i)
  {
    ramp.rgb.insert(ramp.rgb.end(), 3, static_cast<float>(i % 8));
  }
  const brume::Picture larger = brume::scaled(ramp, 16, 8);
  for (int y = 0; y < 8; ++y)
  {
    for (int x = 2; x < 14; ++x) // but for the border
    {
      EXPECT_NEAR(larger.rgb[3 * (16 * y + x)], (x + 0.5) / 2.0 - 0.5, 1e-4);
    }
  }
  EXPECT_THROW(brume::scaled(ramp, 0, 8), std::invalid_argument);
}

TEST(ErrorClasses, part_the_pixels_by_depth_and_outline)
{
  const brume::Study study = sample::study();
  // Thirds of the picture's width: depths of 0.2, 1 and 5.
  EXPECT_EQ(study.depths.pixels, (std::vector<std::size_t>{ 300, 300, 300 }));
  EXPECT_EQ(study.depths.of_pixel.front(), 0);
  EXPECT_EQ(study.depths.of_pixel.back(), 2);
  // The steepest pixels are those beside the steps between the thirds.
  EXPECT_EQ(study.outlines.of_pixel[9], 0);
  EXPECT_EQ(study.outlines.of_pixel[4], 1);
  std::vector<float> empty(4, 1.0f);
  const std::vector<float> clear[3] = { empty, empty, empty };
  const brume::ErrorClasses none = brume::classes_by_depth(clear, flat(2, 0.0f));
  EXPECT_EQ(none.pixels, (std::vector<std::size_t>{ 0, 0, 0 }));
  EXPECT_EQ(brume::classes_by_outline(clear, flat(2, 0.0f)).pixels, (std::vector<std::size_t>{ 0, 0 }));
}

TEST(ErrorClasses, tell_where_an_error_lies)
{
  const brume::Study study = sample::study();
  const brume::StudyPoint& octave = study.points[3]; // too dark by half where it is thick
  EXPECT_NEAR(octave.by_depth[2].mean_shift, -0.25, 1e-6);
  EXPECT_NEAR(octave.by_depth[0].mean_shift, 0.0, 1e-6);
  EXPECT_NEAR(octave.by_depth[2].rms, 0.25, 1e-6);
  EXPECT_NEAR(brume::share_of_class(octave.by_depth, study.depths, 2), 1.0, 1e-6);
}

TEST(Study, marks_fronts_and_what_a_knob_alone_does)
{
  const brume::Study study = sample::study();
  std::vector<std::string> front;
  for (const brume::StudyPoint* point : brume::front_of(study))
  {
    front.push_back(point->setting);
  }
  EXPECT_EQ(front, (std::vector<std::string>{ "4 voxels", "1 voxel", "1/4 voxel" }));
  EXPECT_NEAR(study.points[0].own->rms, 0.039, 1e-6);
  EXPECT_FALSE(study.points[2].own) << "the finest is the measure";
  EXPECT_FALSE(study.points[3].own) << "octaves have no finest";
  EXPECT_EQ(brume::cheapest_within(study, 0.05), &study.points[0]);
  EXPECT_EQ(brume::cheapest_within(study, 0.012), &study.points[1]);
  EXPECT_EQ(brume::cheapest_within(study, 0.012, &study.points[1]), &study.points[2]);
  EXPECT_EQ(brume::cheapest_within(study, 1e-9), nullptr);
}

TEST(StudyWords, price_of_halving)
{
  EXPECT_DOUBLE_EQ(brume::price_of_halving(1.0, 0.4, 4.0, 0.2), 4.0);
  EXPECT_NEAR(brume::price_of_halving(1.0, 0.4, 16.0, 0.1), 4.0, 1e-12);
  EXPECT_EQ(brume::price_of_halving(1.0, 0.4, 1.0, 0.2), 0.0);
  EXPECT_EQ(brume::price_of_halving(1.0, 0.2, 2.0, 0.4), 0.0);
  EXPECT_EQ(brume::price_of_halving(1.0, 0.2, 2.0, 0.0), 0.0);
  EXPECT_EQ(brume::price_of_halving(1.0, infinity, 2.0, 0.1), 0.0);
}

std::string all_words(const brume::Study& study)
{
  std::string text;
  for (const std::string& words : brume::study_words(study))
  {
    text += words + "\n";
  }
  return text;
}

TEST(StudyWords, come_from_the_figures)
{
  const std::string words = all_words(sample::study());
  // 0.04 → 0.01 → 0.001 for 0.1 → 0.3 → 1.2 s.
  EXPECT_TRUE(contains(words, "The last halving of the error cost 1.5 times the time: step 1 voxel (0.3 s, "
                              "RMS error 2.55/255) against step 1/4 voxel (1.2 s, RMS error 0.255/255), 10 "
                              "times less error for 4 times the time."))
    << words;
  EXPECT_TRUE(contains(words, "octaves 1 is off by 36.8/255 RMS in 0.5 s: too dark by 50 % in thick cores"))
    << words;
  EXPECT_TRUE(contains(words, "step 4 voxels by itself is off by 9.9")) << words;
  EXPECT_FALSE(contains(words, "too bright by 50 %"));
}

TEST(StudyWords, follow_other_figures)
{
  brume::Study study = sample::study();
  brume::StudyPoint& octave = study.points[3];
  for (float& value : octave.picture.rgb)
  {
    value = 0.5f; // right everywhere
  }
  brume::measure_point(octave, study);
  std::string words = all_words(study);
  EXPECT_FALSE(contains(words, "too dark by 50 %")) << words;
  // A front on which nothing is halved says so.
  study = sample::study();
  study.points[1].on_front = study.points[2].on_front = false;
  study.points[3].on_front = true;
  study.points[3].errors.rms = 0.03;
  EXPECT_TRUE(contains(all_words(study), "No more time halves the error here")) << all_words(study);
}

TEST(StudyWords, judge_promises)
{
  brume::Study study = sample::study();
  study.points[1].asked_tolerance = 0.05;
  EXPECT_TRUE(contains(all_words(study),
    "step 1 voxel: 100 % of the pixels are within 0.05 of white, which keeps it; it took 3 times as long as "
    "the cheapest other setting that keeps it, step 4 voxels (0.1 s)"))
    << all_words(study);
  study.points[1].asked_tolerance = 0.001;
  EXPECT_TRUE(contains(all_words(study), "misses it")) << all_words(study);
  study.points[1].asked_seconds = 0.25;
  EXPECT_TRUE(contains(all_words(study), "it took 0.3 s, 120 % of what it was given")) << all_words(study);
}

TEST(StudyReport, is_well_formed_and_needs_nothing_else)
{
  brume::Study study = sample::study();
  study.points[4].left_out = { "fog" };
  const brume::Bitmap chart{ 2, 2, std::vector<unsigned char>(12, 200) };
  const std::string page = brume::to_html(study, &chart);
  EXPECT_EQ(html::fault_of(page), "");
  EXPECT_FALSE(contains(page, "http"));
  EXPECT_FALSE(contains(page, "{{"));
  for (const char* part : { "what accuracy costs in time", "sample:cloud", "4 voxels", "CPU 1 voxel",
         "The last halving of the error cost", "10\u00A0times less error", "too dark by 50\u00A0%", "without fog",
         "brume cost sample:cloud --output cost" })
  {
    EXPECT_TRUE(contains(page, part)) << part;
  }
  EXPECT_FALSE(contains(brume::to_html(study, nullptr), "Each mark is a setting"));
}

TEST(StudyReport, escapes_every_text_and_takes_an_empty_study)
{
  brume::Study study = sample::study();
  const std::string evil = "<script>alert('x')</script>\"&\xff";
  study.scene.input = study.command_line = study.date = study.truth.truth.method = evil;
  for (brume::StudyKnob& knob : study.knobs)
  {
    knob.title = knob.what = evil;
  }
  for (brume::StudyPoint& point : study.points)
  {
    point.setting = evil;
  }
  study.points[4].skipped = evil;
  const std::string page = brume::to_html(study, nullptr);
  EXPECT_EQ(html::fault_of(page), "");
  EXPECT_FALSE(contains(page, "alert('"));
  EXPECT_EQ(html::fault_of(brume::to_html({}, nullptr)), "");
}

std::vector<std::string> fields_of(const std::string& line)
{
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line)
  {
    quoted = c == '"' ? !quoted : quoted;
    if (c == ',' && !quoted)
    {
      fields.emplace_back();
    }
    else
    {
      fields.back() += c;
    }
  }
  return fields;
}

TEST(StudyCsv, has_a_line_a_point)
{
  brume::Study study = sample::study();
  study.points[4].skipped = "no display: \"none\", at all";
  std::istringstream csv(brume::to_csv(study));
  std::string line;
  std::getline(csv, line);
  const std::vector<std::string> names = fields_of(line);
  std::vector<std::vector<std::string>> rows;
  while (std::getline(csv, line))
  {
    rows.push_back(fields_of(line));
    EXPECT_EQ(rows.back().size(), names.size());
  }
  ASSERT_EQ(rows.size(), study.points.size());
  const auto column = [&](const char* name)
  { return std::find(names.begin(), names.end(), name) - names.begin(); };
  EXPECT_EQ(rows[0][column("setting")], "4 voxels");
  EXPECT_DOUBLE_EQ(std::stod(rows[0][column("seconds")]), 0.1);
  EXPECT_NEAR(std::stod(rows[1][column("rms")]), 0.01, 1e-6);
  EXPECT_EQ(rows[1][column("front")], "1");
  EXPECT_EQ(rows[3][column("front")], "0");
  EXPECT_EQ(rows[4][column("skipped")], "\"no display: \"\"none\"\", at all\"");
  EXPECT_EQ(rows[4][column("rms")], "");
}

TEST(StudyJson, holds_the_figures)
{
  brume::Study study = sample::study();
  study.points[1].errors.measured.largest = infinity;
  study.scene.input = "a\xff\"b";
  const json parsed = json::parse(brume::to_json(study));
  EXPECT_EQ(parsed["format"], "brume-cost");
  EXPECT_EQ(parsed["version"], 1);
  EXPECT_EQ(parsed["scene"]["input"], "a\xEF\xBF\xBD\"b");
  ASSERT_EQ(parsed["points"].size(), study.points.size());
  EXPECT_EQ(parsed["points"][0]["seconds"]["median"], 0.1);
  EXPECT_EQ(parsed["points"][0]["settings"]["step_in_voxels"], 4);
  EXPECT_EQ(parsed["points"][0]["front"], true);
  EXPECT_EQ(parsed["points"][1]["errors"]["largest"], nullptr);
  EXPECT_EQ(parsed["points"][2]["own_errors"], nullptr);
  EXPECT_EQ(parsed["points"][0]["errors"]["within"][0]["tolerance"], 0.05);
  EXPECT_EQ(parsed["truth"]["kind"], "quadrature");
  EXPECT_EQ(parsed["truth"]["samples_per_pixel"], nullptr);
  EXPECT_EQ(parsed["depths"][2]["class"], "thick cores");
  EXPECT_EQ(parsed["words"].size(), brume::study_words(study).size());
  study.points[0].settings = "nonsense";
  EXPECT_THROW(brume::to_json(study), std::invalid_argument);
}

}
