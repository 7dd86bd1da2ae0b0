// hard-cases-page RECORDS PAGE [--machine TEXT]   writes the page
// hard-cases-page RECORDS PAGE --check            tells where the page and the records differ
//
// What other renderers did on the same cases (HardCase::tell) is a group of its own with a column
// each. Where there are no records of it, as under sanitizers and without a display, the check
// leaves it out and says so.
//
// RECORDS is the folder that the tests of label stability write to (BRUME_HARD_CASES), PAGE is
// docs/dev/hard-cases.md. What is checked is what does not depend on the machine: which cases there
// are, in which order, why each is hard and what is promised.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

using Json = nlohmann::ordered_json;

const char* const peers = "Peers"; ///< the group of other renderers

const std::vector<std::string>
  groups = { "Optics", "Rays", "Data", "Media", "Machines", "Invariants", peers };

/// The place of a group on the page; others follow by name.
std::pair<std::size_t, std::string> place(const std::string& group)
{
  const auto known = std::find(groups.begin(), groups.end(), group);
  return { static_cast<std::size_t>(known - groups.begin()), group };
}

using Cases = std::map<std::pair<std::size_t, std::string>, std::vector<Json>>;

Cases read_records(const std::string& folder)
{
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
  {
    if (entry.path().extension() == ".json")
    {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  Cases cases;
  for (const auto& file : files)
  {
    std::ifstream stream(file);
    for (const Json& one : Json::parse(stream))
    {
      auto& group = cases[place(one.at("group"))];
      for (const Json& other : group)
      {
        if (one.contains("name") && other.value("name", "") == one.at("name"))
        {
          throw std::runtime_error(file.string() + ": another program has a case \"" +
                                   one.at("name").get<std::string>() +
                                   "\": give one of them another name");
        }
      }
      group.push_back(one);
    }
  }
  return cases;
}

/// A bar would end a table's cell.
std::string cell(const std::string& text)
{
  std::string out;
  for (const char c : text)
  {
    out += c == '|' ? "\\|" : std::string(1, c);
  }
  return out;
}

std::string figure(const Json& number)
{
  if (number.is_null())
  {
    return "not finite";
  }
  char text[32];
  const double value = number.get<double>();
  std::snprintf(text, sizeof text, value >= 100.0 && value < 1e4 ? "%.0f" : "%.2g", value);
  return text;
}

std::string measured(const Json& one)
{
  std::string out;
  for (const Json& each : one.at("measured"))
  {
    out += out.empty() ? "" : "; ";
    const std::string unit = each.at("unit");
    const auto times = [](const Json& n) { return std::to_string(std::lround(n.get<double>())); };
    out +=
      each.at("counted").get<bool>()
        ? unit + ": " + times(each.at("value")) + " of " + times(each.at("bound"))
        : figure(each.at("value")) + " " + unit + " (at most " + figure(each.at("bound")) + ")";
  }
  return out;
}

std::string measured_by(const Json& one)
{
  std::string by;
  for (const Json& each : one.at("by"))
  {
    by += (by.empty() ? "" : ", ") + each.get<std::string>();
  }
  return by.empty() ? measured(one) : measured(one) + "; by " + by;
}

/// What another renderer did in a case.
std::string told(const Json& one, const std::string& by)
{
  std::string out;
  for (const Json& other : one.value("others", Json::array()))
  {
    if (other.at("by") == by)
    {
      for (const Json& each : other.at("told"))
      {
        out += (out.empty() ? "" : "; ") + figure(each.at("value")) + " " +
               each.at("unit").get<std::string>();
      }
      const std::string words = other.at("words");
      out += words.empty() ? "" : (out.empty() ? "" : ": ") + words;
    }
  }
  return out;
}

/// The other renderers of a group, in the order of their first figures.
std::vector<std::string> others_of(const std::vector<Json>& rows)
{
  std::vector<std::string> names;
  for (const Json& one : rows)
  {
    for (const Json& other : one.value("others", Json::array()))
    {
      const std::string by = other.at("by");
      if (std::find(names.begin(), names.end(), by) == names.end())
      {
        names.push_back(by);
      }
    }
  }
  return names;
}

/// What a case's row begins with, whatever was measured.
std::string promised(const Json& one)
{
  const auto text = [&](const char* key) { return cell(one.at(key).get<std::string>()); };
  return "| " + text("name") + " | " + text("why") + " | " + text("promise") + " |";
}

void write_page(std::ostream& out, const Cases& cases, const std::string& machine)
{
  std::size_t count = 0;
  for (const auto& [group, rows] : cases)
  {
    count += group.second == peers ? 0 : rows.size();
  }
  out
    << "# Hard cases\n\n"
       "Where renderers of volumes commonly fail, what Brume promises there, and what was "
       "measured. "
       "`scripts/hard-cases` writes this\npage from the results of the tests of label `stability`; "
       "a case whose figure exceeds its bound fails its test.\n\n"
    << count << " cases.";
  if (!machine.empty())
  {
    out << " Figures of " << machine << "; other processors differ in the last digits.";
  }
  out << " Where several were run, the worst is shown.\n";
  for (const auto& [group, rows] : cases)
  {
    out << "\n## " << group.second << '\n';
    for (const Json& one : rows)
    {
      if (one.contains("introduction"))
      {
        out << '\n' << one.at("introduction").get<std::string>() << '\n';
      }
    }
    const std::vector<std::string> others = others_of(rows);
    out << "\n| case | why it is hard | "
        << (others.empty() ? "promised | measured |" : "what is measured | Brume |");
    for (const std::string& other : others)
    {
      out << ' ' << other << " |";
    }
    out << "\n|";
    for (std::size_t column = 0; column < 4 + others.size(); ++column)
    {
      out << "---|";
    }
    out << '\n';
    for (const Json& one : rows)
    {
      if (!one.contains("name"))
      {
        continue;
      }
      out << promised(one) << ' ' << cell(others.empty() ? measured_by(one) : measured(one))
          << " |";
      for (const std::string& other : others)
      {
        out << ' ' << cell(told(one, other)) << " |";
      }
      out << '\n';
    }
  }
}

/// The first three cells of a page's rows, with the headings above them; of the peers, if wanted.
std::vector<std::string> promises_of(std::istream& page, bool with_peers)
{
  std::vector<std::string> out;
  std::string line;
  bool in_group = false;
  while (std::getline(page, line))
  {
    if (line.rfind("## ", 0) == 0)
    {
      in_group = with_peers || line != std::string("## ") + peers;
      if (in_group)
      {
        out.push_back(line);
      }
    }
    else if (in_group && line.rfind("| ", 0) == 0 && line.rfind("| case |", 0) != 0)
    {
      std::size_t end = 0;
      for (int cells = 0; cells < 3 && end != std::string::npos; ++cells)
      {
        end = line.find(" | ", end + 1);
      }
      out.push_back(end == std::string::npos ? line : line.substr(0, end + 2));
    }
  }
  return out;
}

int check_page(const std::string& page, const Cases& cases)
{
  std::ifstream stream(page);
  if (!stream)
  {
    std::cerr << page << ": cannot be read: write it with scripts/hard-cases\n";
    return 1;
  }
  const bool with_peers = cases.count(place(peers)) > 0;
  if (!with_peers)
  {
    std::cout << "not checked, as there are no records: " << peers << '\n';
  }
  const std::vector<std::string> there = promises_of(stream, with_peers);
  std::stringstream fresh;
  write_page(fresh, cases, "");
  const std::vector<std::string> wanted = promises_of(fresh, with_peers);
  int differences = 0;
  const auto tell = [&](const std::vector<std::string>& some,
                      const std::vector<std::string>& others,
                      const char* what)
  {
    for (const std::string& line : some)
    {
      if (std::find(others.begin(), others.end(), line) == others.end())
      {
        std::cerr << what << line << '\n';
        ++differences;
      }
    }
  };
  tell(wanted, there, "not on the page: ");
  tell(there, wanted, "on the page alone: ");
  if (differences == 0 && there != wanted)
  {
    std::cerr << "the page has another order, or a case twice\n";
    ++differences;
  }
  if (differences)
  {
    std::cerr << page << ": is not what the tests say: write it anew with scripts/hard-cases\n";
  }
  return differences ? 1 : 0;
}

}

int main(int argc, char** argv)
{
  const std::vector<std::string> words(argv + 1, argv + argc);
  const bool check = words.size() == 3 && words[2] == "--check";
  const bool write = words.size() == 2 || (words.size() == 4 && words[2] == "--machine");
  if (!check && !write)
  {
    std::cerr
      << "hard-cases-page: usage: hard-cases-page RECORDS PAGE [--check | --machine TEXT]\n";
    return 2;
  }
  try
  {
    const Cases cases = read_records(words[0]);
    if (cases.empty())
    {
      throw std::runtime_error(words[0] + ": holds no records: run the tests of label stability");
    }
    if (check)
    {
      return check_page(words[1], cases);
    }
    std::ofstream out(words[1]);
    write_page(out, cases, write && words.size() == 4 ? words[3] : "");
    if (!out.flush())
    {
      throw std::runtime_error(words[1] + ": cannot be written");
    }
  }
  catch (const std::exception& error)
  {
    std::cerr << "hard-cases-page: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
