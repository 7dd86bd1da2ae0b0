#include "Transport/reference_ray.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace brume
{

bool PixelRay::empty() const
{
  return std::all_of(this->volumes.begin(),
    this->volumes.end(),
    [](const VolumeRay& ray) { return ray.parts.empty(); });
}

std::vector<RayInterval> PixelRay::intervals() const
{
  std::vector<double> ends;
  for (const VolumeRay& ray : this->volumes)
  {
    for (const RayPart& part : ray.parts)
    {
      ends.push_back(part.from);
      ends.push_back(part.to);
    }
  }
  std::sort(ends.begin(), ends.end());
  std::vector<RayInterval> result;
  for (std::size_t i = 1; i < ends.size(); ++i)
  {
    RayInterval interval{ ends[i - 1], ends[i], {} };
    if (!(interval.from < interval.to))
    {
      continue;
    }
    const double middle = 0.5 * (interval.from + interval.to);
    for (std::size_t v = 0; v < this->volumes.size(); ++v)
    {
      for (const RayPart& part : this->volumes[v].parts)
      {
        if (part.from <= middle && middle <= part.to)
        {
          interval.volumes.push_back(static_cast<int>(v));
          break;
        }
      }
    }
    if (!interval.volumes.empty())
    {
      result.push_back(interval);
    }
  }
  return result;
}

RayFrame::RayFrame(const Volume& the_volume, const glm::dmat4& clip_from_world)
  : volume(the_volume)
  , data_from_index(the_volume.data_from_index)
  , world_from_index(the_volume.world_from_data * the_volume.data_from_index)
{
  this->index_from_clip = glm::inverse(clip_from_world * this->world_from_index);
  this->index_from_world = glm::inverse(this->world_from_index);
  for (const glm::dvec4& plane : the_volume.clipping_planes)
  {
    this->planes.push_back(glm::transpose(this->world_from_index) * plane);
  }
}

ReferenceRays::ReferenceRays(const Scene& scene)
  : ReferenceRays(scene, 1, 1)
{
}

ReferenceRays::ReferenceRays(const Scene& scene, int width, int height)
  : TheScene(scene)
  , Width(width)
  , Height(height)
{
  std::vector<glm::dvec3> corners;
  for (const Volume& volume : scene.volumes)
  {
    this->Frames.emplace_back(volume, scene.camera.clip_from_world);
    for (int corner = 0; corner < 8; ++corner)
    {
      glm::dvec4 place(1.0);
      for (int axis = 0; axis < 3; ++axis)
      {
        place[axis] = corner >> axis & 1 ? volume.grid.upper(axis) : volume.grid.lower(axis);
      }
      corners.emplace_back(this->Frames.back().world_from_index * place);
    }
  }
  if (has_fog(scene))
  {
    this->Fog = std::make_unique<FogModel>(scene);
    this->FogWays = std::make_unique<FogRays>(scene, *this->Fog, width, height);
  }
  glm::dvec3 lower = corners.front();
  glm::dvec3 upper = corners.front();
  for (const glm::dvec3& corner : corners)
  {
    lower = glm::min(lower, corner);
    upper = glm::max(upper, corner);
  }
  this->Centre = 0.5 * (lower + upper);
  for (const glm::dvec3& corner : corners)
  {
    this->Radius = std::max(this->Radius, glm::distance(corner, this->Centre));
  }
}

PixelRay ReferenceRays::ray(int x, int y) const
{
  const double ndc_x = (2.0 * x + 1.0) / this->Width - 1.0;
  const double ndc_y = (2.0 * y + 1.0) / this->Height - 1.0;
  double ndc_far = 1.0;
  if (!this->TheScene.surface_depth.empty())
  {
    const std::size_t pixel = static_cast<std::size_t>(y) * this->Width + x;
    ndc_far = std::min(ndc_far, double(this->TheScene.surface_depth[pixel]));
  }
  PixelRay result;
  result.volumes.resize(this->Frames.size());
  for (std::size_t v = 0; v < this->Frames.size(); ++v)
  {
    const RayFrame& frame = this->Frames[v];
    const glm::dvec4 h_near = frame.index_from_clip * glm::dvec4(ndc_x, ndc_y, -1.0, 1.0);
    const glm::dvec4 h_far = frame.index_from_clip * glm::dvec4(ndc_x, ndc_y, ndc_far, 1.0);
    VolumeRay& ray = result.volumes[v];
    ray.begin = glm::dvec3(h_near) / h_near.w;
    ray.along = glm::dvec3(h_far) / h_far.w - ray.begin;
    ray.length = glm::length(frame.data_from_index * ray.along);
    result.world_begin = glm::dvec3(frame.world_from_index * glm::dvec4(ray.begin, 1.0));
    result.world_along = glm::dmat3(frame.world_from_index) * ray.along;
    result.world_length = glm::length(result.world_along);
    if (ndc_far > -1.0 && std::isfinite(ray.length))
    {
      frame.find_parts(ray);
    }
  }
  if (this->FogWays)
  {
    result.fog = this->FogWays->ray(x, y);
    result.fog_near_plane = this->FogWays->near_plane(x, y, result.fog);
    result.fog_end = this->FogWays->end(x, y, result.fog);
  }
  return result;
}

PixelRay ReferenceRays::between(const glm::dvec3& begin, const glm::dvec3& along) const
{
  PixelRay result;
  result.world_begin = begin;
  result.world_along = along;
  result.world_length = glm::length(along);
  result.volumes.resize(this->Frames.size());
  for (std::size_t v = 0; v < this->Frames.size(); ++v)
  {
    const RayFrame& frame = this->Frames[v];
    VolumeRay& ray = result.volumes[v];
    ray.begin = glm::dvec3(frame.index_from_world * glm::dvec4(begin, 1.0));
    ray.along = glm::dmat3(frame.index_from_world) * along;
    ray.length = glm::length(frame.data_from_index * ray.along);
    frame.find_parts(ray);
  }
  return result;
}

void RayFrame::find_parts(VolumeRay& ray) const
{
  RayPart whole{ 0.0, 1.0 };
  // Half spaces offset + s · slope ≥ 0. Where a ray stands still, it is inside or not.
  const auto keep = [&](double offset, double slope)
  {
    if (slope == 0.0)
    {
      whole.to = offset >= 0.0 ? whole.to : whole.from;
    }
    else if (slope > 0.0)
    {
      whole.from = std::max(whole.from, -offset / slope);
    }
    else
    {
      whole.to = std::min(whole.to, -offset / slope);
    }
  };
  for (int axis = 0; axis < 3; ++axis)
  {
    keep(ray.begin[axis] - this->volume.grid.lower(axis), ray.along[axis]);
    keep(this->volume.grid.upper(axis) - ray.begin[axis], -ray.along[axis]);
  }
  for (const glm::dvec4& plane : this->planes)
  {
    keep(glm::dot(plane, glm::dvec4(ray.begin, 1.0)), glm::dot(glm::dvec3(plane), ray.along));
  }
  if (!(whole.from < whole.to))
  {
    return;
  }
  const Cropping& cropping = this->volume.cropping;
  if (!cropping.enabled)
  {
    ray.parts.push_back(whole);
    return;
  }
  std::vector<double> cuts{ whole.from, whole.to };
  for (int axis = 0; axis < 3; ++axis)
  {
    for (double plane : { cropping.lower[axis], cropping.upper[axis] })
    {
      const double s = (plane - ray.begin[axis]) / ray.along[axis];
      if (s > whole.from && s < whole.to)
      {
        cuts.push_back(s);
      }
    }
  }
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 1; i < cuts.size(); ++i)
  {
    const glm::dvec3 middle = ray.place(0.5 * (cuts[i - 1] + cuts[i]));
    if (!cropping.draws(middle) || !(cuts[i - 1] < cuts[i]))
    {
      continue;
    }
    if (!ray.parts.empty() && ray.parts.back().to == cuts[i - 1])
    {
      ray.parts.back().to = cuts[i];
    }
    else
    {
      ray.parts.push_back({ cuts[i - 1], cuts[i] });
    }
  }
}

