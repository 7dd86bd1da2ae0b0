#include "figures.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace brume
{

namespace
{

std::string digits_of(double value, std::chars_format format, int precision)
{
  char buffer[64];
  const auto [end, error] =
    std::to_chars(buffer, buffer + sizeof(buffer), value, format, precision);
  return error == std::errc{} ? std::string(buffer, end) : std::string("?");
}

/// How many bytes of well-formed UTF-8 start the text; 0 for none.
std::size_t sequence_length(std::string_view text)
{
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80)
  {
    return 1;
  }
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length)
  {
    return 0;
  }
  for (std::size_t i = 1; i < length; ++i)
  {
    if ((byte(i) & 0xC0) != 0x80)
    {
      return 0;
    }
  }
  // Overlong forms, surrogates, and what lies beyond U+10FFFF.
  const unsigned char next = byte(1);
  const bool bad = (lead == 0xE0 && next < 0xA0) || (lead == 0xED && next > 0x9F) ||
    (lead == 0xF0 && next < 0x90) || (lead == 0xF4 && next > 0x8F);
  return bad ? 0 : length;
}

std::string unit_or_words(const std::string& unit)
{
  return unit.empty() ? "world units" : unit;
}

}

std::string figure(double value, int significant_digits)
{
  if (std::isnan(value))
  {
    return "not a number";
  }
  if (std::isinf(value))
  {
    return value > 0 ? "infinite" : "minus infinite";
  }
  if (value == 0.0)
  {
    return "0";
  }
  // The exponent after rounding, so that 0.9996 is 1 and not 1.000.
  const std::string scientific =
    digits_of(value, std::chars_format::scientific, significant_digits - 1);
  const int exponent = std::stoi(scientific.substr(scientific.find('e') + 1));
  const bool plain = exponent >= -4 && exponent < 7;
  std::string text = plain
    ? digits_of(value, std::chars_format::fixed, std::max(0, significant_digits - 1 - exponent))
    : scientific.substr(0, scientific.find('e'));
  if (text.find('.') != std::string::npos)
  {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.')
    {
      text.pop_back();
    }
  }
  return plain ? text : text + scientific.substr(scientific.find('e'));
}

std::string in_255ths(double fraction)
{
  return figure(255.0 * fraction);
}

std::string over_255(double fraction)
{
  return std::isfinite(fraction) && fraction != 0.0 ? in_255ths(fraction) + "/255" : figure(fraction);
}

std::string seconds_text(double seconds)
{
  return figure(seconds) + " s";
}

std::string voxels_text(const int dimensions[3], const double spacing[3], const std::string& unit)
{
  if (dimensions[0] <= 0 || dimensions[1] <= 0 || dimensions[2] <= 0)
  {
    return {};
  }
  std::string text = std::to_string(dimensions[0]) + " × " + std::to_string(dimensions[1]) + " × " +
    std::to_string(dimensions[2]) + " voxels";
  if (spacing[0] > 0 && spacing[1] > 0 && spacing[2] > 0)
  {
    text += " of " + figure(spacing[0]) + " × " + figure(spacing[1]) + " × " + figure(spacing[2]) +
      " " + unit_or_words(unit);
  }
  return text;
}

std::string step_text(double step, double step_voxels, const std::string& unit)
{
  if (!(step > 0))
  {
    return {};
  }
  std::string text = figure(step) + " " + unit_or_words(unit);
  if (step_voxels > 0)
  {
    text += " (" + figure(step_voxels) + (step_voxels == 1.0 ? " voxel)" : " voxels)");
  }
  return text;
}

std::string valid_utf8(std::string_view text)
{
  std::string valid;
  valid.reserve(text.size());
  while (!text.empty())
  {
    const std::size_t length = sequence_length(text);
    const unsigned char lead = static_cast<unsigned char>(text[0]);
    if (length == 0)
    {
      valid += "\xEF\xBF\xBD";
    }
    else if ((lead < 0x20 && lead != '\t' && lead != '\n') || lead == 0x7F)
    {
      valid += ' ';
    }
    else
    {
      valid += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return valid;
}

std::size_t code_points(std::string_view text)
{
  std::size_t count = 0;
  for (const char c : text)
  {
    count += (static_cast<unsigned char>(c) & 0xC0) != 0x80 ? 1 : 0;
  }
  return count;
}

}
