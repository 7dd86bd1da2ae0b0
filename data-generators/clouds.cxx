#include "data-generators/clouds.h"

#include "data-generators/cumulus.h"
#include "data-generators/heap_cloud.h"
#include "data-generators/layer_cloud.h"
#include "data-generators/piles.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tbb/parallel_for.h>
#include <utility>
#include <vector>

namespace brume
{

namespace
{

void require(bool holds, const char* what)
{
  if (!holds)
  {
    throw std::invalid_argument(std::string("cloud: ") + what);
  }
}

/// The largest features of a layer's cover: cells are some times wider than the layer is thick,
/// patches wider still.
double cover_size(const CloudOptions& o)
{
  const double by_height = o.kind == CloudKind::Stratocumulus ? 1.6
                           : o.kind == CloudKind::Cirrus      ? 1.4
                                                              : 5.0;
  return by_height * (o.top - o.base);
}

/// A pile of puffs that is not a single cumulus.
class PiledCloud : public Field
{
public:
  explicit PiledCloud(const CloudOptions& o)
  {
    m_cloud.border_fade = cloud_side_fade(o) / o.width;
    m_cloud.empty_border = m_cloud.border_fade / 3.0;
    m_cloud.seed = o.seed;
    m_cloud.width = o.width;
    m_cloud.base = o.base / o.width;
    m_cloud.height = (o.top + 0.1 * (o.top - o.base)) / o.width + m_cloud.border_fade;
    m_cloud.detail_size = o.detail_size;
    m_cloud.octaves = o.octaves;
    m_cloud.offset = o.offset;
    m_cloud.crispness = o.crispness;
    m_cloud.warp_amplitude = o.warp_amplitude;
    m_cloud.warp_size = o.warp_size;
    m_cloud.wind = o.wind;
    m_cloud.below_base = std::min(0.03, 0.08 * (o.top - o.base) / o.width);
    if (o.kind == CloudKind::Cumulonimbus)
    {
      m_cloud.ice = (o.base + 0.62 * (o.top - o.base)) / o.width;
    }
    m_heap = std::make_unique<PuffHeap>(o.kind == CloudKind::CumulusField
                                          ? pile_cumulus_field(o, m_cloud.border_fade)
                                          : pile_cumulonimbus(o),
      Box{ { -0.5, -0.5, 0.0 }, { 0.5, 0.5, m_cloud.height } },
      o.warp_amplitude / o.width);
    m_cloud.heap = m_heap.get();
  }

  Box bounds() const override
  {
    const double half = 0.5 * m_cloud.width;
    return { { -half, -half, 0.0 }, { half, half, m_cloud.height * m_cloud.width } };
  }
  float value(const glm::dvec3& place, double time) const override
  {
    return heap_cloud_value(m_cloud, place, time);
  }
  void values(const PlaceBlock& places, double time, float* out) const override
  {
    heap_cloud_packets(m_cloud, places, time, out);
  }
  FieldRange range_in(const Box& box, double) const override { return m_cloud.range_in(box); }

private:
  HeapCloud m_cloud;
  std::unique_ptr<const PuffHeap> m_heap;
};

class Layer : public Field
{
public:
  explicit Layer(const CloudOptions& options)
  {
    m_cloud.options = options;
    const CloudOptions& o = m_cloud.options;
    m_cloud.height = o.top - o.base;
    const double speed = std::sqrt(o.wind.x * o.wind.x + o.wind.y * o.wind.y);
    if (speed > 0.0)
    {
      m_cloud.along_x = o.wind.x / speed;
      m_cloud.along_y = o.wind.y / speed;
    }
    m_cloud.cover_size = cover_size(o);
    m_cloud.border_fade = cloud_side_fade(o) / (0.5 * o.width);
    m_cloud.empty_border = std::min(0.02, m_cloud.border_fade / 3.0);
    this->settle_coverage();
  }

