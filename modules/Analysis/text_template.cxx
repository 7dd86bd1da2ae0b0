#include "text_template.h"

#include "figures.h"

#include <stdexcept>
#include <vector>

namespace brume
{

namespace
{

using Json = nlohmann::ordered_json;
using Context = std::vector<const Json*>;

[[noreturn]] void fail(const std::string& what)
{
  throw std::logic_error("template: " + what);
}

const Json& find(const Context& context, const std::string& name)
{
  if (name == ".")
  {
    return *context.back();
  }
  for (auto level = context.rbegin(); level != context.rend(); ++level)
  {
    if ((*level)->is_object())
    {
      const auto found = (*level)->find(name);
      if (found != (*level)->end())
      {
        return *found;
      }
    }
  }
  fail("nothing is called " + name);
}

std::string as_text(const Json& value, const std::string& name)
{
  if (value.is_string())
  {
    return value.get<std::string>();
  }
  if (value.is_null())
  {
    return {};
  }
  if (value.is_number())
  {
    return value.is_number_float() ? figure(value.get<double>()) : value.dump();
  }
  fail(name + " is no text");
}

bool holds(const Json& value)
{
  return !(value.is_null() || (value.is_boolean() && !value.get<bool>()) ||
    (value.is_string() && value.get_ref<const std::string&>().empty()) ||
    (value.is_structured() && value.empty()));
}

/// Reads a template once, from left to right.
class Filler
{
public:
  explicit Filler(std::string_view text)
    : Text(text)
  {
  }

  /// Appends the template up to the end of the section `name` (empty: the whole text) to `out`;
  /// a null `out` reads over it.
  void fill(const Context& context, const std::string& name, std::string* out)
  {
    for (;;)
    {
      const std::size_t open = this->Text.find("{{", this->At);
      if (out)
      {
        out->append(this->Text.substr(this->At, open - this->At));
      }
      if (open == std::string_view::npos)
      {
        if (!name.empty())
        {
          fail("the part " + name + " is not closed");
        }
        this->At = this->Text.size();
        return;
      }
      const bool raw = this->Text.substr(open, 3) == "{{{";
      const std::string_view closing = raw ? "}}}" : "}}";
      const std::size_t start = open + (raw ? 3 : 2);
      const std::size_t close = this->Text.find(closing, start);
      if (close == std::string_view::npos)
      {
        fail("a gap is not closed");
      }
      std::string tag(this->Text.substr(start, close - start));
      this->At = close + closing.size();
      const char kind = raw || tag.empty() ? '\0' : tag[0];
      if (kind == '/')
      {
        if (tag.substr(1) != name)
        {
          fail("the part " + name + " is closed as " + tag.substr(1));
        }
        return;
      }
      if (kind == '#' || kind == '^')
      {
        this->section(context, tag.substr(1), kind == '#', out);
      }
      else if (out)
      {
        const std::string value = as_text(find(context, tag), tag);
        out->append(raw ? value : escape_html(value));
      }
    }
  }

private:
  void section(const Context& context, const std::string& name, bool wanted, std::string* out)
  {
    const std::size_t start = this->At;
    const Json* value = out ? &find(context, name) : nullptr;
    const bool shown = value && holds(*value) == wanted;
    if (shown && wanted && value->is_array())
    {
      for (const Json& element : *value)
      {
        Context inner = context;
        inner.push_back(&element);
        this->At = start;
        this->fill(inner, name, out);
      }
      return;
    }
    Context inner = context;
    if (shown && wanted)
    {
      inner.push_back(value);
    }
    this->fill(inner, name, shown ? out : nullptr);
  }

  std::string_view Text;
  std::size_t At = 0;
};

}

std::string fill_template(std::string_view text, const nlohmann::ordered_json& values)
{
  std::string out;
  Filler(text).fill({ &values }, "", &out);
  return out;
}

std::string escape_html(std::string_view text)
{
  std::string escaped;
  for (const char c : valid_utf8(text))
  {
    switch (c)
    {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

}
