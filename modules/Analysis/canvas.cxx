#include "canvas.h"

#include "figures.h"

#include <vtkFreeTypeTools.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace brume
{

namespace
{

constexpr int dpi = 72; // a point is a pixel
const std::string ellipsis = "...";

/// The font that is compiled into VTK holds ASCII alone: the signs of our own texts become their
/// ASCII forms, any other sign a question mark.
std::string lettering(const std::string& text)
{
  static const std::pair<const char*, const char*> forms[] = { { "×", "x" }, { "·", "-" },
    { "…", "..." }, { "–", "-" }, { "—", "-" }, { "−", "-" }, { "µ", "u" }, { "²", "2" },
    { "³", "3" }, { "½", "1/2" }, { "’", "'" }, { "\n", " " }, { "\t", " " } };
  std::string valid = valid_utf8(text);
  for (const auto& [sign, form] : forms)
  {
    for (std::size_t at = 0; (at = valid.find(sign, at)) != std::string::npos;)
    {
      valid.replace(at, std::string(sign).size(), form);
    }
  }
  std::string ascii;
  for (const char c : valid)
  {
    const unsigned char byte = static_cast<unsigned char>(c);
    if (byte < 0x80)
    {
      ascii += c;
    }
    else if (byte >= 0xC0) // the first byte of a sign
    {
      ascii += '?';
    }
  }
  return ascii;
}

void set_up(vtkTextProperty* property, const TextStyle& style)
{
  property->SetFontFamilyToArial(); // compiled into VTK: no font file, no fontconfig
  property->SetFontSize(style.size);
  property->SetBold(style.bold);
  property->SetColor(1.0, 1.0, 1.0);
  property->SetJustificationToLeft();
  property->SetVerticalJustificationToBottom();
  property->SetLineOffset(0);
}

}

Canvas::Canvas(int width, int height, Colour page)
{
  if (width <= 0 || height <= 0)
  {
    throw std::invalid_argument("canvas: a width or height that is not positive");
  }
  this->Sheet = { width, height, {} };
  this->Sheet.rgb.resize(std::size_t{ 3 } * width * static_cast<std::size_t>(height));
  this->fill(0, 0, width, height, page);
}

unsigned char* Canvas::at(int x, int y)
{
  return &this->Sheet.rgb[3 *
    (static_cast<std::size_t>(this->Sheet.height - 1 - y) * this->Sheet.width + x)];
}

void Canvas::fill(int x, int y, int width, int height, Colour colour)
{
  for (int row = std::max(0, y); row < std::min(this->Sheet.height, y + height); ++row)
  {
    for (int column = std::max(0, x); column < std::min(this->Sheet.width, x + width); ++column)
    {
      std::copy(colour.begin(), colour.end(), this->at(column, row));
    }
  }
}

void Canvas::draw(const Bitmap& bitmap, int x, int y, int width, int height)
{
  check_shape(bitmap, "picture to lay out");
  // The source pixels that the target pixel t of `size` covers: [first, last).
  const auto covered = [](int t, int size, int source) {
    const long long first = static_cast<long long>(t) * source / size;
    const long long last = (static_cast<long long>(t + 1) * source + size - 1) / size;
    return size >= source ? std::pair<int, int>(first, first + 1) : std::pair<int, int>(first, last);
  };
  for (int row = std::max(0, -y); row < std::min(height, this->Sheet.height - y); ++row)
  {
    const auto [bottom, top] = covered(height - 1 - row, height, bitmap.height);
    for (int column = std::max(0, -x); column < std::min(width, this->Sheet.width - x); ++column)
    {
      const auto [left, right] = covered(column, width, bitmap.width);
      int sum[3] = { 0, 0, 0 };
      for (int sy = bottom; sy < top; ++sy)
      {
        for (int sx = left; sx < right; ++sx)
        {
          const unsigned char* in =
            &bitmap.rgb[3 * (static_cast<std::size_t>(sy) * bitmap.width + sx)];
          for (int channel = 0; channel < 3; ++channel)
          {
            sum[channel] += in[channel];
          }
        }
      }
      const int count = (top - bottom) * (right - left);
      unsigned char* out = this->at(x + column, y + row);
      for (int channel = 0; channel < 3; ++channel)
      {
        out[channel] = static_cast<unsigned char>((sum[channel] + count / 2) / count);
      }
    }
  }
}

void Canvas::text(
  int x, int baseline, const std::string& line, const TextStyle& style, Align align)
{
  const vtkStdString letters(lettering(line));
  if (letters.empty())
  {
    return;
  }
  vtkNew<vtkTextProperty> property;
  set_up(property, style);
  vtkFreeTypeTools* tools = vtkFreeTypeTools::GetInstance();
  vtkNew<vtkImageData> image;
  int size[2] = { 0, 0 };
  vtkTextRenderer::Metrics metrics;
  if (!tools->GetMetrics(property, letters, dpi, metrics) ||
    !tools->RenderString(property, letters, dpi, image, size))
  {
    throw std::runtime_error("lettering: the text could not be drawn: " + letters);
  }
  const int advance = text_width(line, style);
  x -= align == Align::Left ? 0 : align == Align::Centre ? advance / 2 : advance;

  // The letters' descent below the baseline; the image's lowest row is the line's lowest.
  const int descent = static_cast<int>(std::lround(std::abs(metrics.Descent.GetY())));
  int extent[6];
  image->GetExtent(extent);
  const int components = image->GetNumberOfScalarComponents();
  for (int row = 0; row < size[1]; ++row)
  {
    const int target_y = baseline + descent - 1 - row;
    for (int column = 0; column < size[0]; ++column)
    {
      const int target_x = x + column;
      if (target_x < 0 || target_x >= this->Sheet.width || target_y < 0 ||
        target_y >= this->Sheet.height)
      {
        continue;
      }
      const auto* texel = static_cast<const unsigned char*>(
        image->GetScalarPointer(extent[0] + column, extent[2] + row, extent[4]));
      const int coverage = texel[components - 1];
      unsigned char* out = this->at(target_x, target_y);
      for (int channel = 0; channel < 3; ++channel)
      {
        out[channel] = static_cast<unsigned char>(
          (out[channel] * (255 - coverage) + style.colour[channel] * coverage + 127) / 255);
      }
    }
  }
}

Bitmap Canvas::bitmap() const
{
  return this->Sheet;
}

int text_width(const std::string& line, const TextStyle& style)
{
  if (lettering(line).empty())
  {
    return 0;
  }
  vtkNew<vtkTextProperty> property;
  set_up(property, style);
  int box[4] = { 0, 0, 0, 0 };
  vtkFreeTypeTools::GetInstance()->GetBoundingBox(
    property, vtkStdString(lettering(line)), dpi, box);
  return box[1] - box[0] + 1;
}

std::string fitted(const std::string& line, const TextStyle& style, int width)
{
  const std::string letters = lettering(line);
  if (text_width(letters, style) <= width)
  {
    return letters;
  }
  const auto beginning = [&](std::size_t count) {
    std::string kept = letters.substr(0, count);
    kept.erase(kept.find_last_not_of(' ') + 1);
    return kept + ellipsis;
  };
  std::size_t fits = 0;
  std::size_t too_long = letters.size();
  while (too_long - fits > 1)
  {
    const std::size_t middle = (fits + too_long) / 2;
    (text_width(beginning(middle), style) <= width ? fits : too_long) = middle;
  }
  return beginning(fits);
}

std::vector<std::string> wrapped(
  const std::string& text, const TextStyle& style, int width, int lines)
{
  std::vector<std::string> result;
  std::istringstream words(lettering(text));
  std::string word;
  std::string line;
  while (words >> word)
  {
    const std::string longer = line.empty() ? word : line + " " + word;
    const bool last = static_cast<int>(result.size()) + 1 >= lines;
    if (line.empty() || last || text_width(longer, style) <= width)
    {
      line = longer;
      continue;
    }
    result.push_back(fitted(line, style, width));
    line = word;
  }
  if (!line.empty())
  {
    result.push_back(fitted(line, style, width));
  }
  return result;
}

}
