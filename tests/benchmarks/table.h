// The rows of the table: what is measured, what is asked of it, and how it is told.
#pragma once

#include <nlohmann/json.hpp>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace benchmarks
{

/// A row that cannot be measured here, and why.
struct Skipped : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// One repetition of a row: a time, what it is held against, and the figure made of the two. Rows
/// that are no times leave the seconds 0.
struct Repetition
{
  double seconds = 0.0; ///< Brume
  double other = 0.0;   ///< the stock mapper, or whatever the row compares with
  double figure = 0.0;
};

struct Row
{
  // What it is.
  int number = 0;
  std::string name; ///< for --filter: words joined by dashes
  std::string what; ///< one line
  std::string unit; ///< of the figure: "×", "%", "bytes a voxel"
  double target = 0.0;
  bool at_least = true; ///< the figure is to be at least the target, else at most
  std::string other;    ///< what the second time is of

  // How it is measured.
  int repetitions = 1;
  /// Once, before the repetitions. Throws Skipped.
  std::function<void(Row&)> prepare;
  std::function<Repetition()> repeat;

  // What came out.
  std::vector<Repetition> measured;
  std::string skipped; ///< why there is no figure
  bool failed = false; ///< an error rather than a reason
  std::vector<std::string> remarks;
  void remark(const std::string& text) { this->remarks.push_back(text); }

  bool has_figure() const { return !this->measured.empty() && this->skipped.empty(); }
  double figure() const; ///< median of the repetitions
  bool met() const;
};

double median(std::vector<double> values);

/// The rows as a table in Markdown, aligned so that a terminal shows it well, and below it each
/// row's remarks.
std::string to_text(const std::vector<Row>& rows);
nlohmann::json to_json(const std::vector<Row>& rows);

}
