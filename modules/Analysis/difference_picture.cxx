#include "difference_picture.h"

#include "canvas.h"
#include "colour_map.h"
#include "figures.h"
#include "legend.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brume
{

namespace
{

constexpr int largest_gain_exponent = 30;

/// The finite error that the scale is set by; 0 for none.
double decisive_error(const ImageErrors& errors)
{
  const double e = errors.percentile_999 > 0 ? errors.percentile_999 : errors.largest;
  return std::isfinite(e) ? e : 0.0;
}

/// The largest 1, 2 or 5 times a power of ten that is not above `most`.
double round_step(double most)
{
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  for (const double factor : { 5.0, 2.0 })
  {
    if (factor * power <= most * (1.0 + 1e-9))
    {
      return factor * power;
    }
  }
  return power;
}

}

double automatic_gain(const ImageErrors& errors)
{
  const double e = decisive_error(errors);
  if (e <= 0.0)
  {
    return 1.0;
  }
  int exponent = std::clamp(
    static_cast<int>(std::floor(-std::log2(e))), 0, largest_gain_exponent);
  if (exponent > 0 && std::ldexp(e, exponent) > 1.0) // log2 rounded up
  {
    --exponent;
  }
  return std::ldexp(1.0, exponent);
}

double shared_gain(const std::vector<ImageErrors>& errors)
{
  double gain = 0.0;
  for (const ImageErrors& e : errors)
  {
    if (decisive_error(e) > 0.0)
    {
      gain = gain == 0.0 ? automatic_gain(e) : std::min(gain, automatic_gain(e));
    }
  }
  return gain == 0.0 ? 1.0 : gain;
}

DifferencePicture difference_picture(
  const Picture& test, const Picture& truth, DifferenceKind kind, double gain)
{
  if (!std::isfinite(gain) || gain < 0.0)
  {
    throw std::invalid_argument(
      "difference picture: a gain of " + figure(gain) + ": use a positive number, or 0");
  }
  const ImageErrors errors = measure(test, truth);
  DifferencePicture difference;
  difference.kind = kind;
  difference.gain = gain > 0.0 ? gain : automatic_gain(errors);
  difference.non_finite_pixels = errors.non_finite_pixels;
  difference.bitmap = { test.width, test.height, {} };
  difference.bitmap.rgb.resize(test.rgb.size());
  for (std::size_t pixel = 0; pixel < test.rgb.size(); pixel += 3)
  {
    double worst = 0.0;
    bool finite = true;
    for (std::size_t i = pixel; i < pixel + 3; ++i)
    {
      const double e = static_cast<double>(test.rgb[i]) - static_cast<double>(truth.rgb[i]);
      finite = finite && std::isfinite(e);
      worst = std::abs(e) > std::abs(worst) ? e : worst;
    }
    const double shown = worst * difference.gain;
    Colour colour = non_finite_colour;
    if (finite)
    {
      colour = kind == DifferenceKind::Absolute ? inferno(std::abs(shown)) : cool_warm(shown);
      difference.pixels_beyond_scale += std::abs(shown) > 1.0 ? 1 : 0;
    }
    std::copy(colour.begin(), colour.end(), &difference.bitmap.rgb[pixel]);
  }
  return difference;
}

std::string difference_label(DifferenceKind kind, double gain)
{
  const std::string name =
    kind == DifferenceKind::Absolute ? "absolute difference" : "signed difference";
  return gain == 1.0 ? name + ", not amplified" : name + " × " + figure(gain, 10);
}

std::vector<LegendTick> legend_ticks(DifferenceKind kind, double gain)
{
  const double end = 255.0 / gain;
  const bool both_ways = kind == DifferenceKind::Signed;
  const double step = round_step(both_ways ? end : end / 2.0);
  const int count = static_cast<int>(std::floor(end / step * (1.0 + 1e-9)));
  std::vector<LegendTick> ticks;
  for (int i = both_ways ? -count : 0; i <= count; ++i)
  {
    const double share = i * step / end;
    LegendTick tick{ both_ways ? (share + 1.0) / 2.0 : share, figure(i * step) };
    if (both_ways && i > 0)
    {
      tick.text.insert(0, "+");
    }
    ticks.push_back(tick);
  }
  return ticks;
}

std::array<unsigned char, 3> legend_colour(DifferenceKind kind, double position)
{
  return kind == DifferenceKind::Absolute ? inferno(position) : cool_warm(2.0 * position - 1.0);
}

Bitmap with_legend(const DifferencePicture& difference)
{
  check_shape(difference.bitmap, "difference picture");
  const int width = std::max(320, difference.bitmap.width);
  const LegendLayout layout{ width };
  Canvas canvas(width, difference.bitmap.height + layout.height(), palette::page);
  canvas.draw(difference.bitmap, (width - difference.bitmap.width) / 2, 0, difference.bitmap.width,
    difference.bitmap.height);
  draw_legend(canvas, 0, difference.bitmap.height, layout, difference.kind, difference.gain,
    difference.non_finite_pixels);
  return canvas.bitmap();
}

}