  Box bounds() const override
  {
    const CloudOptions& o = m_cloud.options;
    const double half = 0.5 * o.width;
    const double room = LayerCloud::empty_above * m_cloud.height;
    return { { -half, -half, o.base - room }, { half, half, o.top + room } };
  }
  float value(const glm::dvec3& place, double time) const override
  {
    return layer_cloud_value(m_cloud, place, time);
  }
  void values(const PlaceBlock& places, double time, float* out) const override
  {
    layer_cloud_packets(m_cloud, places, time, out);
  }
  FieldRange range_in(const Box& box, double) const override
  {
    const Box all = this->bounds();
    const double border = 0.49 * m_cloud.empty_border * m_cloud.options.width;
    const double room = 0.49 * LayerCloud::empty_above * m_cloud.height;
    const bool outside = box.upper.x < all.lower.x + border || box.lower.x > all.upper.x - border ||
                         box.upper.y < all.lower.y + border || box.lower.y > all.upper.y - border ||
                         box.upper.z < all.lower.z + room || box.lower.z > all.upper.z - room;
    return { 0.0f, outside ? 0.0f : 1.0f };
  }

private:
  /// The threshold of the cover at which as many columns of the box, away from its sides, meet
  /// cloud as are asked for: by bisection, for more of them do the lower it is.
  void settle_coverage()
  {
    const double coverage = m_cloud.options.coverage;
    double low = -2.5, high = 2.5; // beyond what cover noise and its fraying come to
    if (coverage == 0.0)
    {
      m_cloud.cover_threshold = 10.0;
      return;
    }
    for (int step = 0; step < 11; ++step)
    {
      m_cloud.cover_threshold = 0.5 * (low + high);
      (this->covered() > coverage ? low : high) = m_cloud.cover_threshold;
    }
    m_cloud.cover_threshold = 0.5 * (low + high);
    if (coverage == 1.0)
    {
      m_cloud.cover_threshold -= 0.3; // closed: the thinnest place is well within
    }
  }

  /// The fraction of columns that meet cloud now. The columns stand in rows, each shifted by
  /// another part of a step along both axes, so that they do not beat with the noise's lattice.
  double covered() const
  {
    constexpr int side = 48;
    const CloudOptions& o = m_cloud.options;
    const int heights = o.kind == CloudKind::Cirrus ? 32 : 12; // whose streaks are thin
    const double width = o.width - 2.0 * cloud_side_fade(o), step = width / side;
    std::vector<int> counts(side, 0);
    tbb::parallel_for(0,
      side,
      [&](int j)
      {
        const auto shift = [j](double by) { return j * by - std::floor(j * by); };
        PlaceBlock row;
        row.origin = { -0.5 * width + shift(0.6180339887) * step,
          -0.5 * width + (j + shift(0.7548776662)) * step,
          o.base + 0.5 * m_cloud.height / heights };
        row.spacing = { step, 1.0, m_cloud.height / heights };
        row.count = { side, 1, heights };
        std::vector<float> values(row.size());
        layer_cloud_packets(m_cloud, row, 0.0, values.data());
        for (int i = 0; i < side; ++i)
        {
          bool any = false;
          for (int k = 0; k < heights; ++k)
          {
            any = any || values[k * side + i] > CloudOptions::thinnest;
          }
          counts[j] += any;
        }
      });
    return std::accumulate(counts.begin(), counts.end(), 0) / double(side * side);
  }

