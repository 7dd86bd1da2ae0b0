// The torso phantom's organs under the diaphragm.
#include "data-generators/hounsfield.h"
#include "data-generators/noise.h"
#include "data-generators/portable_math.h"
#include "data-generators/random.h"
#include "data-generators/shaping.h"
#include "data-generators/signed_distance.h"
#include "data-generators/torso_anatomy.h"

#include <algorithm>
#include <cmath>

namespace brume
{
namespace torso
{

namespace
{

using glm::dvec3;

/// The hollow of the belly and the pelvis, filled with fat around the organs.
double belly(const dvec3& p)
{
  // Half widths and middles go down evenly from the ribs to the pelvis.
  const double low = ramp(p.z, -150.0, -255.0);
  const Girth g{ mix(118.0, 58.0, low), mix(66.0, 50.0, low), mix(9.0, 2.0, low) };
  const double wall = std::max(girth_distance(p, g), -272.0 - p.z);
  const double upper =
    std::max({ under_diaphragm(p) + 3.0, girth_distance(p, rib_girth(p.z)) + 9.0, -60.0 - p.z });
  return smooth_union(std::max(wall, p.z + 5.0), upper, 10.0);
}

double liver(const dvec3& p)
{
  double d = ellipsoid_distance(p, dvec3(62.0, 0.0, -14.0), dvec3(68.0, 78.0, 68.0));
  d = smooth_union(d, ellipsoid_distance(p, dvec3(6.0, 32.0, 4.0), dvec3(62.0, 36.0, 30.0)), 22.0);
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(78.0, 0.0, -62.0), dvec3(34.0, 44.0, 44.0)), 16.0);
  // Cut by the underside, which slants up to the left and goes down 44 mm to the right lobe's tip
  // (its slope stays below 1), and by what it lies against.
  const double left = 0.75 * std::max(62.0 - p.x, 0.0);
  const double underside =
    0.55 * (-46.0 - p.z + left - 44.0 * smooth_ramp(p.x, 62.0, 107.0)) - 0.12 * (p.y - 20.0);
  d = smooth_intersection(d, underside, 8.0);
  d = smooth_intersection(d, std::max(under_diaphragm(p) + 2.0, within_ribs(p) + 2.0), 3.0);
  return smooth_difference(
    d, ellipsoid_distance(p, dvec3(48.0, -46.0, -72.0), dvec3(34.0, 30.0, 52.0)), 8.0);
}

double spleen(const dvec3& p)
{
  double d = ellipsoid_distance(p, dvec3(-92.0, -40.0, -10.0), dvec3(30.0, 38.0, 50.0));
  d = smooth_difference(
    d, ellipsoid_distance(p, dvec3(-58.0, -14.0, -12.0), dvec3(30.0, 32.0, 50.0)), 6.0);
  return smooth_intersection(d, std::max(under_diaphragm(p) + 2.0, within_ribs(p) + 2.0), 3.0);
}

double stomach(const dvec3& p)
{
  double d = ellipsoid_distance(p, dvec3(-56.0, 4.0, -2.0), dvec3(34.0, 38.0, 38.0));
  d = smooth_union(
    d, capsule_distance(p, dvec3(-56.0, 20.0, -20.0), dvec3(-40.0, 44.0, -62.0), 30.0, 24.0), 20.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(-40.0, 44.0, -66.0), dvec3(14.0, 40.0, -70.0), 21.0, 13.0), 14.0);
  return smooth_intersection(d, under_diaphragm(p) + 3.0, 3.0);
}

double kidney(const dvec3& p, const dvec3& centre)
{
  // The upper end leans toward the spine.
  const double side = centre.x > 0.0 ? 1.0 : -1.0;
  const dvec3 q(side * (p.x - centre.x) + 0.16 * (p.z - centre.z), p.y - centre.y, p.z - centre.z);
  const double d = ellipsoid_distance(q, dvec3(0.0), dvec3(27.0, 24.0, 54.0));
  return smooth_difference(
    d, ellipsoid_distance(q, dvec3(-27.0, 12.0, 0.0), dvec3(16.0, 12.0, 17.0)), 8.0);
}

