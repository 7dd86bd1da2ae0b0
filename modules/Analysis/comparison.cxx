#include "comparison.h"

namespace brume
{

std::string left_out_words(const ComparisonEntry& entry)
{
  std::string words;
  for (const std::string& name : entry.left_out)
  {
    words += (words.empty() ? "no " : ", no ") + name;
  }
  return words;
}

const ComparisonEntry* find_drawn(const Comparison& comparison, const std::string& mapper)
{
  for (const ComparisonEntry& entry : comparison.entries)
  {
    if (entry.mapper == mapper && entry.skipped.empty())
    {
      return &entry;
    }
  }
  return nullptr;
}

const ComparisonEntry* subject_of(const Comparison& comparison)
{
  if (const ComparisonEntry* subject = find_drawn(comparison, comparison.subject_mapper))
  {
    return subject;
  }
  for (const ComparisonEntry& entry : comparison.entries)
  {
    if (entry.skipped.empty())
    {
      return &entry;
    }
  }
  return nullptr;
}

}
