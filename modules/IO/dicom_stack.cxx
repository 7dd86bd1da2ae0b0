#include "dicom_stack.h"

#include "header_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

namespace brume::io
{

namespace
{

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector cross(const double* a, const double* b)
{
  return { { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] } };
}

/// A picture of the stack.
struct Slice
{
  const DicomFile* file = nullptr;
  const DicomFrame* frame = nullptr;
  std::size_t index = 0; ///< of the frame in its file
  double place = 0;      ///< along the normal, mm
};

std::string number(double value)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return text;
}

/// What pictures of one volume have in common.
bool alike(const Slice& a, const Slice& b)
{
  const DicomFile& f = *a.file;
  const DicomFile& g = *b.file;
  bool same = f.width == g.width && f.height == g.height && f.components == g.components &&
    f.planar == g.planar && f.scalar == g.scalar && f.bits == g.bits &&
    f.layout.big_endian == g.layout.big_endian &&
    f.layout.encapsulated == g.layout.encapsulated &&
    a.frame->placed == b.frame->placed;
  for (int i = 0; i < 6; ++i)
  {
    same = same && std::abs(a.frame->rows[i] - b.frame->rows[i]) < 1e-3;
  }
  for (int i = 0; i < 2; ++i)
  {
    same = same && std::abs(a.frame->pixel[i] - b.frame->pixel[i]) < 1e-3 * a.frame->pixel[i];
  }
  return same;
}

/// The most numerous pictures that are alike.
std::vector<Slice> largest_group(const std::vector<DicomFile>& files, ScanHeader& h)
{
  std::vector<std::vector<Slice>> groups;
  std::size_t total = 0;
  for (const DicomFile& file : files)
  {
    for (std::size_t i = 0; i < file.frames.size(); ++i, ++total)
    {
      const Slice slice{ &file, &file.frames[i], i, 0 };
      auto group = std::find_if(groups.begin(), groups.end(),
        [&](const std::vector<Slice>& g) { return alike(g.front(), slice); });
      if (group == groups.end())
      {
        group = groups.insert(groups.end(), std::vector<Slice>());
      }
      group->push_back(slice);
    }
  }
  const auto largest = std::max_element(groups.begin(), groups.end(),
    [](const auto& a, const auto& b) { return a.size() < b.size(); });
  if (largest->size() < total)
  {
    h.messages.push_back(std::to_string(total - largest->size()) + " of the series' " +
      std::to_string(total) + " pictures are of another size, kind or direction and are left out");
  }
  return *largest;
}

/// Distances smaller than this are none, mm.
constexpr double SamePlace = 1e-3;

/// Slices of one place each, in rising order: those that are there twice are left out.
void sort_by_place(std::vector<Slice>& slices)
{
  std::stable_sort(slices.begin(), slices.end(),
    [](const Slice& a, const Slice& b)
    {
      return std::abs(a.place - b.place) > SamePlace / 2
        ? a.place < b.place
        : a.file->instance_number < b.file->instance_number;
    });
}

void drop_doubles(std::vector<Slice>& slices, ScanHeader& h)
{
  const std::size_t before = slices.size();
  slices.erase(std::unique(slices.begin(), slices.end(),
                 [](const Slice& a, const Slice& b) { return b.place - a.place < SamePlace; }),
    slices.end());
  if (slices.size() < before)
  {
    h.messages.push_back(std::to_string(before - slices.size()) +
      " slices are doubled, at the place of another; the one of the lowest number is taken");
  }
}

/// Volumes over time, told apart by the first kind of time under which each has every place once;
/// else one volume.
std::vector<std::vector<Slice>> split_by_time(std::vector<Slice> slices, ScanHeader& h)
{
  sort_by_place(slices);
  std::size_t places = 1;
  for (std::size_t i = 1; i < slices.size(); ++i)
  {
    places += slices[i].place - slices[i - 1].place >= SamePlace;
  }
  if (slices.size() % places == 0 && slices.size() > places)
  {
    for (std::size_t kind = 0; kind < 4; ++kind)
    {
      std::map<double, std::vector<Slice>> volumes;
      for (const Slice& slice : slices)
      {
        const double time = slice.frame->times[kind];
        if (std::isfinite(time))
        {
          volumes[time].push_back(slice);
        }
      }
      bool whole = volumes.size() == slices.size() / places;
      for (const auto& [time, volume] : volumes)
      {
        whole = whole && volume.size() == places;
        for (std::size_t i = 1; whole && i < volume.size(); ++i)
        {
          whole = volume[i].place - volume[i - 1].place >= SamePlace;
        }
      }
      if (!whole)
      {
        continue;
      }
      std::vector<std::vector<Slice>> result;
      const double resolution = slices[0].file->temporal_resolution / 1000;
      const double first = volumes.begin()->first;
      for (const auto& [time, volume] : volumes)
      {
        const double since = time - first;
        h.times.push_back(kind == 0 && resolution > 0 ? since * resolution
            : kind == 0                               ? time
                                                      : since);
        result.push_back(volume);
      }
      h.time_unit = kind > 0 || resolution > 0 ? "s" : "";
      return result;
    }
  }
  drop_doubles(slices, h);
  return { slices };
}

