// The head phantom's brain, the fluid and vessels around and in it, and the eyes.
#include "data-generators/head_anatomy.h"

#include "data-generators/hounsfield.h"
#include "data-generators/noise.h"
#include "data-generators/random.h"
#include "data-generators/shaping.h"
#include "data-generators/signed_distance.h"

#include <cmath>

namespace brume
{
namespace head
{

namespace
{

using glm::dvec3;

double cerebellum(const dvec3& place)
{
  const dvec3 p = mirrored(place);
  const double d =
    smooth_union(ellipsoid_distance(p, dvec3(21.0, -54.0, -4.0), dvec3(31.0, 31.0, 20.0)),
      ellipsoid_distance(p, dvec3(0.0, -54.0, -2.0), dvec3(12.0, 22.0, 16.0)),
      6.0);
  return smooth_intersection(d, cranial_cavity(p) + 3.0, 4.0);
}

double ventricles(const dvec3& place)
{
  const dvec3 p = mirrored(place);
  // Each lateral ventricle: a horn forward, the body, a horn behind and one into the temple.
  double d = capsule_distance(p, dvec3(5.0, 10.0, 62.0), dvec3(11.0, 34.0, 54.0), 4.2, 3.4);
  d = smooth_union(d,
    tube_distance(
      p, { dvec3(5.0, 10.0, 62.0), dvec3(9.0, -18.0, 64.0), dvec3(19.0, -44.0, 54.0) }, 4.4),
    4.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(19.0, -44.0, 54.0), dvec3(20.0, -66.0, 48.0), 4.8, 2.2), 4.0);
  d = smooth_union(d,
    tube_distance(
      p, { dvec3(20.0, -46.0, 52.0), dvec3(30.0, -28.0, 28.0), dvec3(33.0, 2.0, 18.0) }, 2.2),
    3.0);
  const double third = box_distance(p, dvec3(0.0, -2.0, 40.0), dvec3(2.2, 14.0, 11.0), 1.8);
  const double fourth = tube_distance(
    p, { dvec3(0.0, -12.0, 32.0), dvec3(0.0, -26.0, 16.0), dvec3(0.0, -31.0, -2.0) }, 1.2);
  const double fourth_body = ellipsoid_distance(p, dvec3(0.0, -30.0, 0.0), dvec3(7.0, 5.0, 9.0));
  return std::min({ d, third, fourth, fourth_body });
}

double brain_stem(const dvec3& place)
{
  const dvec3 p = mirrored(place);
  double d = capsule_distance(p, dvec3(0.0, -17.0, 10.0), dvec3(0.0, -28.0, -26.0), 10.0, 8.0);
  d = smooth_union(d, ellipsoid_distance(p, dvec3(0.0, -13.0, 2.0), dvec3(15.0, 11.0, 12.0)), 5.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(5.0, -14.0, 12.0), dvec3(14.0, -6.0, 30.0), 7.0, 9.0), 5.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(12.0, -20.0, 2.0), dvec3(24.0, -42.0, -2.0), 6.0, 5.0), 4.0);
  return smooth_union(
    d, capsule_distance(p, dvec3(0.0, -28.0, -26.0), dvec3(0.0, -36.0, -170.0), 6.5, 6.0), 4.0);
}

/// Grey and white matter by the distance to the outside and to the nearest furrow. A furrow is
/// where a warped noise passes 0: a winding sheet, open at the surface and closing inward.
PaintedVolume::Texture folded_cortex(std::uint32_t seed, double edge)
{
  namespace hu = hounsfield;
  const double soft = std::max(edge, 0.8);
  return [=](const dvec3& p, double depth)
  {
    if (depth > 24.0)
    {
      return hu::white_matter;
    }
    const double size = 15.0;
    const dvec3 at = warp(p, 22.0, 7.0, substream(seed, 20));
    // The slope of the noise near 0 is about 1.5 a feature, so this is about a distance.
    const double furrow = std::fabs(perlin_noise(at / size, substream(seed, 21))) * size / 1.5;
    const double half_width = 0.9 * ramp(depth, 17.0, 2.0) + (depth < 17.0 ? 0.0 : -2.0);
    const double outside = std::min(depth, depth < 17.0 ? furrow - half_width : 24.0 - depth + 3.0);
    const double wall =
      depth < 20.0 ? std::min(depth, furrow + 0.6 * std::max(depth - 15.0, 0.0)) : depth;
    const double matter =
      mix(hu::grey_matter, hu::white_matter, smooth_ramp(wall, 3.0 - 0.5 * soft, 3.0 + 0.5 * soft));
    return mix(hu::cerebrospinal_fluid, matter, smooth_ramp(outside, -0.5 * soft, 0.5 * soft));
  };
}

