#include "volume_summary.h"

#include "Transport/sparse_voxels.h"

#include "vtkBrumeSparseVolume.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <type_traits>

namespace brume::app
{

namespace
{

template <typename T>
void summarize_values(const T* values, vtkIdType count, int step, int bins, VolumeSummary& s)
{
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  // Sums of differences from a value of the data keep their digits where the mean is far from 0.
  double pivot = 0;
  double sum = 0;
  double squares = 0;
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double v = static_cast<double>(values[i * step]);
    if (!std::isfinite(v))
    {
      ++s.non_finite;
      continue;
    }
    if (s.finite++ == 0)
    {
      pivot = v;
    }
    low = std::min(low, v);
    high = std::max(high, v);
    sum += v - pivot;
    squares += (v - pivot) * (v - pivot);
  }
  if (s.finite == 0)
  {
    return;
  }
  const double n = static_cast<double>(s.finite);
  s.minimum = low;
  s.maximum = high;
  s.mean = pivot + sum / n;
  s.standard_deviation = std::sqrt(std::max(0.0, squares / n - (sum / n) * (sum / n)));

  constexpr int Fine = 65536;
  // Halves: the range of doubles may be wider than a double.
  const double half_range = high / 2 - low / 2;
  const bool whole = std::is_integral<T>::value && high - low < Fine;
  const auto bin_of = [&](double v, int n_bins)
  {
    const double place = half_range > 0 ? (v / 2 - low / 2) / half_range : 0;
    return std::min(n_bins - 1, static_cast<int>(place * n_bins));
  };
  // Bins of whole numbers hold equally many of them: others would show a comb that is not there.
  s.bin_width = whole ? std::ceil((high - low + 1) / bins) : 2 * (half_range / bins);
  const int n_bins = high == low ? 1 : whole ? static_cast<int>((high - low) / s.bin_width) + 1 : bins;
  std::vector<std::uint64_t> fine(Fine, 0);
  std::vector<double> least(Fine, high); // of the values in each fine bin
  s.histogram.assign(n_bins, 0);
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double v = static_cast<double>(values[i * step]);
    if (std::isfinite(v))
    {
      const int bin = whole ? static_cast<int>(v - low) : bin_of(v, Fine);
      ++fine[bin];
      least[bin] = std::min(least[bin], v);
      ++s.histogram[whole ? static_cast<int>((v - low) / s.bin_width) : bin_of(v, n_bins)];
    }
  }
  for (int percent : percents())
  {
    // The smallest value that at least so many percent of the values do not exceed.
    const double wanted = std::max(1.0, std::ceil(percent / 100.0 * n));
    double below = 0;
    int bin = 0;
    while (bin < Fine - 1 && (below += static_cast<double>(fine[bin])) < wanted)
    {
      ++bin;
    }
    s.percentiles.push_back(least[bin]);
  }
}

}

const std::vector<int>& percents()
{
  static const std::vector<int> list{ 1, 5, 25, 50, 75, 95, 99 };
  return list;
}

VolumeSummary summarize(vtkImageData* image, int component, int bins)
{
  VolumeSummary summary;
  vtkDataArray* scalars = image->GetPointData()->GetScalars();
  const int step = scalars->GetNumberOfComponents();
  switch (scalars->GetDataType())
  {
    vtkTemplateMacro(
      summarize_values(static_cast<const VTK_TT*>(scalars->GetVoidPointer(0)) + component,
        scalars->GetNumberOfTuples(), step, bins, summary));
  }
  return summary;
}

VolumeSummary summarize(vtkBrumeSparseVolume* volume, int bins)
{
  const SparseVoxels& voxels = *volume->GetVoxels();
  const std::size_t count = (voxels.slot_count() - 1) * SparseVoxels::brick_voxels;
  VolumeSummary summary;
  if (voxels.type() == VoxelType::Float32)
  {
    const auto* values = static_cast<const float*>(voxels.pool()) + SparseVoxels::brick_voxels;
    summarize_values(values, static_cast<vtkIdType>(count), 1, bins, summary);
    return summary;
  }
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    values[i] = static_cast<float>(voxels.value_in_slot(1 + i / SparseVoxels::brick_voxels,
      static_cast<int>(i % SparseVoxels::brick_voxels)));
  }
  summarize_values(values.data(), static_cast<vtkIdType>(count), 1, bins, summary);
  return summary;
}

bool terminal_takes_utf8()
{
  for (const char* name : { "LC_ALL", "LC_CTYPE", "LANG" })
  {
    const char* value = std::getenv(name);
    if (value && *value)
    {
      std::string text = value;
      std::transform(text.begin(), text.end(), text.begin(),
        [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      return text.find("utf-8") != std::string::npos || text.find("utf8") != std::string::npos;
    }
  }
  return false;
}

namespace
{

/// A bar of so many eighths of a column: U+2588 is a whole one, U+2589 to U+258F are 7 to 1 eighths.
std::string bar_of_blocks(int eighths)
{
  std::string bar;
  for (int i = 0; i < eighths / 8; ++i)
  {
    bar += "\xe2\x96\x88";
  }
  if (eighths % 8 > 0)
  {
    bar += "\xe2\x96";
    bar += static_cast<char>(0x88 + 8 - eighths % 8);
  }
  return bar;
}

}

std::string draw_histogram(const VolumeSummary& summary, int width, bool blocks)
{
  const std::size_t bins = summary.histogram.size();
  if (bins == 0)
  {
    return {};
  }
  const std::uint64_t most = *std::max_element(summary.histogram.begin(), summary.histogram.end());
  const double full = std::log1p(static_cast<double>(most));
  const int room = std::max(8, width - 28);
  std::string text;
  for (std::size_t i = 0; i < bins; ++i)
  {
    const double start = summary.minimum + static_cast<double>(i) * summary.bin_width;
    const std::uint64_t count = summary.histogram[i];
    const int unit = blocks ? 8 : 1;
    const int length = count == 0
      ? 0
      : std::max(1, static_cast<int>(std::lround(unit * room * std::log1p(static_cast<double>(count)) / full)));
    const std::string bar = blocks ? bar_of_blocks(length) : std::string(length, '#');
    char label[64];
    std::snprintf(label, sizeof(label), "%12.5g |", start);
    char number[32];
    std::snprintf(number, sizeof(number), "%llu", static_cast<unsigned long long>(count));
    text += label + bar + (count ? " " : "") + (count ? number : "") + "\n";
  }
  return text;
}

}