/// The large bowel's course, from the right groin around to the rectum.
std::vector<std::vector<dvec3>> colon()
{
  return { { dvec3(84.0, 24.0, -190.0), dvec3(92.0, 8.0, -140.0), dvec3(90.0, 10.0, -104.0) },
    { dvec3(90.0, 10.0, -104.0),
      dvec3(64.0, 38.0, -104.0),
      dvec3(0.0, 50.0, -112.0),
      dvec3(-56.0, 38.0, -98.0),
      dvec3(-88.0, 4.0, -52.0) },
    { dvec3(-88.0, 4.0, -52.0), dvec3(-96.0, -8.0, -100.0), dvec3(-92.0, 4.0, -170.0) },
    { dvec3(-92.0, 4.0, -170.0),
      dvec3(-64.0, 26.0, -204.0),
      dvec3(-22.0, 8.0, -200.0),
      dvec3(4.0, -22.0, -216.0),
      dvec3(0.0, -48.0, -236.0),
      dvec3(0.0, -46.0, -280.0) } };
}

void paint_bowel(PaintedVolume& torso, std::uint32_t seed)
{
  namespace hu = hounsfield;
  // Loops of small bowel: round cells, each with a wall, a content of its own, and fat between.
  const auto loops = [seed](const dvec3& place, double)
  {
    const dvec3 p = warp(place, 50.0, 14.0, substream(seed, 75));
    const dvec3 q = p / dvec3(36.0, 28.0, 28.0);
    const double n = worley_noise(q, substream(seed, 76));
    const double kind = perlin_noise(p / 34.0, substream(seed, 77));
    const double content = kind > 0.22   ? 0.75 * hu::air
                           : kind > -0.1 ? hu::chyme
                                         : hu::water + 12.0;
    const double folded = content + 18.0 * perlin_noise(p / 5.0, substream(seed, 78));
    const double wall = mix(folded, hu::muscle + 40.0, smooth_ramp(n, 0.44, 0.50));
    return mix(wall, hu::fat + 10.0, smooth_ramp(n, 0.56, 0.62));
  };
  torso.paint(
    [](const dvec3& p)
    {
      const double d = ellipsoid_distance(p, dvec3(-2.0, 34.0, -156.0), dvec3(90.0, 50.0, 78.0));
      return smooth_intersection(d, belly(p) + 4.0, 4.0);
    },
    { { 0.0, loops } });

  // Large bowel: pouched, with gas above and what is left of meals below (the patient lies).
  const auto pouches = [](const dvec3& p)
  {
    const double wave = portable_sincos(0.24 * p.z + 0.12 * p.x).sine;
    return 2.0 * wave * wave;
  };
  const auto held = [seed](const dvec3& p, double depth)
  {
    const double n = fbm(p / 9.0, substream(seed, 79), { 3, 2.0, 0.6 });
    const double where = perlin_noise(p / 60.0, substream(seed, 80));
    const double faeces = mix(-180.0, 60.0, smooth_ramp(n, -0.3, 0.2));
    const double gas = smooth_ramp(where + 0.02 * depth, 0.02, 0.12);
    return mix(faeces, hu::air, gas);
  };
  double radius = 23.0;
  for (const std::vector<dvec3>& course : colon())
  {
    torso.paint([course, radius, pouches](const dvec3& p)
      { return 0.9 * (tube_distance(p, course, radius) + pouches(p)); },
      { { 0.0, hu::muscle + 20.0 }, { 2.6, held } });
    radius -= 2.0;
  }
}

void paint_liver_vessels(PaintedVolume& torso)
{
  namespace hu = hounsfield;
  const auto branch = [&](const std::vector<dvec3>& course, double radius)
  {
    torso.paint([course, radius](const dvec3& p)
      { return std::max(tube_distance(p, course, radius), liver(p) + 4.0); },
      hu::portal_vein);
  };
  // The portal vein comes in from below, the liver's own veins leave at the top, behind.
  branch({ dvec3(22.0, 14.0, -40.0),
           dvec3(46.0, 6.0, -24.0),
           dvec3(78.0, 10.0, -20.0),
           dvec3(104.0, 8.0, -10.0) },
    4.6);
  branch({ dvec3(78.0, 10.0, -20.0), dvec3(88.0, -30.0, -34.0), dvec3(100.0, -44.0, -50.0) }, 3.2);
  branch({ dvec3(78.0, 10.0, -20.0), dvec3(84.0, 40.0, 4.0) }, 3.0);
  branch({ dvec3(46.0, 6.0, -24.0), dvec3(24.0, 28.0, -8.0), dvec3(-14.0, 38.0, 6.0) }, 3.4);
  branch({ dvec3(30.0, 0.0, 34.0), dvec3(62.0, -8.0, 18.0), dvec3(96.0, -14.0, 0.0) }, 4.0);
  branch({ dvec3(30.0, 2.0, 34.0), dvec3(54.0, 30.0, 14.0), dvec3(68.0, 50.0, -14.0) }, 3.6);
  branch({ dvec3(28.0, 4.0, 32.0), dvec3(4.0, 26.0, 20.0), dvec3(-24.0, 36.0, 10.0) }, 3.4);
}

}