/// The leaves of the cerebellum: thin shells around its heart, grey on white.
PaintedVolume::Texture leaves(std::uint32_t seed)
{
  namespace hu = hounsfield;
  return [=](const dvec3& place, double depth)
  {
    const dvec3 p = mirrored(place);
    const dvec3 from = p - dvec3(12.0, -34.0, -2.0);
    const double along = glm::length(dvec3(0.5 * from.x, from.y, 1.6 * from.z)) / 3.4 +
                         1.2 * perlin_noise(p / 12.0, substream(seed, 22));
    const double wave = std::fabs(2.0 * (along - std::floor(along)) - 1.0);
    const double grey = mix(hu::white_matter, hu::grey_matter, smooth_ramp(wave, 0.3, 0.6));
    const double leaf = mix(grey, hu::cerebrospinal_fluid + 8.0, smooth_ramp(wave, 0.88, 1.0));
    return mix(leaf, hu::white_matter, smooth_ramp(depth, 8.0, 13.0));
  };
}

struct Vessel
{
  std::vector<dvec3> course;
  double radius;
};

/// The arteries of the patient's right, each a course of straight pieces; the left has its mirror.
std::vector<Vessel> arteries()
{
  return {
    // Inner carotid, up the neck and through its bend at the skull's base.
    { { dvec3(26.0, 2.0, -170.0),
        dvec3(25.0, 0.0, -100.0),
        dvec3(27.0, -4.0, -60.0),
        dvec3(25.0, 2.0, -26.0) },
      2.9 },
    { { dvec3(25.0, 2.0, -26.0),
        dvec3(15.0, 8.0, -8.0),
        dvec3(12.0, 20.0, 1.0),
        dvec3(12.0, 24.0, 8.0),
        dvec3(12.0, 17.0, 13.0) },
      2.3 },
    // Middle cerebral artery and its branches over the island.
    { { dvec3(12.0, 17.0, 13.0), dvec3(24.0, 19.0, 16.0), dvec3(40.0, 15.0, 19.0) }, 1.7 },
    { { dvec3(40.0, 15.0, 19.0),
        dvec3(46.0, 8.0, 32.0),
        dvec3(54.0, -8.0, 46.0),
        dvec3(52.0, -34.0, 60.0) },
      1.3 },
    { { dvec3(46.0, 8.0, 32.0), dvec3(53.0, 12.0, 48.0), dvec3(50.0, 8.0, 68.0) }, 1.1 },
    { { dvec3(40.0, 15.0, 19.0), dvec3(52.0, -4.0, 30.0), dvec3(56.0, -30.0, 36.0) }, 1.1 },
    // Anterior cerebral artery, around the front of the corpus callosum and back over it.
    { { dvec3(12.0, 17.0, 13.0),
        dvec3(3.0, 24.0, 17.0),
        dvec3(2.4, 38.0, 30.0),
        dvec3(2.4, 47.0, 50.0),
        dvec3(2.4, 38.0, 70.0),
        dvec3(2.4, 10.0, 78.0),
        dvec3(2.4, -24.0, 78.0) },
      1.3 },
    { { dvec3(2.4, 47.0, 50.0), dvec3(2.6, 52.0, 70.0), dvec3(2.6, 36.0, 90.0) }, 1.0 },
    // Vertebral arteries, joined into the basilar, parted again into the posterior cerebral ones.
    { { dvec3(20.0, -24.0, -170.0),
        dvec3(21.0, -24.0, -60.0),
        dvec3(24.0, -34.0, -40.0),
        dvec3(10.0, -30.0, -32.0),
        dvec3(0.0, -14.0, -18.0) },
      1.8 },
    { { dvec3(0.0, -14.0, -18.0), dvec3(0.0, 1.0, 12.0) }, 1.7 },
    { { dvec3(0.0, 1.0, 12.0),
        dvec3(11.0, -4.0, 16.0),
        dvec3(19.0, -18.0, 20.0),
        dvec3(14.0, -44.0, 28.0),
        dvec3(10.0, -76.0, 36.0) },
      1.3 },
    { { dvec3(12.0, 17.0, 12.0), dvec3(10.0, -3.0, 15.0) }, 0.9 },
    // Outer carotid: to the temple in front of the ear.
    { { dvec3(25.0, 0.0, -100.0),
        dvec3(40.0, 4.0, -76.0),
        dvec3(58.0, -2.0, -40.0),
        dvec3(66.0, 6.0, -8.0),
        dvec3(70.8, 10.0, 20.0),
        dvec3(64.0, 22.0, 46.0) },
      1.1 },
  };
}

