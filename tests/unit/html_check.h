// Whether a page is well formed.
#pragma once

#include <regex>
#include <set>
#include <string>
#include <vector>

namespace html
{

/// The page with its data URIs emptied: std::regex recurses over every letter of them.
inline std::string without_pictures(std::string page)
{
  const std::string mark = "base64,";
  for (std::size_t at = 0; (at = page.find(mark, at)) != std::string::npos;)
  {
    at += mark.size();
    page.erase(at, page.find('"', at) - at);
  }
  return page;
}

/// Walks the tags of a page: each is closed in its order, each attribute is quoted, each id is alone.
/// The first fault, or nothing.
inline std::string fault_of(std::string page)
{
  static const std::set<std::string> empty_tags{ "meta", "img", "br", "input", "link" };
  page = without_pictures(page);
  std::vector<std::string> open;
  std::set<std::string> ids;
  const std::regex tag_form(R"(^<(/?)([a-z][a-z0-9]*)((\s+[a-z-]+(="[^"<>]*")?)*)\s*>)");
  for (std::size_t at = 0; (at = page.find('<', at)) != std::string::npos;)
  {
    if (page.compare(at, 9, "<!DOCTYPE") == 0)
    {
      ++at;
      continue;
    }
    const std::size_t end = page.find('>', at);
    const std::string tag = page.substr(at, end == std::string::npos ? end : end + 1 - at);
    std::smatch match;
    if (!std::regex_match(tag, match, tag_form))
    {
      return "no tag: " + tag.substr(0, 80);
    }
    at += tag.size();
    const std::string name = match[2];
    if (match[1].length())
    {
      if (open.empty() || open.back() != name)
      {
        return "closed out of order: " + tag;
      }
      open.pop_back();
      continue;
    }
    const std::string attributes = match[3];
    std::smatch id;
    if (std::regex_search(attributes, id, std::regex(" id=\"([^\"]*)\"")) &&
      !ids.insert(id[1]).second)
    {
      return "twice: " + tag;
    }
    if (name == "img" && !(attributes.find(" alt=") != std::string::npos))
    {
      return "no alt: " + tag;
    }
    if (name == "style" || name == "script")
    {
      at = page.find("</" + name, at);
    }
    if (!empty_tags.count(name))
    {
      open.push_back(name);
    }
  }
  const std::regex reference("^&(amp|lt|gt|quot|#39);");
  for (std::size_t at = 0; (at = page.find('&', at)) != std::string::npos; ++at)
  {
    const bool in_code = page.compare(at, 2, "&&") == 0;
    if (!in_code && !std::regex_search(page.substr(at, 8), reference))
    {
      return "bare ampersand: " + page.substr(at, 40);
    }
  }
  return open.empty() ? "" : "not closed: " + open.back();
}

}