  LayerCloud m_cloud;
};

}

CloudOptions cloud_defaults(CloudKind kind)
{
  CloudOptions o;
  o.kind = kind;
  switch (kind)
  {
    case CloudKind::Cumulus:
      break;
    case CloudKind::CumulusField:
      o.width = 6000.0;
      o.base = 600.0;
      o.top = 1500.0;
      o.coverage = 0.25;
      o.detail_size = 220.0;
      o.crispness = 3.0;
      o.wind = { 6.0, 2.0, 1.0 };
      break;
    case CloudKind::Stratus:
      o.width = 6000.0;
      o.base = 200.0;
      o.top = 600.0;
      o.coverage = 0.85;
      o.detail_size = 350.0;
      o.offset = 0.45;
      o.crispness = 1.4;
      o.warp_amplitude = 120.0;
      o.warp_size = 900.0;
      o.wind = { 5.0, 1.0, 0.0 };
      break;
    case CloudKind::Stratocumulus:
      o.width = 8000.0;
      o.base = 900.0;
      o.top = 1500.0;
      o.coverage = 0.7;
      o.detail_size = 260.0;
      o.offset = 0.25;
      o.crispness = 2.5;
      o.warp_amplitude = 120.0;
      o.warp_size = 700.0;
      o.wind = { 8.0, 2.0, 0.0 };
      break;
    case CloudKind::Cirrus:
      o.width = 12000.0;
      o.base = 8000.0;
      o.top = 9500.0;
      o.coverage = 0.55;
      o.detail_size = 420.0;
      o.octaves = 6;
      o.offset = 0.3;
      o.crispness = 1.5;
      o.warp_amplitude = 500.0;
      o.warp_size = 3500.0;
      o.wind = { 30.0, 8.0, 0.0 };
      break;
    case CloudKind::Cumulonimbus:
      o.width = 20000.0;
      o.base = 1200.0;
      o.top = 12000.0;
      o.detail_size = 1300.0;
      o.octaves = 6;
      o.offset = 0.14;
      o.warp_amplitude = 350.0;
      o.warp_size = 2500.0;
      o.wind = { 18.0, 3.0, 6.0 };
      break;
  }
  return o;
}

double cloud_side_fade(const CloudOptions& o)
{
  switch (o.kind)
  {
    case CloudKind::Cumulus:
    case CloudKind::Cumulonimbus:
      return HeapCloud::usual_fade * o.width;
    case CloudKind::CumulusField:
      return std::min(HeapCloud::usual_fade * o.width, 0.6 * (o.top - o.base));
    default:
      return std::min(0.2 * o.width, cover_size(o));
  }
}

std::unique_ptr<Field> make_cloud(const CloudOptions& options)
{
  CloudOptions o = options;
  const auto above_zero = [](double x) { return x > 0.0 && std::isfinite(x); };
  require(above_zero(o.width), "the width must be above 0");
  require(std::isfinite(o.base) && std::isfinite(o.top) &&
            (o.base < o.top || o.kind == CloudKind::Cumulus), // which looks for itself
    "the base must be below the top");
  require(o.top - o.base < 20.0 * o.width, "the cloud must be lower than 20 widths");
  require(o.coverage >= 0.0 && o.coverage <= 1.0, "the coverage must be in [0, 1]");
  require(above_zero(o.detail_size), "the detail size must be above 0");
  require(o.octaves >= 1 && o.octaves <= 8, "the octaves must be 1 to 8");
  require(o.offset >= 0.0 && o.offset <= 1.0, "the offset must be in [0, 1]");
  require(above_zero(o.crispness), "the crispness must be above 0");
  require(std::isfinite(o.warp_amplitude) && std::isfinite(o.warp_size), "the warp must be finite");
  require(std::isfinite(o.wind.x) && std::isfinite(o.wind.y) && std::isfinite(o.wind.z),
    "the wind must be finite");
  switch (o.kind)
  {
    case CloudKind::Cumulus:
    {
      CumulusOptions c;
      c.seed = o.seed;
      c.width = o.width;
      c.base = o.base;
      c.top = o.top;
      c.detail_size = o.detail_size;
      c.octaves = o.octaves;
      c.offset = o.offset;
      c.crispness = o.crispness;
      c.warp_amplitude = o.warp_amplitude;
      c.warp_size = o.warp_size;
      c.wind = o.wind;
      return std::make_unique<Cumulus>(c);
    }
    case CloudKind::CumulusField:
    case CloudKind::Cumulonimbus:
      require(o.base >= 0.5 * cloud_side_fade(o),
        "the base must be at 0.03 width or higher; of a field 0.3 of its clouds' height will do");
      require(o.top < 20.0 * o.width, "the top must be below 20 widths");
      require(o.kind != CloudKind::CumulusField || o.width <= 100.0 * (o.top - o.base),
        "a field must be at most 100 of its clouds' heights wide");
      o.warp_amplitude = std::clamp(o.warp_amplitude, 0.0, 0.06 * o.width);
      return std::make_unique<PiledCloud>(o);
    case CloudKind::Stratus:
    case CloudKind::Stratocumulus:
    case CloudKind::Cirrus:
      o.warp_amplitude = std::clamp(o.warp_amplitude, 0.0, o.width);
      return std::make_unique<Layer>(o);
  }
  throw std::invalid_argument("cloud: there is no such kind");
}

}