double veins(const dvec3& p)
{
  // The upper sinus follows the vault in the middle; it drains to the patient's right, as most do.
  const double crest = std::fabs(cranial_cavity(p) + 2.6);
  const double upper =
    p.z > 34.0 ? std::sqrt(p.x * p.x + crest * crest) - mix(1.5, 3.4, ramp(p.y, 60.0, -80.0))
               : std::sqrt(p.x * p.x + crest * crest + (p.z - 34.0) * (p.z - 34.0)) - 3.4;
  const double right = tube_distance(p,
    { dvec3(0.0, -86.0, 32.0),
      dvec3(20.0, -83.0, 16.0),
      dvec3(42.0, -62.0, 10.0),
      dvec3(47.0, -40.0, 2.0),
      dvec3(38.0, -26.0, -14.0),
      dvec3(30.0, -10.0, -34.0),
      dvec3(33.0, -6.0, -170.0) },
    3.4);
  const double left = tube_distance(p,
    { dvec3(0.0, -86.0, 32.0),
      dvec3(-20.0, -83.0, 16.0),
      dvec3(-42.0, -62.0, 10.0),
      dvec3(-47.0, -40.0, 2.0),
      dvec3(-38.0, -26.0, -14.0),
      dvec3(-30.0, -10.0, -34.0),
      dvec3(-33.0, -6.0, -170.0) },
    2.3);
  const double straight =
    capsule_distance(p, dvec3(0.0, -84.0, 32.0), dvec3(0.0, -38.0, 46.0), 2.2, 1.6);
  return std::min(std::min(upper, straight), std::min(left, right));
}

}

void paint_eyes(PaintedVolume& head)
{
  namespace hu = hounsfield;
  const dvec3 centre(32.0, 70.0, 2.0);
  const auto ball = [=](const dvec3& p) { return sphere_distance(mirrored(p), centre, 12.0); };
  head.paint(
    [](const dvec3& p) // the fat around the eye, behind its lids
    {
      const dvec3 q = mirrored(p);
      return std::max(
        std::min(ellipsoid_distance(q, dvec3(32.0, 62.0, 2.0), dvec3(16.0, 18.0, 14.5)),
          capsule_distance(q, dvec3(31.0, 60.0, 2.0), dvec3(15.5, 29.0, 2.0), 13.5, 3.0)),
        q.y - 73.0);
    },
    hu::fat);
  head.paint(
    [](const dvec3& p) // four straight muscles, and the nerve among them
    {
      const dvec3 q = mirrored(p);
      const dvec3 tip(16.0, 32.0, 2.0);
      return std::min({ capsule_distance(q, dvec3(43.0, 64.0, 2.0), tip, 2.0, 1.5),
        capsule_distance(q, dvec3(20.5, 64.0, 2.0), tip, 2.0, 1.5),
        capsule_distance(q, dvec3(31.0, 64.0, 13.5), tip, 2.0, 1.5),
        capsule_distance(q, dvec3(31.0, 64.0, -9.5), tip, 2.0, 1.5) });
    },
    hu::muscle);
  head.paint(
    [](const dvec3& p)
    {
      return tube_distance(mirrored(p),
        { dvec3(31.0, 59.0, 2.0), dvec3(17.0, 34.0, 3.0), dvec3(5.0, 18.0, 12.0) },
        2.1);
    },
    hu::white_matter + 8.0);
  head.paint(ball, { { 0.0, hu::sclera }, { 1.1, hu::vitreous } });
  head.paint([](const dvec3& p)
    { return ellipsoid_distance(mirrored(p), dvec3(32.0, 78.0, 2.0), dvec3(4.6, 2.2, 4.6)); },
    hu::lens);
}

