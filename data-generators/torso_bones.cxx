// The torso phantom's bones.
#include "data-generators/hounsfield.h"
#include "data-generators/noise.h"
#include "data-generators/random.h"
#include "data-generators/shaping.h"
#include "data-generators/signed_distance.h"
#include "data-generators/torso_anatomy.h"

#include <cmath>

namespace brume
{
namespace torso
{

namespace
{

using glm::dvec3;

/// A vertebra at rest: middle of its body at the origin, up along z.
struct Vertebra
{
  double z;
  double half_width, half_depth, half_height; ///< of the body
  double spine_drop;                          ///< of the tip of the spinous process
  double wing;                                ///< reach of the transverse processes
};

std::vector<Vertebra> vertebrae()
{
  std::vector<Vertebra> all;
  for (int n = 0; n < 3; ++n) // sixth and seventh of the neck, and one that the box cuts
  {
    all.push_back({ 234.0 + 18.5 * n, 14.0, 9.0, 7.0, 6.0, 28.0 });
  }
  for (int n = 0; n < 12; ++n) // of the chest, T1 to T12
  {
    const double t = n / 11.0;
    all.push_back({ 214.0 - 20.9 * n,
      mix(15.0, 21.0, t),
      mix(10.0, 16.0, t),
      mix(8.0, 11.5, t),
      mix(20.0, 12.0, std::fabs(2.0 * t - 0.9)),
      mix(34.0, 26.0, t) });
  }
  for (int n = 0; n < 5; ++n) // of the loins, L1 to L5
  {
    const double t = n / 4.0;
    all.push_back({ -43.0 - 31.5 * n, mix(22.0, 25.0, t), mix(16.5, 17.5, t), 13.0, 4.0, 40.0 });
  }
  return all;
}

/// The body: an upright elliptical disc, waisted.
double vertebral_body(const dvec3& p, const Vertebra& v)
{
  const double waist = 1.0 - 0.1 * (1.0 - saturate((p.z / v.half_height) * (p.z / v.half_height)));
  const double round = girth_distance(p, { waist * v.half_width, waist * v.half_depth, 0.0 });
  return smooth_intersection(round, std::fabs(p.z) - v.half_height, 3.0);
}

double vertebra_distance(const dvec3& place, const Vertebra& v)
{
  dvec3 p = mirrored(place);
  p.y -= spine_course(v.z);
  p.z -= v.z;
  double d = vertebral_body(p, v);
  const double canal = -v.half_depth - 8.0; // its middle
  // Pedicle, lamina, transverse and spinous process, joints above and below.
  d = smooth_union(d,
    capsule_distance(
      p, dvec3(11.0, -v.half_depth + 4.0, 2.0), dvec3(14.0, canal - 2.0, 1.0), 4.2, 4.2),
    3.0);
  d = smooth_union(d,
    capsule_distance(p, dvec3(14.0, canal - 2.0, 0.0), dvec3(2.0, canal - 14.0, -2.0), 3.8, 3.8),
    3.0);
  d = smooth_union(d,
    capsule_distance(p, dvec3(15.0, canal - 3.0, 1.0), dvec3(v.wing, canal - 9.0, 4.0), 4.5, 3.2),
    4.0);
  d = smooth_union(d,
    capsule_distance(
      p, dvec3(0.0, canal - 13.0, -2.0), dvec3(0.0, canal - 31.0, -2.0 - v.spine_drop), 4.0, 3.4),
    3.0);
  d = smooth_union(d,
    capsule_distance(p,
      dvec3(15.0, canal - 6.0, -v.half_height - 2.0),
      dvec3(15.0, canal - 5.0, v.half_height + 2.0),
      3.8,
      3.8),
    3.0);
  return smooth_difference(
    d, capsule_distance(p, dvec3(0.0, canal, -40.0), dvec3(0.0, canal, 40.0), 8.6, 8.6), 1.5);
}

void paint_spine(PaintedVolume& torso, const PaintedVolume::Texture& sponge)
{
  namespace hu = hounsfield;
  // Discs first: a column through the bodies, a little slimmer.
  torso.paint(
    [](const dvec3& p)
    {
      const double wide = mix(15.0, 23.0, saturate((220.0 - p.z) / 300.0));
      const double deep = mix(9.5, 16.5, saturate((220.0 - p.z) / 300.0));
      return std::max(girth_distance(p, { wide, deep, spine_course(p.z) }), -188.0 - p.z);
    },
    hu::muscle + 35.0);
  // The canal: fluid around the cord, which ends at the first vertebra of the loins.
  const auto canal = [](const dvec3& p)
  {
    const double deep = mix(9.5, 16.5, saturate((220.0 - p.z) / 300.0));
    const double y = p.y - spine_course(p.z) + deep + 8.5;
    return std::sqrt(p.x * p.x + y * y);
  };
  torso.paint([=](const dvec3& p) { return std::max(canal(p) - 8.0, -200.0 - p.z); },
    hu::cerebrospinal_fluid);
  torso.paint(
    [=](const dvec3& p) { return std::max(canal(p) - 4.6, -40.0 - p.z); }, hu::white_matter + 8.0);
  for (const Vertebra& v : vertebrae())
  {
    torso.paint([v](const dvec3& p) { return vertebra_distance(p, v); },
      { { 0.0, hu::bone - 200.0 }, { 1.3, sponge } });
  }
  // Sacrum and coccyx, with the canal's end.
  torso.paint(
    [](const dvec3& place)
    {
      const dvec3 p = mirrored(place);
      double d = ellipsoid_distance(p, dvec3(0.0, -50.0, -206.0), dvec3(50.0, 19.0, 25.0));
      d = smooth_union(
        d, ellipsoid_distance(p, dvec3(0.0, -72.0, -234.0), dvec3(36.0, 15.0, 26.0)), 14.0);
      d = smooth_union(d,
        capsule_distance(p, dvec3(0.0, -84.0, -256.0), dvec3(0.0, -80.0, -276.0), 8.0, 4.0),
        8.0);
      const double holes = std::min(
        capsule_distance(p, dvec3(18.0, -30.0, -212.0), dvec3(15.0, -86.0, -222.0), 4.5, 4.0),
        capsule_distance(p, dvec3(14.0, -46.0, -236.0), dvec3(13.0, -100.0, -242.0), 4.0, 3.5));
      return smooth_difference(d, holes, 2.0);
    },
    { { 0.0, hu::bone - 250.0 }, { 1.6, sponge } });
}

/// Where the middle line of a rib runs, as height over how far it is around: s = -1 at the spine,
/// 0 at the side, 1 at the breastbone.
struct Rib
{
  double start;  ///< height at the spine
  double drop;   ///< down to where its bone ends
  double end;    ///< s there
  double attach; ///< height at s = 1, of the cartilage; of those that float none
  bool floats;
};

std::vector<Rib> ribs()
{
  return { { 217.0, 30.0, 0.74, 186.0, false },
    { 197.0, 42.0, 0.78, 170.0, false },
    { 176.0, 54.0, 0.80, 150.0, false },
    { 155.0, 62.0, 0.80, 132.0, false },
    { 134.0, 68.0, 0.80, 114.0, false },
    { 113.0, 74.0, 0.78, 98.0, false },
    { 92.0, 76.0, 0.74, 84.0, false },
    { 71.0, 74.0, 0.66, 72.0, false },
    { 50.0, 70.0, 0.56, 58.0, false },
    { 29.0, 62.0, 0.42, 42.0, false },
    { 8.0, 42.0, 0.1, 0.0, true },
    { -12.0, 30.0, -0.35, 0.0, true } };
}

double rib_height(const Rib& rib, double s)
{
  if (s <= rib.end)
  {
    // Level at the spine, then steadily down, as ribs hang.
    const double t = (s + 1.0) / (rib.end + 1.0);
    return rib.start - rib.drop * t * (0.55 + 0.45 * t);
  }
  const double low = rib.start - rib.drop;
  return mix(low, rib.attach, smooth_ramp(s, rib.end, 1.0));
}

void paint_ribs(PaintedVolume& torso, const PaintedVolume::Texture& sponge)
{
  namespace hu = hounsfield;
  for (const Rib& rib : ribs())
  {
    const auto tube = [rib](const dvec3& place, bool cartilage)
    {
      const dvec3 p = mirrored(place);
      const Girth g = rib_girth(p.z);
      const double s = std::clamp((p.y - g.middle) / g.half_depth, -1.0, 1.0);
      const double rise = 0.8 * (p.z - rib_height(rib, s));
      const double in = girth_distance(p, g);
      // Flat: thinner across the wall than up and down.
      const double d = std::sqrt(1.6 * in * in + 0.75 * rise * rise) - (cartilage ? 4.6 : 4.9);
      const double beyond = (s - rib.end) * 60.0; // above 0 past the end of the bone
      const double cut = cartilage ? std::max(-beyond, 13.0 - p.x) : std::max(beyond, 15.0 - p.x);
      return 0.8 * smooth_intersection(d, cut, 3.0);
    };
    if (!rib.floats)
    {
      torso.paint([tube](const dvec3& p) { return tube(p, true); }, hu::cartilage);
    }
    torso.paint(
      [tube](const dvec3& p) { return tube(p, false); }, { { 0.0, hu::bone }, { 1.6, sponge } });
    // Head and neck, to the vertebra.
    torso.paint(
      [rib](const dvec3& place)
      {
        const dvec3 p = mirrored(place);
        const Girth g = rib_girth(rib.start - 2.0);
        const double back = g.middle - g.half_depth * 0.985;
        return tube_distance(p,
          { dvec3(17.0, spine_course(rib.start) - 10.0, rib.start + 2.0),
            dvec3(26.0, back + 2.0, rib.start - 1.0) },
          3.8);
      },
      { { 0.0, hu::bone }, { 1.6, sponge } });
  }
  // Breastbone: on the same surface.
  torso.paint(
    [](const dvec3& place)
    {
      const dvec3 p = mirrored(place);
      const double in = girth_distance(p, rib_girth(std::min(p.z, 190.0)));
      const double wide = p.z > 164.0 ? mix(16.0, 27.0, ramp(p.z, 164.0, 186.0))
                                      : mix(10.0, 17.0, ramp(std::fabs(p.z - 100.0), 70.0, 20.0));
      const double d = smooth_intersection(std::fabs(in) - 5.5, p.x - wide, 4.0);
      const double body = std::fabs(p.z - 127.0) - 67.0;
      return 0.8 * std::max(smooth_intersection(d, body, 4.0), -p.y);
    },
    { { 0.0, hu::bone - 300.0 }, { 1.5, sponge } });
  torso.paint([](const dvec3& p)
    { return capsule_distance(p, dvec3(0.0, 92.0, 62.0), dvec3(0.0, 91.0, 44.0), 4.0, 2.5); },
    hu::cartilage);
}

void paint_girdle(PaintedVolume& torso, const PaintedVolume::Texture& sponge)
{
  namespace hu = hounsfield;
  const auto collar_bone = [](const dvec3& place)
  {
    return tube_distance(mirrored(place),
      { dvec3(18.0, 54.0, 194.0),
        dvec3(46.0, 56.0, 202.0),
        dvec3(76.0, 34.0, 212.0),
        dvec3(104.0, 0.0, 222.0),
        dvec3(128.0, -18.0, 230.0) },
      5.8);
  };
  // A blade on a shell around the rib cage, with spine, shoulder corner and socket.
  const auto blade = [](const dvec3& place)
  {
    const dvec3 p = mirrored(place);
    const double in = girth_distance(p, rib_girth(p.z));
    const double plate = std::fabs(in - 12.0) - 2.0;
    const double inner = 56.0 + 0.05 * (150.0 - p.z) - p.x;
    const double outer = 0.9 * (p.x - 78.0 - 0.42 * (p.z - 78.0));
    const double above = std::fabs(p.z - 143.0) - 68.0;
    double d = smooth_intersection(plate, std::max({ inner, outer, above, p.y + 6.0 }), 3.0);
    d = smooth_union(d,
      tube_distance(p,
        { dvec3(62.0, -84.0, 178.0),
          dvec3(96.0, -76.0, 194.0),
          dvec3(130.0, -44.0, 224.0),
          dvec3(132.0, -22.0, 232.0) },
        5.0),
      5.0);
    d = smooth_union(
      d, ellipsoid_distance(p, dvec3(112.0, -36.0, 202.0), dvec3(11.0, 12.0, 17.0)), 6.0);
    d = smooth_union(
      d, capsule_distance(p, dvec3(112.0, -30.0, 208.0), dvec3(106.0, 6.0, 214.0), 5.5, 4.5), 4.0);
    return 0.9 * smooth_difference(d, sphere_distance(p, dvec3(136.0, -22.0, 206.0), 24.0), 1.0);
  };
  const auto upper_arm = [](const dvec3& place)
  {
    const dvec3 p = mirrored(place);
    return smooth_union(sphere_distance(p, dvec3(136.0, -22.0, 206.0), 21.5),
      capsule_distance(p, dvec3(142.0, -20.0, 216.0), dvec3(157.0, -18.0, 330.0), 13.0, 11.0),
      10.0);
  };
  torso.paint(collar_bone, { { 0.0, hu::bone + 100.0 }, { 2.0, sponge } });
  torso.paint(blade, { { 0.0, hu::bone }, { 1.8, sponge } });
  torso.paint(upper_arm, { { 0.0, hu::bone }, { 2.0, sponge } });
  torso.paint(
    [](const dvec3& place)
    {
      return capsule_distance(
        mirrored(place), dvec3(144.0, -20.0, 240.0), dvec3(157.0, -18.0, 330.0), 6.0, 6.5);
    },
    hu::fat + 40.0);
}

void paint_hips(PaintedVolume& torso, const PaintedVolume::Texture& sponge)
{
  namespace hu = hounsfield;
  const dvec3 joint(88.0, 4.0, -246.0);
  const auto hip_bone = [=](const dvec3& place)
  {
    const dvec3 p = mirrored(place);
    // The wing: part of a bowl that opens upward and forward, from the sacrum to the front corner.
    const double bowl = ellipsoid_distance(p, dvec3(24.0, 20.0, -150.0), dvec3(104.0, 98.0, 104.0));
    const double crest = p.z + 146.0 + 0.0035 * (p.y + 10.0) * (p.y + 10.0);
    const double rest =
      std::max({ crest, 36.0 - p.x, -250.0 - p.z, p.y - 62.0 - 0.35 * (p.z + 170.0) });
    double d = 0.9 * smooth_intersection(std::fabs(bowl) - 4.2, rest, 5.0);
    // Thick along the crest, and toward the joint.
    const double rim = std::sqrt(bowl * bowl + crest * crest) - 7.0;
    d = smooth_union(d, 0.8 * std::max({ rim, 40.0 - p.x, p.y - 58.0 }), 5.0);
    d = smooth_union(d,
      capsule_distance(p, dvec3(62.0, -34.0, -200.0), joint + dvec3(0.0, 2.0, 16.0), 11.0, 17.0),
      14.0);
    d = smooth_union(d, sphere_distance(p, joint, 33.0), 10.0);
    d = smooth_union(
      d, capsule_distance(p, dvec3(66.0, 24.0, -250.0), dvec3(10.0, 58.0, -272.0), 10.0, 9.0), 8.0);
    d = smooth_union(d,
      capsule_distance(p, dvec3(78.0, -22.0, -262.0), dvec3(60.0, -44.0, -310.0), 13.0, 15.0),
      10.0);
    d = smooth_difference(
      d, ellipsoid_distance(p, dvec3(40.0, 6.0, -300.0), dvec3(22.0, 22.0, 20.0)), 4.0);
    return smooth_difference(d, sphere_distance(p, joint + dvec3(7.0, 0.0, -2.0), 26.5), 2.0);
  };
  const auto thigh_bone = [=](const dvec3& place)
  {
    const dvec3 p = mirrored(place);
    const dvec3 head = joint + dvec3(7.0, 0.0, -2.0);
    double d = sphere_distance(p, head, 24.0);
    d = smooth_union(d, capsule_distance(p, head, dvec3(136.0, -6.0, -276.0), 14.0, 17.0), 8.0);
    d = smooth_union(d, sphere_distance(p, dvec3(144.0, -12.0, -266.0), 15.0), 10.0);
    return smooth_union(d,
      capsule_distance(p, dvec3(140.0, -4.0, -280.0), dvec3(132.0, 0.0, -340.0), 17.0, 14.0),
      8.0);
  };
  torso.paint(hip_bone, { { 0.0, hu::bone }, { 2.0, sponge } });
  torso.paint([](const dvec3& p)
    { return box_distance(p, dvec3(0.0, 58.0, -273.0), dvec3(3.5, 8.0, 14.0), 3.0); },
    hu::cartilage);
  torso.paint(thigh_bone, { { 0.0, hu::bone }, { 2.2, sponge } });
}

}

void paint_bones(PaintedVolume& torso, std::uint32_t seed)
{
  const PaintedVolume::Texture sponge = [seed](const dvec3& p, double)
  {
    const double n = fbm(p / 4.0, substream(seed, 74), { 2, 2.0, 0.6 });
    return mix(110.0, 330.0, smooth_ramp(n, -0.35, 0.35));
  };
  paint_ribs(torso, sponge);
  paint_spine(torso, sponge);
  paint_girdle(torso, sponge);
  paint_hips(torso, sponge);
}

}
}
