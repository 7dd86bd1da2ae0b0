// What is written from a comparison: headline, compare.json, the terminal's table, report.html.
#include "Analysis/comparison_json.h"
#include "Analysis/headline.h"
#include "Analysis/report_html.h"
#include "Analysis/text_table.h"
#include "html_check.h"
#include "sample_comparison.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <regex>
#include <stdexcept>

namespace
{

using html::fault_of;
using html::without_pictures;
using nlohmann::json;

constexpr double infinity = std::numeric_limits<double>::infinity();

bool contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

std::size_t count(const std::string& text, const std::string& part)
{
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size())
  {
    ++found;
  }
  return found;
}

/// Two mappers with the given medians and mean errors (in 1/255), each run within 3 % of its median.
brume::Comparison duel(double seconds, double error, double stock_seconds, double stock_error)
{
  const auto entry = [](const char* mapper, const char* title, double median, double mean) {
    brume::ComparisonEntry e;
    e.mapper = mapper;
    e.title = title;
    e.picture = { 1, 1, { 0, 0, 0 } };
    e.timing = { median, 0.97 * median, 1.03 * median, 5, 0, 0 };
    e.against_truth.values = 3;
    e.against_truth.mean_absolute = mean / 255.0;
    e.against_truth.largest = 4.0 * mean / 255.0;
    return e;
  };
  brume::Comparison c;
  c.entries = { entry("raymarch", "Brume", seconds, error),
    entry("vtk-fixed-point", "Stock", stock_seconds, stock_error) };
  return c;
}

TEST(Headline, faster_and_closer)
{
  EXPECT_EQ(brume::headline(duel(0.08, 0.21, 0.152, 0.63)),
    "Brume drew this in 0.08 s, 1.9 times as fast as Stock (0.152 s), with a third of its mean "
    "error (0.21/255 against 0.63/255).");
}

TEST(Headline, slower_but_closer)
{
  EXPECT_EQ(brume::headline(duel(0.3, 0.1, 0.15, 0.2)),
    "Brume drew this in 0.3 s, 2 times as long as Stock (0.15 s), but with half of its mean error "
    "(0.1/255 against 0.2/255).");
}

TEST(Headline, faster_but_farther_off)
{
  EXPECT_EQ(brume::headline(duel(0.1, 0.42, 1.7, 0.2)),
    "Brume drew this in 0.1 s, 17 times as fast as Stock (1.7 s), but with 2.1 times its mean error "
    "(0.42/255 against 0.2/255).");
}

TEST(Headline, slower_and_farther_off_is_not_softened)
{
  EXPECT_EQ(brume::headline(duel(0.3, 0.6, 0.1, 0.2)),
    "Brume drew this in 0.3 s, 3 times as long as Stock (0.1 s), with 3 times its mean error "
    "(0.6/255 against 0.2/255).");
}

TEST(Headline, ties)
{
  EXPECT_EQ(brume::headline(duel(0.102, 0.21, 0.1, 0.205)),
    "Brume drew this in 0.102 s, about as fast as Stock (0.1 s), with the same mean error "
    "(0.21/255 against 0.205/255).");
  brume::Comparison noisy = duel(0.10, 0.1, 0.13, 0.2);
  EXPECT_TRUE(contains(brume::headline(noisy), "1.3 times as fast"));
  noisy.entries[0].timing.max = 0.2; // one slow run of ours alone proves nothing
  EXPECT_TRUE(contains(brume::headline(noisy), "1.3 times as fast"));
  noisy.entries[1].timing.min = 0.09;
  EXPECT_TRUE(contains(brume::headline(noisy), "about as fast as"));
}

TEST(Headline, gives_no_ratio_that_the_truth_cannot_carry)
{
  brume::Comparison c = duel(0.1, 0.01, 0.2, 0.3);
  c.truth.remaining_mean = 0.02 / 255;
  EXPECT_TRUE(contains(brume::headline(c), "too small for the truth, itself uncertain by 0.02/255"));
  c.truth.remaining_mean = 0.5 / 255;
  EXPECT_TRUE(contains(brume::headline(c), "cannot tell apart"));
  EXPECT_FALSE(contains(brume::headline(c), "of its mean error"));
  c = duel(0.1, 0.3, 0.2, 0.01);
  c.truth.remaining_mean = 0.02 / 255;
  EXPECT_TRUE(contains(brume::headline(c), "but with a larger mean error (0.3/255 against 0.01/255)"));
  c = duel(0.1, 0.0, 0.2, 0.0);
  EXPECT_TRUE(contains(brume::headline(c), "no measurable error in either picture"));
}