/// Fills gaps of whole slices with the nearest slice, so that all that is there keeps its place; returns
/// the distance from slice to slice.
double even_out(std::vector<Slice>& slices, ScanHeader& h)
{
  std::vector<double> gaps;
  for (std::size_t i = 1; i < slices.size(); ++i)
  {
    gaps.push_back(slices[i].place - slices[i - 1].place);
  }
  std::vector<double> sorted = gaps;
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  bool whole = true;
  double missing = 0;
  for (double gap : gaps)
  {
    const double steps = std::max(std::round(gap / usual), 1.0);
    whole = whole && std::abs(gap - steps * usual) < 0.1 * usual;
    missing += steps - 1;
  }
  if (!whole || missing > static_cast<double>(slices.size()))
  {
    const double mean = (slices.back().place - slices.front().place) / static_cast<double>(gaps.size());
    h.messages.push_back("the slices are unevenly spaced, " + number(sorted.front()) + " to " +
      number(sorted.back()) + " mm apart; the mean, " + number(mean) +
      " mm, is taken for all, and what lies between is distorted");
    return mean;
  }
  if (missing > 0)
  {
    std::vector<Slice> filled;
    std::string where;
    int told = 0;
    for (std::size_t i = 0; i < slices.size(); ++i)
    {
      filled.push_back(slices[i]);
      const int steps = i < gaps.size() ? static_cast<int>(std::lround(gaps[i] / usual)) : 1;
      for (int s = 1; s < steps; ++s)
      {
        filled.push_back(2 * s <= steps ? slices[i] : slices[i + 1]);
      }
      if (steps > 1 && told++ < 4)
      {
        where += (where.empty() ? "" : ", ") + number(slices[i].place) + " and " +
          number(slices[i + 1].place) + " mm";
      }
    }
    const int count = static_cast<int>(missing);
    h.messages.push_back(std::to_string(count) + (count == 1 ? " slice is" : " slices are") +
      " missing, between " + where + (told > 4 ? ", …" : "") +
      "; the nearest slice stands in for each");
    slices = filled;
  }
  return (slices.back().place - slices.front().place) / static_cast<double>(slices.size() - 1);
}

/// From voxel index to RAS+ mm, by the first slice and the way from it to the last.
void orient(const std::vector<Slice>& slices, double between, ScanHeader& h)
{
  const DicomFrame& first = *slices.front().frame;
  Vector step = cross(&first.rows[0], &first.rows[3]);
  const double length = std::sqrt(dot(step, step));
  for (double& s : step)
  {
    s *= length > 0 ? between / length : 0;
  }
  if (slices.size() > 1 && slices.back().frame != slices.front().frame)
  {
    const Vector straight = step;
    for (int row = 0; row < 3; ++row)
    {
      step[row] = (slices.back().frame->position[row] - first.position[row]) /
        static_cast<double>(slices.size() - 1);
    }
    const double cosine = dot(step, straight) / std::sqrt(dot(step, step) * dot(straight, straight));
    const double degrees = std::acos(std::min(1.0, std::abs(cosine))) * 180 / M_PI;
    if (degrees > 0.05)
    {
      h.messages.push_back("the gantry was tilted: slices are shifted against one another by " +
        number(degrees) + " degrees");
    }
  }
  for (int row = 0; row < 3; ++row)
  {
    const double sign = row < 2 ? -1 : 1; // DICOM's patient is LPS+
    h.affine[4 * row] = sign * first.rows[row] * first.pixel[0];
    h.affine[4 * row + 1] = sign * first.rows[3 + row] * first.pixel[1];
    h.affine[4 * row + 2] = sign * step[row];
    h.affine[4 * row + 3] = sign * first.position[row];
  }
  h.patient = true;
}

