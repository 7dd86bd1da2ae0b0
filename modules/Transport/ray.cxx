#include "Transport/ray.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brume
{

RayMaker::RayMaker(const Scene& scene, int width, int height)
  : Width(width)
  , Height(height)
  , Simple(scene.volumes.size() == 1 && !scene.volumes[0].cropping.enabled &&
           scene.volumes[0].clipping_planes.empty())
  , SurfaceDepth(scene.surface_depth.empty() ? nullptr : scene.surface_depth.data())
{
  if (scene.volumes.size() > 32)
  {
    throw std::invalid_argument("no more than 32 volumes can be drawn together");
  }
  for (const Volume& volume : scene.volumes)
  {
    Frame frame;
    frame.volume = &volume;
    const glm::dmat4 world_from_index = volume.world_from_data * volume.data_from_index;
    frame.data_from_index = glm::dmat3(volume.data_from_index);
    frame.world_from_index = glm::dmat3(world_from_index);
    // One matrix from index space to the clip cube: far origins cancel here, in double precision,
    // rather than in every ray.
    frame.index_from_clip = glm::inverse(scene.camera.clip_from_world * world_from_index);
    for (int axis = 0; axis < 3; ++axis)
    {
      frame.lower[axis] = volume.grid.lower(axis);
      frame.upper[axis] = volume.grid.upper(axis);
    }
    for (const glm::dvec4& plane : volume.clipping_planes)
    {
      frame.planes.push_back(
        plane * world_from_index); // a plane is a row: it goes by the transpose
    }
    this->Frames.push_back(std::move(frame));
  }
}

RayWay RayMaker::way(int x, int y, std::size_t volume) const
{
  const Frame& frame = this->Frames[volume];
  const double ndc_x = (2.0 * x + 1.0) / this->Width - 1.0;
  const double ndc_y = (2.0 * y + 1.0) / this->Height - 1.0;
  double ndc_far = 1.0;
  if (this->SurfaceDepth)
  {
    ndc_far =
      std::min(ndc_far, double(this->SurfaceDepth[static_cast<std::size_t>(y) * this->Width + x]));
  }
  const glm::dmat4& m = frame.index_from_clip;
  const glm::dvec4 middle = m[0] * ndc_x + m[1] * ndc_y + m[3];
  const glm::dvec4 h_near = middle - m[2];
  const glm::dvec4 h_far = middle + m[2] * ndc_far;
  RayWay result;
  result.begin = glm::dvec3(h_near) / h_near.w;
  result.way = glm::dvec3(h_far) / h_far.w - result.begin;
  result.length = glm::length(frame.data_from_index * result.way);
  result.world_scale = glm::length(frame.world_from_index * result.way) / result.length;
  return result;
}

// By slabs. A ray in or along a face counts as inside; no 0/0: an axis along which the ray does not
// move only asks whether it is within.
bool RayMaker::clip_to_box(const Frame& frame, const RayWay& way, double& begin, double& end)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double to_lower = frame.lower[axis] - way.begin[axis];
    const double to_upper = frame.upper[axis] - way.begin[axis];
    const double d = way.way[axis];
    if (d == 0.0)
    {
      if (to_lower > 0.0 || to_upper < 0.0)
      {
        return false;
      }
      continue;
    }
    const double a = to_lower / d;
    const double b = to_upper / d;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin < end && std::isfinite(way.length);
}

bool RayMaker::clip_to_planes(const Frame& frame, const RayWay& way, double& begin, double& end)
{
  for (const glm::dvec4& plane : frame.planes)
  {
    const double at_begin = glm::dot(plane, glm::dvec4(way.begin, 1.0));
    const double slope = glm::dot(glm::dvec3(plane), way.way);
    if (slope == 0.0)
    {
      if (at_begin < 0.0)
      {
        return false;
      }
      continue;
    }
    const double crossing = -at_begin / slope;
    (slope > 0.0 ? begin : end) = slope > 0.0 ? std::max(begin, crossing) : std::min(end, crossing);
  }
  return begin < end;
}

void RayMaker::add_regions(const Frame& frame,
  const RayWay& way,
  RayStretch whole,
  std::vector<RayStretch>& parts)
{
  const Cropping& cropping = frame.volume->cropping;
  if (!cropping.enabled)
  {
    parts.push_back(whole);
    return;
  }
  double cuts[8] = { whole.begin, whole.end };
  int count = 2;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (double plane : { cropping.lower[axis], cropping.upper[axis] })
    {
      const double at = (plane - way.begin[axis]) / way.way[axis]; // infinite or NaN: never between
      if (at > whole.begin && at < whole.end)
      {
        cuts[count++] = at;
      }
    }
  }
  std::sort(cuts, cuts + count);
  bool open = false; // whether the last part goes on
  for (int i = 0; i + 1 < count; ++i)
  {
    if (!(cuts[i] < cuts[i + 1]))
    {
      continue;
    }
    const glm::dvec3 middle = way.begin + way.way * (0.5 * (cuts[i] + cuts[i + 1]));
    int region = 0;
    int weight = 1;
    for (int axis = 0; axis < 3; ++axis, weight *= 3)
    {
      const int side = middle[axis] < cropping.lower[axis]    ? 0
                       : middle[axis] <= cropping.upper[axis] ? 1
                                                              : 2;
      region += weight * side;
    }
    if (!(cropping.regions >> region & 1))
    {
      open = false;
      continue;
    }
    if (open)
    {
      parts.back().end = cuts[i + 1];
    }
    else
    {
      parts.push_back({ cuts[i], cuts[i + 1], whole.volumes });
    }
    open = true;
  }
}

void RayMaker::stretches(int x, int y, std::vector<RayStretch>& stretches) const
{
  stretches.clear();
  for (std::size_t k = 0; k < this->Frames.size(); ++k)
  {
    const RayWay way = this->way(x, y, k);
    RayStretch whole{ 0.0, 1.0, std::uint32_t{ 1 } << k };
    if (clip_to_box(this->Frames[k], way, whole.begin, whole.end) &&
        clip_to_planes(this->Frames[k], way, whole.begin, whole.end))
    {
      add_regions(this->Frames[k], way, whole, stretches);
    }
  }
  if (this->Frames.size() == 1 || stretches.size() < 2)
  {
    return;
  }
  // Cut where any volume begins or ends.
  std::vector<double> cuts;
  for (const RayStretch& stretch : stretches)
  {
    cuts.push_back(stretch.begin);
    cuts.push_back(stretch.end);
  }
  std::sort(cuts.begin(), cuts.end());
  std::vector<RayStretch> merged;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
  {
    RayStretch part{ cuts[i], cuts[i + 1], 0 };
    for (const RayStretch& stretch : stretches)
    {
      if (stretch.begin <= part.begin && part.end <= stretch.end)
      {
        part.volumes |= stretch.volumes;
      }
    }
    if (part.volumes && part.begin < part.end)
    {
      merged.push_back(part);
    }
  }
  stretches.swap(merged);
}

RaySegment RayMaker::segment(int x, int y) const
{
  const RayWay way = this->way(x, y);
  double begin = 0.0;
  double end = 1.0;
  return clip_to_box(this->Frames[0], way, begin, end) ? way.part(begin, end) : RaySegment();
}

}
