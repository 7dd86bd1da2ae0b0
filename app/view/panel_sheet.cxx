#include "panel_sheet.h"

#include <algorithm>

namespace brume::app
{

namespace
{

Box common(const Box& a, const Box& b)
{
  const int x = std::max(a.x, b.x);
  const int y = std::max(a.y, b.y);
  return {
    x, y, std::min(a.x + a.width, b.x + b.width) - x, std::min(a.y + a.height, b.y + b.height) - y
  };
}

}

const HotSpot* DrawnPanel::at(int x, int y) const
{
  const auto found = std::find_if(this->spots.begin(),
    this->spots.end(),
    [&](const HotSpot& spot) { return spot.shown.contains(x, y); });
  return found == this->spots.end() ? nullptr : &*found;
}

int DrawnPanel::scroll_at(int y) const
{
  const int way = std::max(this->track.height - this->thumb.height, 1);
  return std::clamp((y - this->track.y) * this->most / way, 0, this->most);
}

int PanelSheet::inner(int width, const Metrics& metrics)
{
  return std::max(
    width - 2 * metrics.margin - metrics.text / 4, 1); // the right margin is the bar's
}

PanelSheet::PanelSheet(int width,
  int height,
  const Metrics& metrics,
  int head,
  int foot,
  int scroll)
  : M(metrics)
  , Height(height)
  , Sheet(width, height, palette::page)
  , Width(width)
  , Left(metrics.margin)
  , Inner(inner(width, metrics))
  , Seen{ 0, head, width, std::max(height - head - foot, 0) }
  , Y(head - scroll)
{
  this->Drawn.scroll = scroll;
  this->Drawn.page = this->Seen;
}

std::optional<int> PanelSheet::take(int height)
{
  const int top = this->Y;
  this->Y += height;
  const bool seen = top<this->Seen.y + this->Seen.height&& this->Y> this->Seen.y;
  return seen ? std::optional<int>(top) : std::nullopt;
}

void PanelSheet::text(int x,
  int baseline,
  const std::string& line,
  Colour colour,
  int width,
  Align align,
  bool bold)
{
  const TextStyle s = this->style(colour, bold);
  this->Sheet.text(x, baseline, fitted(line, s, std::max(width, 0)), s, align);
}

void PanelSheet::pair(int baseline,
  const std::string& name,
  Colour name_colour,
  const std::string& value,
  Colour value_colour,
  int width)
{
  const int room =
    value.empty() ? 0 : text_width(value, this->style(value_colour)) + this->M.margin;
  this->text(this->Left + width, baseline, value, value_colour, width, Align::Right);
  this->text(this->Left, baseline, name, name_colour, width - room);
}

void PanelSheet::outline(const Box& box, Colour colour, int thick)
{
  this->Sheet.fill(box.x, box.y, box.width, thick, colour);
  this->Sheet.fill(box.x, box.y + box.height - thick, box.width, thick, colour);
  this->Sheet.fill(box.x, box.y, thick, box.height, colour);
  this->Sheet.fill(box.x + box.width - thick, box.y, thick, box.height, colour);
}

void PanelSheet::spot(HotSpot::Kind kind, const Box& box, int index, const std::string& name)
{
  const Box shown = this->PageEnded ? box : common(box, this->Seen);
  if (!shown.empty())
  {
    this->Drawn.spots.push_back({ kind, box, index, name, shown });
  }
}

void PanelSheet::end_page()
{
  this->PageEnded = true;
  const int end = this->Seen.y + this->Seen.height;
  this->Sheet.fill(0, 0, this->Width, this->Seen.y, palette::page);
  this->Sheet.fill(0, end, this->Width, this->Height - end, palette::page);
  this->Sheet.fill(0, 0, 1, this->Height, palette::frame);

  const int whole = this->Y + this->Drawn.scroll - this->Seen.y;
  this->Drawn.most = std::max(whole - this->Seen.height, 0);
  if (this->Drawn.most == 0 || this->Seen.height < 2)
  {
    return;
  }
  // In the margin, so that nothing moves when it comes.
  const Box track{
    this->right() + 2, this->Seen.y, this->Width - this->right() - 2, this->Seen.height
  };
  const int part = static_cast<int>(double(track.height) * this->Seen.height / whole);
  const int height = std::clamp(part, std::min(2 * this->M.text, track.height / 2), track.height);
  const int way = track.height - height;
  const int scroll = std::min(this->Drawn.scroll, this->Drawn.most);
  this->Drawn.track = track;
  this->Drawn.thumb = { track.x,
    track.y + static_cast<int>(double(way) * scroll / this->Drawn.most),
    track.width,
    height };
  this->Sheet.fill(track.x, track.y, track.width, track.height, { 32, 35, 42 });
  this->Sheet.fill(
    track.x, this->Drawn.thumb.y, track.width, this->Drawn.thumb.height, { 98, 104, 115 });
  this->spot(HotSpot::Kind::Scroll, track);
}

DrawnPanel PanelSheet::finish()
{
  this->Drawn.bitmap = this->Sheet.bitmap();
  return std::move(this->Drawn);
}

}