/// Slope and intercept of every slice, and whether the values are whole and of 16 bits.
void take_rescale(const std::vector<std::vector<Slice>>& volumes, ScanHeader& h)
{
  const DicomFrame& first = *volumes.front().front().frame;
  bool same = true;
  bool whole = scalar_size(h.scalar) <= 2;
  double lowest = 0;
  double highest = 0;
  for (const std::vector<Slice>& volume : volumes)
  {
    for (const Slice& slice : volume)
    {
      const DicomFrame& f = *slice.frame;
      same = same && f.slope == first.slope && f.intercept == first.intercept;
      whole = whole && f.slope == std::round(f.slope) && f.intercept == std::round(f.intercept);
      const bool is_signed = h.scalar == Scalar::Int8 || h.scalar == Scalar::Int16;
      const double count = std::ldexp(1.0, slice.file->bits);
      const double from = is_signed ? -count / 2 : 0;
      for (double stored : { from, from + count - 1 })
      {
        lowest = std::min(lowest, f.slope * stored + f.intercept);
        highest = std::max(highest, f.slope * stored + f.intercept);
      }
    }
  }
  h.values_are_int16 = whole && lowest >= -32768 && highest <= 32767;
  h.slope = first.slope;
  h.intercept = first.intercept;
  if (!same)
  {
    for (const std::vector<Slice>& volume : volumes)
    {
      for (const Slice& slice : volume)
      {
        h.part_rescale.push_back({ { slice.frame->slope, slice.frame->intercept } });
      }
    }
  }
}

}

ScanHeader stack_dicom(const std::string& path, const std::vector<DicomFile>& files)
{
  ScanHeader h;
  h.path = path;
  std::vector<Slice> slices = largest_group(files, h);
  const DicomFile& file = *slices.front().file;
  const DicomFrame& frame = *slices.front().frame;
  if (!frame.placed)
  {
    h.messages.push_back("the pictures do not tell where they lie in the patient; they are stacked by "
                         "their numbers");
    for (Slice& slice : slices)
    {
      slice.place = static_cast<double>(slice.file->instance_number) * 1e6 +
        static_cast<double>(slice.index);
    }
    // Numbers may be missing or the same: it is their order that counts.
    sort_by_place(slices);
    const double between = frame.between > 0 ? frame.between : 1;
    for (std::size_t i = 0; i < slices.size(); ++i)
    {
      slices[i].place = static_cast<double>(i) * between;
    }
  }
  else
  {
    const Vector normal = cross(&frame.rows[0], &frame.rows[3]);
    for (Slice& slice : slices)
    {
      slice.place = dot(slice.frame->position, normal);
    }
  }
  if (file.spread)
  {
    h.messages.push_back("its frames do not tell where each lies; they are set " +
      number(std::abs(slices.size() > 1 ? slices[1].place - slices[0].place : 0)) + " mm apart");
  }
  std::vector<std::vector<Slice>> volumes = split_by_time(slices, h);
  double between = frame.between > 0 ? frame.between : 1;
  for (std::size_t v = 0; v < volumes.size(); ++v)
  {
    if (volumes[v].size() > 1)
    {
      ScanHeader ignored; // all volumes have the places of the first
      between = even_out(volumes[v], v == 0 ? h : ignored);
    }
  }
  if (volumes[0].size() == 1 && frame.between <= 0)
  {
    h.messages.push_back("the slice does not tell how thick it is; 1 mm is assumed");
  }

  h.dimensions = { { file.width, file.height, static_cast<std::int64_t>(volumes[0].size()) } };
  h.components = file.components;
  h.scalar = file.scalar;
  h.stored_bits = file.bits;
  h.swap_bytes = file.layout.big_endian != machine_is_big_endian();
  h.format = "DICOM";
  if (file.layout.encapsulated)
  {
    h.format += " (" + syntax_name(file.layout.transfer_syntax) + ")";
    h.encoding = Encoding::Dicom;
  }
  // Compressed colours come out pixel by pixel.
  h.part_planar = file.planar && !file.layout.encapsulated;
  for (const std::vector<Slice>& volume : volumes)
  {
    if (volume.size() != volumes[0].size())
    {
      fail(path, "its volumes over time have gaps at different places", "take one of them");
    }
    for (const Slice& slice : volume)
    {
      DataPart part;
      part.path = slice.file->path;
      part.offset = slice.file->layout.pixel_offset;
      part.frame = slice.index;
      part.frames = slice.file->frames.size();
      if (h.encoding != Encoding::Dicom)
      {
        part.offset += slice.index * slice.file->frame_bytes();
      }
      h.parts.push_back(part);
    }
  }
  if (h.times.size() < 2)
  {
    h.times.clear();
  }
  if (frame.placed)
  {
    orient(volumes[0], between, h);
  }
  else
  {
    h.affine = { { frame.pixel[0], 0, 0, 0, 0, frame.pixel[1], 0, 0, 0, 0, between, 0 } };
  }
  h.length_unit = "mm";
  h.value_unit = file.modality == "CT" && file.components == 1 ? "HU" : file.value_unit;
  if (file.components == 1)
  {
    take_rescale(volumes, h);
  }
  if (h.dimensions[2] == 1 && files.size() == 1 && files[0].path == path)
  {
    h.messages.push_back("is one slice; name its folder for the whole series");
  }
  return h;
}

}