void paint_belly(PaintedVolume& torso, std::uint32_t seed)
{
  namespace hu = hounsfield;
  torso.paint(
    [](const dvec3& p) {
      return std::max({ under_diaphragm(p), within_ribs(p), -40.0 - p.z });
    },
    hu::muscle); // the diaphragm
  torso.paint(belly, hu::fat);

  // The muscles along the spine, seen from within.
  torso.paint(
    [](const dvec3& place)
    {
      const dvec3 p = mirrored(place);
      return smooth_union(
        capsule_distance(p, dvec3(28.0, -34.0, -40.0), dvec3(44.0, -26.0, -150.0), 13.0, 22.0),
        capsule_distance(p, dvec3(44.0, -26.0, -150.0), dvec3(74.0, 32.0, -262.0), 22.0, 17.0),
        6.0);
    },
    hu::muscle + 5.0);

  torso.paint(liver, hu::liver);
  paint_liver_vessels(torso);
  torso.paint([](const dvec3& p)
    { return ellipsoid_distance(p, dvec3(50.0, 44.0, -62.0), dvec3(14.0, 22.0, 16.0)); },
    { { 0.0, hu::muscle }, { 1.6, hu::water + 10.0 } });
  torso.paint(spleen, hu::spleen);

  // Fluid with a level surface, air in front of it.
  torso.paint(stomach,
    { { 0.0, hu::muscle + 20.0 }, { 4.0, [](const dvec3& p, double) {
                                     return mix(hu::chyme, hu::air, smooth_ramp(p.y, 40.0, 42.0));
                                   } } });
  torso.paint(
    [](const dvec3& p)
    {
      return tube_distance(p,
        { dvec3(20.0, 38.0, -72.0),
          dvec3(44.0, 22.0, -62.0),
          dvec3(46.0, 10.0, -100.0),
          dvec3(10.0, 16.0, -116.0),
          dvec3(-28.0, 20.0, -98.0) },
        12.0);
    },
    { { 0.0, hu::muscle + 30.0 }, { 2.6, hu::chyme } });
  torso.paint(
    [](const dvec3& p)
    {
      return smooth_union(
        capsule_distance(p, dvec3(30.0, 16.0, -78.0), dvec3(0.0, 22.0, -56.0), 14.0, 9.0),
        capsule_distance(p, dvec3(0.0, 22.0, -56.0), dvec3(-66.0, -20.0, -36.0), 9.0, 8.0),
        5.0);
    },
    hu::pancreas);

  for (const dvec3& centre : { dvec3(64.0, -36.0, -84.0), dvec3(-64.0, -36.0, -70.0) })
  {
    torso.paint([centre](const dvec3& p) { return kidney(p, centre); },
      { { 0.0, hu::kidney_rind },
        { 7.0,
          [seed](const dvec3& p, double)
          {
            const double n = perlin_noise(p / 9.0, substream(seed, 81));
            return mix(hu::kidney_marrow, hu::kidney_rind, smooth_ramp(n, 0.05, 0.2));
          } } });
    const double side = centre.x > 0.0 ? 1.0 : -1.0;
    const dvec3 pelvis = centre + dvec3(-16.0 * side, 8.0, 0.0);
    torso.paint([pelvis](const dvec3& p)
      { return ellipsoid_distance(p, pelvis, dvec3(8.0, 7.0, 15.0)); },
      hu::water + 8.0);
  }

  paint_bowel(torso, seed);
  torso.paint([](const dvec3& p)
    { return ellipsoid_distance(p, dvec3(0.0, 30.0, -246.0), dvec3(36.0, 30.0, 26.0)); },
    { { 0.0, hu::muscle }, { 3.0, hu::water + 8.0 } });
}

}
}