CellWalk::CellWalk(const RayPart& part)
  : Part(part)
  , At(part.from)
{
}

void CellWalk::add(const VolumeRay& ray, const Volume& volume)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    // Trilinear cells end at voxels; the nearest voxel's, and those of a mask, half-way between.
    for (double offset : { 0.0, 0.5 })
    {
      const bool ends_here =
        offset == 0.0 ? volume.grid.linear : !volume.grid.linear || volume.mask.labels != nullptr;
      if (!ends_here || ray.along[axis] == 0.0)
      {
        continue;
      }
      Cut cut{ ray.begin[axis], ray.along[axis], offset, 0.0, 0.0 };
      const double start = cut.begin + cut.along * this->At - offset;
      cut.border = cut.along > 0.0 ? std::floor(start) + 1.0 : std::ceil(start) - 1.0;
      cut.next = (cut.border + offset - cut.begin) / cut.along;
      this->Cuts.push_back(cut);
    }
  }
}

bool CellWalk::next(RayPart& stretch)
{
  if (this->At >= this->Part.to)
  {
    return false;
  }
  stretch = { this->At, this->Part.to };
  for (const Cut& cut : this->Cuts)
  {
    stretch.to = std::min(stretch.to, cut.next);
  }
  for (Cut& cut : this->Cuts)
  {
    if (cut.next <= stretch.to)
    {
      cut.border += cut.along > 0.0 ? 1.0 : -1.0;
      cut.next = (cut.border + cut.offset - cut.begin) / cut.along;
    }
  }
  stretch.to = std::max(stretch.from, stretch.to);
  this->At = stretch.to;
  return true;
}

}