TEST(Headline, names_infinite_errors)
{
  brume::Comparison c = duel(0.1, 0.1, 0.2, 0.3);
  c.entries[0].against_truth.mean_absolute = infinity;
  c.entries[0].against_truth.non_finite_test = 2;
  EXPECT_EQ(brume::headline(c),
    "Brume drew this in 0.1 s, 2 times as fast as Stock (0.2 s). The picture of Brume holds 2 values "
    "that are not finite numbers, so its error is infinite.");
}

TEST(Headline, without_a_rival)
{
  brume::Comparison c = duel(0.1, 0.1, 0.2, 0.3);
  c.entries[1].skipped = "no display";
  EXPECT_EQ(brume::headline(c),
    "Brume drew this in 0.1 s with a mean error of 0.1/255 and a largest of 0.4/255.");
  c.entries[0].skipped = "no data";
  EXPECT_EQ(brume::headline(c), "No mapper drew this scene.");
  c.entries.clear();
  EXPECT_EQ(brume::headline(c), "No mapper drew this scene.");
}

TEST(ComparisonJson, holds_the_figures)
{
  const brume::Comparison c = sample::comparison(40, 30);
  const json parsed = json::parse(brume::to_json(c));
  EXPECT_EQ(parsed["format"], "brume-compare");
  EXPECT_EQ(parsed["version"], 1);
  EXPECT_EQ(parsed["scene"]["input"], "sample:head-ct");
  EXPECT_EQ(parsed["scene"]["resolution"], (json{ 40, 30 }));
  EXPECT_EQ(parsed["scene"]["camera"]["projection"], "perspective");
  EXPECT_EQ(parsed["scene"]["matched"][0]["name"], "sample distance");
  EXPECT_EQ(parsed["command_line"], c.command_line);
  EXPECT_EQ(parsed["headline"], brume::headline(c));
  ASSERT_EQ(parsed["entries"].size(), 3u);
  const json& entry = parsed["entries"][0];
  EXPECT_EQ(entry["mapper"], "raymarch");
  EXPECT_EQ(entry["skipped"], nullptr);
  EXPECT_EQ(entry["seconds"]["median"], 0.0812);
  EXPECT_EQ(entry["seconds"]["repetitions"], 5);
  const brume::ImageErrors& errors = c.entries[0].against_truth;
  EXPECT_EQ(entry["errors_against_truth"]["mean_shift"], errors.mean_shift);
  EXPECT_EQ(entry["errors_against_truth"]["mean_absolute"], errors.mean_absolute);
  EXPECT_EQ(entry["errors_against_truth"]["rms"], errors.rms);
  EXPECT_EQ(entry["errors_against_truth"]["percentile_99_9"], errors.percentile_999);
  EXPECT_EQ(entry["errors_against_truth"]["largest"], errors.largest);
  EXPECT_EQ(entry["errors_against_truth"]["values"], 3600);
  EXPECT_EQ(entry["errors_against_reference"]["rms"], c.entries[0].against_reference->rms);
  EXPECT_EQ(parsed["entries"][1]["errors_against_reference"], nullptr);
  EXPECT_EQ(entry["contributions"][1]["name"], "step");
  EXPECT_EQ(entry["statistics"]["samples"], 41234567);
  EXPECT_EQ(parsed["truth"]["remaining_largest"], 0.00011);
  EXPECT_EQ(parsed["machine"]["threads"], 2);
}

TEST(ComparisonJson, says_null_and_why_for_what_is_not_finite)
{
  brume::Comparison c = sample::comparison(40, 30);
  c.entries[0].picture.rgb[0] = static_cast<float>(infinity);
  c.entries[0].against_truth = brume::measure(c.entries[0].picture, c.truth.picture);
  c.entries[0].timing.warm_up = std::nan("");
  c.truth.remaining_mean = infinity;
  const std::string text = brume::to_json(c);
  EXPECT_FALSE(std::regex_search(text, std::regex(R"(:\s*-?(nan|inf))", std::regex::icase)));
  const json parsed = json::parse(text);
  const json& errors = parsed["entries"][0]["errors_against_truth"];
  EXPECT_EQ(errors["mean_absolute"], nullptr);
  EXPECT_EQ(errors["largest"], nullptr);
  EXPECT_TRUE(errors["percentile_99_9"].is_number());
  EXPECT_EQ(errors["non_finite_values"], 1);
  EXPECT_TRUE(errors["not_finite"].is_string());
  EXPECT_FALSE(parsed["entries"][1]["errors_against_truth"].contains("not_finite"));
  EXPECT_EQ(parsed["entries"][0]["seconds"]["warm_up"], nullptr);
  EXPECT_EQ(parsed["truth"]["remaining_mean"], nullptr);
}

