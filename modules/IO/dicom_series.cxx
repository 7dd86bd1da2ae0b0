#include "dicom_series.h"

#include "dicom_file.h"
#include "dicom_stack.h"
#include "file_access.h"
#include "header_text.h"
#include "picture_stack.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

namespace brume::io
{

namespace fs = std::filesystem;

namespace
{

constexpr std::size_t MostFiles = 200000;
constexpr int DeepestFolder = 8;

/// Hands out the DICOM files in a folder and those below it, until `take` returns false.
void visit_files(const std::string& folder, const std::function<bool(const std::string&)>& take)
{
  std::error_code error;
  fs::recursive_directory_iterator entry(
    folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
  {
    std::error_code ignored;
    if (entry.depth() >= DeepestFolder)
    {
      entry.disable_recursion_pending();
    }
    if (entry->is_regular_file(ignored) && entry->path().filename() != "DICOMDIR" &&
      looks_like_dicom(entry->path().string()) && !take(entry->path().string()))
    {
      return;
    }
  }
  if (error)
  {
    fail(folder, "cannot be read: " + error.message(), "check its permissions");
  }
}

/// All of them, by name.
std::vector<std::string> files_below(const std::string& folder)
{
  std::vector<std::string> files;
  visit_files(folder,
    [&](const std::string& path)
    {
      files.push_back(path);
      if (files.size() > MostFiles)
      {
        fail(folder, "holds more than " + std::to_string(MostFiles) + " DICOM files",
          "name a folder below it");
      }
      return true;
    });
  std::sort(files.begin(), files.end());
  return files;
}

using Series = std::vector<DicomFile>;

std::string describe(const Series& series)
{
  const DicomFile& first = series.front();
  std::size_t pictures = 0;
  for (const DicomFile& file : series)
  {
    pictures += file.frames.size();
  }
  std::string text;
  for (const std::string& word : { first.modality, first.description })
  {
    text += word.empty() ? "" : word + ", ";
  }
  return text + std::to_string(first.width) + " x " + std::to_string(first.height) + " x " +
    std::to_string(pictures);
}

std::size_t choose(
  const std::string& path, const std::string& wanted, const std::vector<DicomChoice>& choices)
{
  if (wanted.empty() && choices.size() == 1)
  {
    return 0;
  }
  std::size_t number = 0;
  const std::from_chars_result result =
    std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
  const bool is_number = result.ec == std::errc() && result.ptr == wanted.data() + wanted.size();
  std::string list;
  for (std::size_t i = 0; i < choices.size(); ++i)
  {
    if ((!wanted.empty() && choices[i].uid == wanted) || (is_number && number == i + 1))
    {
      return i;
    }
    if (i < 8)
    {
      list += (i ? "; " : "") + std::to_string(i + 1) + ": " + choices[i].text;
    }
  }
  list += choices.size() > 8 ? "; …" : "";
  fail(path,
    (wanted.empty() ? "holds " : "has no series '" + shortened(wanted) + "' among its ") +
      std::to_string(choices.size()) + (choices.size() == 1 ? " series" : " different series"),
    "choose one with --series N (" + list + ")");
}

}

bool has_dicom(const std::string& folder)
{
  bool found = false;
  visit_files(folder,
    [&found](const std::string&)
    {
      found = true;
      return false;
    });
  return found;
}

ScanHeader read_dicom_header(
  const std::string& path, const std::string& wanted, std::vector<DicomChoice>& choices)
{
  const bool folder = fs::is_directory(path);
  const std::vector<std::string> names =
    folder ? files_below(path) : std::vector<std::string>{ path };
  if (names.empty())
  {
    fail(path, "is a folder, and no file in it is DICOM or a picture of a stack",
      "name the folder of one series, or a file");
  }
  std::vector<std::string> messages;
  std::vector<Series> all;
  std::map<std::string, std::size_t> places;
  std::set<std::string> instances;
  std::string first_error;
  std::size_t bad = 0;
  std::size_t twins = 0;
  for (const std::string& name : names)
  {
    try
    {
      DicomFile file = read_dicom_file(name);
      if (!file.instance_uid.empty() && !instances.insert(file.instance_uid).second)
      {
        ++twins;
        continue;
      }
      const auto place = places.emplace(file.series_uid, all.size());
      if (place.second)
      {
        all.emplace_back();
      }
      all[place.first->second].push_back(std::move(file));
    }
    catch (const std::runtime_error& error)
    {
      first_error = bad++ == 0 ? error.what() : first_error;
    }
  }
  if (all.empty())
  {
    throw std::runtime_error(first_error);
  }
  if (bad > 0)
  {
    messages.push_back(std::to_string(bad) + (bad == 1 ? " file is" : " files are") +
      " left out, which cannot be read (" + first_error + ")");
  }
  if (twins > 0)
  {
    messages.push_back(std::to_string(twins) + (twins == 1 ? " file is" : " files are") +
      " there twice; one of each is taken");
  }
  std::stable_sort(all.begin(), all.end(), [](const Series& a, const Series& b)
    { return a.front().series_number < b.front().series_number; });
  choices.clear();
  for (const Series& series : all)
  {
    choices.push_back({ series.front().series_uid, describe(series) });
  }
  ScanHeader header = stack_dicom(path, all[choose(path, wanted, choices)]);
  if (const std::size_t pictures = folder ? count_pictures(path) : 0; pictures > 0)
  {
    messages.push_back(std::to_string(pictures) +
      (pictures == 1 ? " TIFF or PNG picture lies" : " TIFF or PNG pictures lie") +
      " beside the DICOM files and " + (pictures == 1 ? "is" : "are") +
      " passed over: name such a stack by a pattern (NAME%03d.png)");
  }
  header.messages.insert(header.messages.begin(), messages.begin(), messages.end());
  return header;
}

}
