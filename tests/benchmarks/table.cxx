#include "table.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace benchmarks
{

namespace
{

template <class Part>
std::vector<double> parts(const Row& row, Part part)
{
  std::vector<double> values;
  for (const Repetition& one : row.measured)
  {
    values.push_back(one.*part);
  }
  return values;
}

/// Three digits.
std::string number(double value)
{
  char text[40];
  std::snprintf(text, sizeof(text), value >= 99.95 ? "%.0f" : "%.3g", value);
  return text;
}

std::string with_unit(double value, const std::string& unit)
{
  return number(value) + (unit == "×" ? "" : " ") + unit;
}

/// Characters that a terminal shows: bytes but for UTF-8's continuations.
std::size_t shown_width(const std::string& text)
{
  return std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; });
}

std::string seconds_of(const Row& row, double Repetition::*part)
{
  const std::vector<double> values = parts(row, part);
  if (values.empty() || !(median(values) > 0.0))
  {
    return "";
  }
  return number(median(values));
}

}

double median(std::vector<double> values)
{
  if (values.empty())
  {
    return 0.0;
  }
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double Row::figure() const
{
  return median(parts(*this, &Repetition::figure));
}

bool Row::met() const
{
  return this->has_figure() &&
         (this->at_least ? this->figure() >= this->target : this->figure() <= this->target);
}

std::string to_text(const std::vector<Row>& rows)
{
  std::vector<std::array<std::string, 8>> cells;
  cells.push_back({ "", "what", "figure", "target", "met", "spread", "Brume, s", "other, s" });
  for (const Row& row : rows)
  {
    std::array<std::string, 8> line;
    line[0] = std::to_string(row.number);
    line[1] = row.what;
    line[3] = (row.at_least ? "≥ " : "≤ ") + with_unit(row.target, row.unit);
    if (row.has_figure())
    {
      const std::vector<double> figures = parts(row, &Repetition::figure);
      line[2] = with_unit(row.figure(), row.unit);
      line[4] = row.met() ? "yes" : "no";
      if (figures.size() > 1)
      {
        line[5] = number(*std::min_element(figures.begin(), figures.end())) + "–" +
                  number(*std::max_element(figures.begin(), figures.end()));
      }
      line[6] = seconds_of(row, &Repetition::seconds);
      line[7] = seconds_of(row, &Repetition::other);
    }
    else
    {
      line[2] = row.failed ? "failed" : "none";
    }
    cells.push_back(line);
  }
  std::array<std::size_t, 8> widths{};
  for (const auto& line : cells)
  {
    for (std::size_t i = 0; i < line.size(); ++i)
    {
      widths[i] = std::max(widths[i], shown_width(line[i]));
    }
  }
  std::string text;
  for (std::size_t l = 0; l < cells.size(); ++l)
  {
    for (std::size_t i = 0; i < widths.size(); ++i)
    {
      text += "| " + cells[l][i] + std::string(widths[i] - shown_width(cells[l][i]) + 1, ' ');
    }
    text += "|\n";
    if (l == 0)
    {
      for (std::size_t width : widths)
      {
        text += "|" + std::string(width + 2, '-');
      }
      text += "|\n";
    }
  }
  text += '\n';
  for (const Row& row : rows)
  {
    std::string line;
    if (!row.other.empty() && row.has_figure())
    {
      line += " other: " + row.other + ".";
    }
    if (!row.skipped.empty())
    {
      line += (row.failed ? " failed: " : " no figure: ") + row.skipped + ".";
    }
    for (const std::string& remark : row.remarks)
    {
      line += " " + remark + ".";
    }
    if (!line.empty())
    {
      text += "- **" + std::to_string(row.number) + "**" + line + '\n';
    }
  }
  return text;
}

nlohmann::json to_json(const std::vector<Row>& rows)
{
  nlohmann::json list = nlohmann::json::array();
  for (const Row& row : rows)
  {
    nlohmann::json one{ { "number", row.number },
      { "name", row.name },
      { "what", row.what },
      { "unit", row.unit },
      { "target", row.target },
      { "target_is", row.at_least ? "least" : "most" },
      { "remarks", row.remarks } };
    if (row.has_figure())
    {
      one["figure"] = row.figure();
      one["met"] = row.met();
      one["other"] = row.other;
      for (const Repetition& repetition : row.measured)
      {
        one["repetitions"].push_back({ { "figure", repetition.figure },
          { "seconds", repetition.seconds },
          { "other_seconds", repetition.other } });
      }
    }
    else
    {
      one[row.failed ? "failed" : "skipped"] = row.skipped;
    }
    list.push_back(one);
  }
  return list;
}

}