TEST(ComparisonJson, skipped_entries_hold_the_reason_alone)
{
  brume::Comparison c = sample::comparison(40, 30);
  c.entries[2].skipped = "no display: \"run it under xvfb-run\"";
  const json entry = json::parse(brume::to_json(c))["entries"][2];
  EXPECT_EQ(entry["skipped"], c.entries[2].skipped);
  EXPECT_FALSE(entry.contains("seconds"));
}

TEST(ComparisonJson, takes_any_bytes_for_a_name)
{
  brume::Comparison c = sample::comparison(40, 30);
  c.scene.input = "a\xff\"b\\\x01.nii";
  EXPECT_EQ(json::parse(brume::to_json(c))["scene"]["input"], "a\xEF\xBF\xBD\"b\\ .nii");
}

TEST(ComparisonJson, refuses_statistics_that_are_no_object)
{
  brume::Comparison c = sample::comparison(40, 30);
  for (const char* bad : { "{", "[1]", "3", "nonsense" })
  {
    c.entries[0].statistics = bad;
    EXPECT_THROW(brume::to_json(c), std::invalid_argument) << bad;
    EXPECT_THROW(brume::to_html(c), std::invalid_argument) << bad;
  }
  c.entries[0].statistics.clear();
  EXPECT_EQ(json::parse(brume::to_json(c))["entries"][0]["statistics"], json::object());
}

TEST(TextTable, is_aligned)
{
  brume::Comparison c = duel(0.08, 0.21, 0.152, 0.63);
  c.scene.input = "Köpfe.nii";
  c.entries.push_back(c.entries[1]);
  c.entries[2].mapper = "vtk-gpu";
  c.entries[2].skipped = "no display";
  EXPECT_EQ(brume::to_text_table({ c, duel(12.3, 1000, 1.5, 0.00001) }),
    "input      mapper           seconds (min–max)      speed   mean  rms  p99.9    max\n"
    "Köpfe.nii  raymarch         0.08 (0.0776–0.0824)    1.9×   0.21    0      0   0.84\n"
    "Köpfe.nii  vtk-fixed-point  0.152 (0.147–0.157)       1×   0.63    0      0   2.52\n"
    "Köpfe.nii  vtk-gpu          skipped: no display\n"
    "           raymarch         12.3 (11.9–12.7)      0.122×   1000    0      0   4000\n"
    "           vtk-fixed-point  1.5 (1.46–1.54)           1×  1e-05    0      0  4e-05\n"
    "errors against the truth, in 1/255 of white, linear RGB\n");
  EXPECT_EQ(brume::to_text_table({}), "");
}

TEST(TextTable, says_inf_and_dash)
{
  brume::Comparison c = duel(0.08, infinity, 0.152, 0.63);
  c.entries[1].against_truth = {};
  c.reference_mapper = "nobody";
  const std::string table = brume::to_text_table({ c });
  EXPECT_TRUE(std::regex_search(table, std::regex("raymarch +0.08 .*  -   inf    0      0  inf\n")))
    << table;
  EXPECT_TRUE(std::regex_search(table, std::regex("vtk-fixed-point .* - +- +- +- +-\n"))) << table;
}

TEST(TagChecker, sees_faults)
{
  EXPECT_EQ(fault_of("<p>a<br>b</p>"), "");
  for (const char* bad : { "<p>", "<p><b></p></b>", "<p a=b></p>", "<img src=\"x\">", "a < b",
         "a & b", "<p id=\"a\"></p><p id=\"a\"></p>", "<p a=\"<\"></p>" })
  {
    EXPECT_NE(fault_of(bad), "") << bad;
  }
}

TEST(ReportHtml, is_well_formed_and_needs_nothing_else)
{
  const std::string page = brume::to_html(sample::comparison(40, 30));
  EXPECT_EQ(fault_of(page), "");
  EXPECT_EQ(page.rfind("<!DOCTYPE html>", 0), 0u);
  EXPECT_FALSE(contains(page, "http")) << "no external resource";
  EXPECT_FALSE(contains(page, "url("));
  EXPECT_FALSE(contains(page, "@import"));
  EXPECT_FALSE(contains(page, "{{"));
  EXPECT_TRUE(contains(page, "prefers-color-scheme: dark"));
  EXPECT_EQ(count(page, "src=\"data:image/png;base64,iVBORw0KGgo"), 8u)
    << "3 pictures, the truth, 3 differences, the faintest again at its own gain";
}

