#include "layout.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brume::app
{

Metrics::Metrics(double scale)
  : text(std::max(8, static_cast<int>(std::lround(13.0 * scale))))
  , line(std::lround(1.35 * this->text))
  , margin(std::max(2, this->text / 2))
  , row(this->line + this->text)
  , panel(20 * this->text)
  , caption(this->line + this->margin)
{
}

Layout lay_out(int width, int height, const Metrics& metrics, int pictures, bool panel)
{
  if (width < 1 || height < 1 || pictures < 1)
  {
    throw std::invalid_argument("a window without pixels or viewports");
  }
  Layout layout;
  const int beside = std::min(metrics.panel, width / 2);
  const bool has_panel = panel && beside >= 12 * metrics.text; // else its words do not fit
  const int wide = has_panel ? width - beside : width;
  if (has_panel)
  {
    layout.panel = { wide, 0, beside, height };
  }
  const int caption = std::min(metrics.caption, height / 4);
  Box size; // of a picture
  int columns = 1;
  for (int n = 1; n <= pictures; ++n)
  {
    const int rows = (pictures + n - 1) / n;
    const Box one{ 0, 0, std::max(wide / n, 1), std::max(height / rows - caption, 1) };
    if (std::min(one.width, one.height) > std::min(size.width, size.height))
    {
      size = one;
      columns = n;
    }
  }
  for (int i = 0; i < pictures; ++i)
  {
    const int x = i % columns * size.width;
    const int y = i / columns * (size.height + caption);
    layout.pictures.push_back({ x, y, size.width, size.height });
    layout.captions.push_back({ x, y + size.height, size.width, caption });
  }
  return layout;
}

}
