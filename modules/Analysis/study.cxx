#include "study.h"

#include "image_filters.h"
#include "pareto_front.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brume
{

namespace
{

constexpr double endless = std::numeric_limits<double>::infinity();

/// The front of all points by one of their errors: the points' indices.
template <class Error>
std::vector<std::size_t> front_by(const Study& study, const Error& error)
{
  std::vector<Cost> costs;
  for (const StudyPoint& point : study.points)
  {
    const bool drawn = point.skipped.empty();
    costs.push_back({ drawn ? point.timing.median : endless, drawn ? error(point) : endless });
  }
  return pareto_front(costs);
}

}

void measure_point(StudyPoint& point, const Study& study)
{
  const Picture& truth = study.truth.truth.picture;
  const TruthHalves& halves = study.truth.halves;
  point.errors = measure_against(point.picture, truth, halves, study.truth.noise, point.by_chance);
  point.errors.perceptual = perceptual_difference(point.picture, truth);
  point.by_depth = errors_by_class(point.picture, truth, halves, study.depths, point.by_chance);
  point.by_outline = errors_by_class(point.picture, truth, halves, study.outlines, point.by_chance);
}

void finish(Study& study)
{
  for (const std::size_t i : front_by(
         study, [](const StudyPoint& p) { return p.errors.rms_limited ? p.errors.rms_upper : p.errors.rms; }))
  {
    study.points[i].on_front = true;
  }
  for (const std::size_t i :
    front_by(study, [](const StudyPoint& p) { return p.errors.measured.percentile_999; }))
  {
    study.points[i].on_percentile_front = true;
  }
  for (StudyPoint& point : study.points)
  {
    for (const StudyPoint& finest : study.points)
    {
      if (finest.finest && finest.skipped.empty() && point.skipped.empty() &&
        finest.knob == point.knob && finest.mapper == point.mapper && &finest != &point)
      {
        point.own = measure(point.picture, finest.picture);
        point.own_by_depth = errors_by_class(point.picture, finest.picture, {}, study.depths);
        point.own_by_outline = errors_by_class(point.picture, finest.picture, {}, study.outlines);
      }
    }
  }
}

const StudyPoint* cheapest_within(const Study& study, double tolerance, const StudyPoint* apart_from)
{
  const StudyPoint* cheapest = nullptr;
  for (const StudyPoint& point : study.points)
  {
    if (point.skipped.empty() && &point != apart_from &&
      share_within(point.picture, study.truth.truth.picture, tolerance) >= 0.999 &&
      (!cheapest || point.timing.median < cheapest->timing.median))
    {
      cheapest = &point;
    }
  }
  return cheapest;
}

std::vector<const StudyPoint*> front_of(const Study& study)
{
  std::vector<const StudyPoint*> front;
  for (const StudyPoint& point : study.points)
  {
    if (point.on_front)
    {
      front.push_back(&point);
    }
  }
  std::sort(front.begin(), front.end(), [](const StudyPoint* a, const StudyPoint* b)
    { return a->timing.median < b->timing.median; });
  return front;
}

}