void paint_brain(PaintedVolume& head, std::uint32_t seed, double edge)
{
  namespace hu = hounsfield;
  head.paint(
    [](const dvec3& p) // the sac that holds brain and cord
    {
      return std::min(cranial_cavity(p),
        capsule_distance(p, dvec3(0.0, -31.0, -10.0), dvec3(0.0, -36.0, -170.0), 10.5, 9.0));
    },
    { { 0.0, hu::dura }, { 0.9, hu::cerebrospinal_fluid } });

  // The cerebrum, in two halves with a cleft between, above a slanting floor.
  const auto cerebrum = [](const dvec3& place)
  {
    const dvec3 p = mirrored(place);
    const double floor = 0.96 * (14.0 - p.z) - 0.26 * (p.y + 20.0);
    const double behind = p.y < -30.0 ? floor : floor - 2.0 * (p.y + 30.0);
    return smooth_intersection(
      smooth_intersection(cranial_cavity(p) + 3.0, 1.6 - p.x, 2.0), behind / 2.3, 5.0);
  };
  head.paint(cerebrum, { { 0.0, folded_cortex(seed, edge) } });
  // What joins the halves, and the grey kernels within.
  head.paint(
    [](const dvec3& p)
    {
      return tube_distance(dvec3(0.35 * p.x, p.y, p.z),
        { dvec3(0.0, 30.0, 54.0),
          dvec3(0.0, 36.0, 60.0),
          dvec3(0.0, 26.0, 69.0),
          dvec3(0.0, -10.0, 72.0),
          dvec3(0.0, -34.0, 66.0),
          dvec3(0.0, -40.0, 60.0) },
        4.0);
    },
    hu::white_matter);
  head.paint(
    [](const dvec3& place)
    {
      const dvec3 p = mirrored(place);
      return std::min({ ellipsoid_distance(p, dvec3(11.0, -12.0, 46.0), dvec3(8.0, 15.0, 9.0)),
        ellipsoid_distance(p, dvec3(14.0, 20.0, 54.0), dvec3(5.0, 13.0, 8.0)),
        ellipsoid_distance(p, dvec3(26.0, 6.0, 42.0), dvec3(6.5, 19.0, 12.0)) });
    },
    hu::grey_matter);
  head.paint(cerebellum, { { 0.0, leaves(seed) } });
  head.paint(brain_stem, hu::white_matter + 4.0);
  head.paint(ventricles, hu::cerebrospinal_fluid);
  head.paint(
    [](const dvec3& place)
    {
      const dvec3 p = mirrored(place);
      return std::min(sphere_distance(p, dvec3(0.0, -30.0, 44.0), 2.4),
        ellipsoid_distance(p, dvec3(19.5, -47.0, 52.0), dvec3(2.2, 3.4, 2.2)));
    },
    hu::calcification);
  // The falx hangs between the halves; its lower edge arches over the corpus callosum.
  head.paint(
    [](const dvec3& p)
    {
      const double arch = ellipsoid_distance(p, dvec3(0.0, -8.0, 40.0), dvec3(40.0, 56.0, 44.0));
      return std::max({ std::fabs(p.x) - 0.8, cranial_cavity(p), -arch, 30.0 - p.z });
    },
    hu::dura);
  head.paint(veins, hu::contrast_vein);
  for (const Vessel& vessel : arteries())
  {
    head.paint([vessel](const dvec3& p)
      { return tube_distance(mirrored(p), vessel.course, vessel.radius); },
      hu::contrast_blood);
  }
}

}
}