TEST(ReportHtml, says_what_was_measured)
{
  const brume::Comparison c = sample::comparison(40, 30);
  const std::string page = brume::to_html(c);
  for (const char* part : { "sample:head-ct", "1.9\u00A0times as fast", "ct-soft-tissue",
         "0.149–0.163", "fixed point and 8-bit tables", "rays begin a fraction of a step later.",
         "multiple scattering", "no medium: the property holds no albedo", "image sample distance",
         "Double-precision quadrature", "Sapphire Rapids",
         "brume compare sample:head-ct --output head --resolution 512,512" })
  {
    EXPECT_TRUE(contains(page, part)) << part;
  }
}

TEST(ReportHtml, escapes_every_text)
{
  const std::string evil = "<script>alert('x')</script>\"&\xff";
  const std::string safe = "&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;&quot;&amp;\xEF\xBF\xBD";
  brume::Comparison c = sample::comparison(40, 30);
  c.scene.input = c.scene.unit = c.scene.preset = c.scene.interpolation = evil;
  c.scene.lights = { evil };
  c.scene.matched = { { evil, evil, evil } };
  for (brume::ComparisonEntry& entry : c.entries)
  {
    entry.mapper += evil;
    entry.title = entry.class_name = evil;
    for (brume::Contribution& cause : entry.contributions)
    {
      cause.name = cause.explanation = evil;
    }
  }
  c.entries[0].statistics =
    json{ { "effects",
            { { { "name", "<b>1" }, { "reason", "<b>2" }, { "error_bound", "<b>3" } } } } }
      .dump();
  c.entries[2].skipped = evil;
  c.truth.method = c.command_line = c.date = evil;
  c.machine = { evil, 2, evil, evil, evil, evil };
  const std::string page = brume::to_html(c);
  EXPECT_EQ(fault_of(page), "");
  EXPECT_EQ(count(page, "<script>"), 1u) << "our own";
  EXPECT_FALSE(contains(page, "alert('"));
  EXPECT_FALSE(contains(page, "<b>"));
  EXPECT_GT(count(page, safe), 25u);
}

TEST(ReportHtml, of_one_entry_of_skipped_ones_and_of_none)
{
  brume::Comparison c = sample::comparison(40, 30);
  c.entries.resize(1);
  EXPECT_EQ(fault_of(brume::to_html(c)), "");
  c.truth = {};
  c.entries[0].against_truth = {};
  c.entries[0].contributions.clear();
  c.entries[0].statistics.clear();
  const std::string bare = brume::to_html(c);
  EXPECT_EQ(fault_of(bare), "");
  EXPECT_FALSE(contains(bare, "id=\"differences\""));
  EXPECT_FALSE(contains(bare, "id=\"causes\""));
  EXPECT_FALSE(contains(bare, "id=\"effects\""));
  c.entries[0].skipped = "no data in reach";
  const std::string none = brume::to_html(c);
  EXPECT_EQ(fault_of(none), "");
  EXPECT_TRUE(contains(none, "no data in reach"));
  EXPECT_TRUE(contains(none, "No mapper drew this scene."));
  EXPECT_EQ(count(none, "<img id=\"picture"), 0u);
  EXPECT_EQ(fault_of(brume::to_html({})), "");
}

TEST(ReportHtml, shows_infinite_errors_as_such)
{
  brume::Comparison c = sample::comparison(40, 30);
  c.entries[1].picture.rgb[10] = std::nanf("");
  c.entries[1].against_truth = brume::measure(c.entries[1].picture, c.truth.picture);
  const std::string page = brume::to_html(c);
  EXPECT_EQ(fault_of(page), "");
  EXPECT_TRUE(contains(page, "∞"));
  EXPECT_TRUE(contains(page, "class=\"endless\""));
  EXPECT_TRUE(contains(page, "holds 1 value that is not a finite number"));
  EXPECT_TRUE(contains(page, "1 pixel not finite"));
  EXPECT_FALSE(std::regex_search(without_pictures(page), std::regex("[>+ -](nan|inf)[ <]")));
}

}
