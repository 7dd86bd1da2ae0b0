// The head phantom's bone: skull, jaws, teeth, vertebrae, and the air that bone holds.
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

constexpr double vault_thickness = 7.0;

/// A point of an upper or lower row of teeth, for t in [0, 1] from the front to behind the last
/// molar: a quarter of an ellipse (by the rational form of sine and cosine).
dvec3 arch_point(double t, double half_width, double front, double back, double z)
{
  const double s = 2.0 * t / (1.0 + t * t);
  const double c = (1.0 - t * t) / (1.0 + t * t);
  return { half_width * s, back + (front - back) * c, z };
}

std::vector<dvec3> arch(double half_width, double front, double back, double z)
{
  std::vector<dvec3> points;
  for (int i = 0; i <= 8; ++i)
  {
    points.push_back(arch_point(i / 8.0, half_width, front, back, z));
  }
  return points;
}

/// Brow, cheek bones, upper jaw: the bone of the face before sockets and nose are cut.
double face_bone(const dvec3& p)
{
  double d = ellipsoid_distance(p, dvec3(0.0, 48.0, 32.0), dvec3(50.0, 26.0, 32.0));
  d = smooth_union(
    d, capsule_distance(p, dvec3(6.0, 74.0, 19.0), dvec3(44.0, 60.0, 19.0), 6.0, 5.0), 8.0);
  // Frame of the eye socket: outer rim, lower rim.
  d = smooth_union(
    d, capsule_distance(p, dvec3(49.0, 56.0, 18.0), dvec3(50.0, 56.0, -12.0), 4.5, 4.5), 6.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(48.0, 58.0, -16.0), dvec3(16.0, 72.0, -14.0), 6.0, 4.0), 6.0);
  // Cheek bone and its arch to the ear.
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(44.0, 60.0, -20.0), dvec3(11.0, 10.0, 10.0)), 8.0);
  d = smooth_union(d,
    tube_distance(dvec3(p.x, p.y, 0.75 * p.z),
      { dvec3(50.0, 52.0, -12.5),
        dvec3(61.0, 32.0, -11.5),
        dvec3(63.5, 14.0, -10.5),
        dvec3(60.0, -2.0, -10.0) },
      3.0),
    5.0);
  // Upper jaw, from the socket's floor to the teeth.
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(20.0, 56.0, -30.0), dvec3(20.0, 19.0, 22.0)), 8.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(9.0, 76.0, 12.0), dvec3(17.0, 74.0, -26.0), 4.0, 5.0), 6.0);
  // Bridge of the nose.
  d = smooth_union(
    d, capsule_distance(p, dvec3(0.0, 78.0, 16.0), dvec3(1.0, 89.5, -5.0), 4.5, 3.2), 5.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(5.0, 77.0, 10.0), dvec3(6.0, 84.0, -6.0), 3.0, 2.6), 4.0);
  // Between the sockets, down to the throat's roof.
  d = smooth_union(d, ellipsoid_distance(p, dvec3(0.0, 50.0, -2.0), dvec3(15.0, 26.0, 22.0)), 6.0);
  d = smooth_union(d, ellipsoid_distance(p, dvec3(0.0, 18.0, -6.0), dvec3(17.0, 20.0, 14.0)), 6.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(13.0, 24.0, -18.0), dvec3(15.0, 24.0, -44.0), 3.5, 2.5), 4.0);
  return d;
}

double skull_base(const dvec3& p)
{
  double d = capsule_distance(p, dvec3(52.0, -10.0, -12.0), dvec3(16.0, 6.0, -8.0), 10.0, 7.0);
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(53.0, -22.0, -24.0), dvec3(10.0, 12.0, 19.0)), 8.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(0.0, 8.0, -10.0), dvec3(0.0, -12.0, -30.0), 9.0, 6.0), 8.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(0.0, -92.0, -4.0), dvec3(0.0, -87.0, -14.0), 4.0, 4.0), 14.0);
  return smooth_union(
    d, capsule_distance(p, dvec3(24.0, 2.0, -30.0), dvec3(23.0, 4.0, -54.0), 2.4, 0.8), 3.0);
}

double eye_socket(const dvec3& p)
{
  // A cone whose tip points back and inward.
  return std::min(ellipsoid_distance(p, dvec3(32.0, 66.0, 2.0), dvec3(17.5, 20.0, 15.5)),
    capsule_distance(p, dvec3(31.0, 62.0, 2.0), dvec3(15.0, 28.0, 2.0), 15.0, 4.0));
}

double nose_opening(const dvec3& p)
{
  const double pear =
    smooth_union(ellipsoid_distance(p, dvec3(6.0, 84.0, -28.0), dvec3(8.0, 22.0, 9.0)),
      ellipsoid_distance(p, dvec3(2.0, 86.0, -17.0), dvec3(6.0, 18.0, 14.0)),
      5.0);
  return std::min(pear, ellipsoid_distance(p, dvec3(5.0, 58.0, -20.0), dvec3(9.0, 36.0, 19.0)));
}

double skull_surface(const dvec3& place)
{
  const dvec3 p = mirrored(place);
  double d = cranial_cavity(p) - vault_thickness;
  // The balls hold all that is added or cut below; no fillet is wider than 14.
  const bool near_face = sphere_distance(p, dvec3(0.0, 40.0, -8.0), 82.0) < d + 14.0;
  const bool near_base = sphere_distance(p, dvec3(0.0, -35.0, -15.0), 95.0) < d + 14.0;
  if (!near_face && !near_base)
  {
    return d;
  }
  d = smooth_union(d, face_bone(p), 14.0);
  d = smooth_union(d, skull_base(p), 6.0);
  // The hollow of the temples behind the outer rim of the socket.
  d = smooth_difference(
    d, ellipsoid_distance(p, dvec3(66.0, 40.0, 6.0), dvec3(10.0, 22.0, 22.0)), 8.0);
  d = smooth_difference(d, eye_socket(p), 2.0);
  d = smooth_difference(d, nose_opening(p), 2.0);
  // The palate, and the ridge that holds the upper teeth.
  d = smooth_union(d, ellipsoid_distance(p, dvec3(0.0, 46.0, -42.0), dvec3(24.0, 27.0, 3.0)), 3.0);
  d = smooth_union(
    d, tube_distance(dvec3(p.x, p.y, 0.6 * p.z), arch(27.0, 74.0, 34.0, -27.6), 4.6), 5.0);
  // The septum's bone.
  d = std::min(d, box_distance(p, dvec3(0.0, 52.0, -20.0), dvec3(1.0, 26.0, 22.0), 0.8));
  // Where the spinal cord, and the ear's canal, come through.
  d = smooth_difference(
    d, capsule_distance(p, dvec3(0.0, -32.0, -20.0), dvec3(0.0, -36.0, -60.0), 14.0, 14.0), 3.0);
  return smooth_difference(
    d, capsule_distance(p, dvec3(84.0, -6.0, -12.0), dvec3(50.0, -3.0, -10.0), 4.6, 3.2), 1.0);
}

double lower_jaw(const dvec3& place)
{
  const dvec3 p = mirrored(place);
  const dvec3 tall(p.x, p.y, 0.65 * p.z);
  double d = tube_distance(tall,
    { dvec3(0.0, 75.0, -57.0),
      dvec3(14.0, 72.0, -57.0),
      dvec3(27.0, 56.0, -56.0),
      dvec3(38.0, 34.0, -53.0),
      dvec3(46.0, 14.0, -47.5) },
    6.4);
  d = smooth_union(
    d, tube_distance(dvec3(p.x, p.y, 0.6 * p.z), arch(26.0, 71.0, 34.0, -48.0), 4.2), 6.0);
  d = smooth_union(d, ellipsoid_distance(p, dvec3(0.0, 77.0, -93.0), dvec3(13.0, 6.0, 8.0)), 6.0);
  // The branch that rises to the joint, flat in x.
  const dvec3 flat(1.8 * (p.x - 48.0), p.y, p.z);
  const double branch =
    smooth_union(
      capsule_distance(flat, dvec3(-2.0, 13.0, -70.0), dvec3(6.0, 6.0, -24.0), 13.0, 7.0),
      capsule_distance(flat, dvec3(0.0, 23.0, -56.0), dvec3(0.0, 28.0, -22.0), 10.0, 3.0),
      6.0) /
    1.8;
  d = smooth_union(d, branch, 6.0);
  return smooth_union(d, ellipsoid_distance(p, dvec3(52.0, 4.0, -19.0), dvec3(9.0, 4.5, 5.0)), 4.0);
}

/// One vertebra around the spinal canal at (0, -34): body, arch, spine, side processes.
double vertebra(const dvec3& p, double z)
{
  const dvec3 q(p.x, p.y, p.z - z);
  double d = ellipsoid_distance(q, dvec3(0.0, -15.0, 0.0), dvec3(15.0, 11.0, 8.5));
  d = std::max(d, std::fabs(q.z) - 6.8);
  d = smooth_union(
    d, torus_distance(dvec3(q.x, q.y, 0.7 * q.z), dvec3(0.0, -35.0, 0.0), 15.5, 3.0), 3.0);
  d = smooth_union(
    d, capsule_distance(q, dvec3(14.0, -27.0, 0.0), dvec3(26.0, -24.0, -2.0), 5.0, 3.5), 4.0);
  return smooth_union(
    d, capsule_distance(q, dvec3(0.0, -51.0, -1.0), dvec3(4.0, -68.0, -8.0), 3.5, 3.0), 3.0);
}

double spine(const dvec3& place)
{
  const dvec3 p = mirrored(place);
  // The atlas is a ring with broad sides; the axis sends its tooth up through it.
  double d = torus_distance(dvec3(0.8 * p.x, p.y, 0.8 * p.z), dvec3(0.0, -30.0, -38.4), 19.0, 3.6);
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(24.0, -22.0, -46.0), dvec3(10.0, 10.0, 8.0)), 4.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(28.0, -26.0, -48.0), dvec3(40.0, -28.0, -49.0), 4.5, 3.5), 4.0);
  d =
    std::min(d, capsule_distance(p, dvec3(0.0, -18.0, -42.0), dvec3(0.0, -16.0, -62.0), 4.5, 5.5));
  for (double z : { -67.0, -85.0, -103.0, -121.0 })
  {
    d = std::min(d, vertebra(p, z));
  }
  return d;
}

/// Distance to the nearest of the three great sutures of the vault, crooked as they are; found on
/// the surface only.
double suture(const dvec3& p)
{
  const double far = 14.0; // more than the zigzag's swing
  if (p.z < 5.0 || (std::fabs(p.x) > far && std::fabs(p.y - 14.0 + 0.12 * (p.z - 60.0)) > far &&
                     std::fabs(p.z - 66.0 + 0.75 * std::fabs(p.x)) > far))
  {
    return far;
  }
  const double zigzag = 7.0 * perlin_noise(p / 6.0, 71) + 4.0 * perlin_noise(p / 2.6, 72);
  const double coronal = std::fabs(p.y - 14.0 + 0.12 * (p.z - 60.0) + zigzag);
  const double behind = p.y - 14.0 + 0.12 * (p.z - 60.0);
  const double lambda = p.z - 66.0 + 0.75 * std::fabs(p.x) + zigzag; // above 0 over the lambda
  const double lambdoid = p.y < -40.0 ? std::fabs(lambda) * 0.8 : 1e3;
  const double sagittal = behind < 0.0 && lambda > 0.0 ? std::fabs(p.x + zigzag) : 1e3;
  const double nearest = std::min({ p.z > 20.0 ? coronal : 1e3, lambdoid, sagittal });
  return p.z > 5.0 ? nearest : 1e3;
}

void paint_teeth(PaintedVolume& head, bool upper)
{
  namespace hu = hounsfield;
  // Widths of the teeth from the middle of the row to the second molar, millimetres.
  static const double upper_widths[7] = { 8.5, 6.6, 7.6, 7.0, 6.8, 10.2, 9.6 };
  static const double lower_widths[7] = { 5.4, 6.0, 7.0, 7.1, 7.2, 11.0, 10.4 };
  const double* widths = upper ? upper_widths : lower_widths;
  const double up = upper ? 1.0 : -1.0; // toward the root
  const double half_width = upper ? 27.0 : 26.0;
  const double front = upper ? 77.0 : 74.0;
  const double bite = -63.5;

  double t = 0.0;
  dvec3 last = arch_point(0.0, half_width, front, 34.0, bite);
  double travelled = 0.0;
  double target = 0.0;
  for (int n = 0; n < 7; ++n)
  {
    const double width = widths[n];
    target += 0.5 * width;
    while (travelled < target && t < 1.4)
    {
      t += 0.001;
      const dvec3 next = arch_point(t, half_width, front, 34.0, bite);
      travelled += glm::length(next - last);
      last = next;
    }
    target += 0.5 * width;
    const dvec3 ahead = arch_point(t + 0.001, half_width, front, 34.0, bite);
    const dvec3 along = glm::normalize(ahead - last);
    const dvec3 across(-along.y, along.x, 0.0);
    const bool molar = n >= 3;
    const double depth = n < 2 ? 3.0 : n == 2 ? 4.0 : n < 5 ? 4.4 : 5.2;
    const double crown = molar ? 4.0 : n == 2 ? 5.4 : 4.9;
    const dvec3 centre = last + dvec3(0.0, 0.0, up * (crown + 0.2));
    const double root = molar ? 14.0 : 16.0;
    const auto local = [=](const dvec3& place)
    {
      const dvec3 q = mirrored(place) - centre;
      return dvec3(glm::dot(q, along), glm::dot(q, across), up * q.z);
    };
    const auto tooth = [=](const dvec3& place)
    {
      const dvec3 q = local(place);
      double d = box_distance(q, dvec3(0.0), dvec3(0.5 * width - 0.25, depth, crown), 1.8);
      if (molar)
      {
        // Cusps around a hollow, and two roots.
        d = smooth_difference(d, sphere_distance(q, dvec3(0.0, 0.0, -crown - 1.2), 2.6), 1.0);
        const dvec3 r(std::fabs(q.x), q.y, q.z);
        return smooth_union(d,
          capsule_distance(r,
            dvec3(0.22 * width, 0.0, crown - 1.0),
            dvec3(0.24 * width, 0.0, crown + root - 4.0),
            2.2,
            0.9),
          2.0);
      }
      return smooth_union(d,
        capsule_distance(
          q, dvec3(0.0, 0.0, crown - 1.0), dvec3(0.0, 0.4, crown + root - 4.0), 0.36 * width, 0.9),
        2.0);
    };
    // Enamel over the crown only, dentine within, pulp at the heart.
    head.paint(tooth, hu::dentine);
    head.paint([=](const dvec3& place)
      { return smooth_intersection(tooth(place), local(place).z - crown + 0.6, 0.8); },
      { { 0.0, hu::enamel }, { 1.5, hu::dentine } });
    head.paint(
      [=](const dvec3& place)
      {
        return capsule_distance(
          local(place), dvec3(0.0), dvec3(0.0, 0.3, crown + 0.6 * root), 0.7, 0.4);
      },
      hu::muscle);
  }
}

void paint_air_in_bone(PaintedVolume& head, std::uint32_t seed)
{
  namespace hu = hounsfield;
  // Jaw, brow and wedge-bone sinuses, each with its lining.
  const auto sinuses = [](const dvec3& place)
  {
    const dvec3 p = mirrored(place);
    const double jaw =
      smooth_union(ellipsoid_distance(p, dvec3(27.0, 56.0, -24.0), dvec3(10.0, 15.0, 11.0)),
        ellipsoid_distance(p, dvec3(24.0, 56.0, -32.0), dvec3(7.0, 11.0, 9.0)),
        5.0);
    const double brow =
      smooth_union(ellipsoid_distance(p, dvec3(9.0, 69.5, 25.0), dvec3(7.0, 3.2, 8.0)),
        ellipsoid_distance(p, dvec3(19.0, 66.5, 23.0), dvec3(8.0, 2.8, 5.0)),
        4.0);
    const double wedge =
      std::max(ellipsoid_distance(p, dvec3(7.0, 22.0, -5.0), dvec3(8.0, 12.0, 9.0)), 0.8 - p.x);
    return std::min({ jaw, brow, wedge });
  };
  head.paint(sinuses, { { 0.0, hu::mucosa }, { 0.8, hu::air } });

  // Cells: between the eyes, and behind the ears. Walls of thin bone stand where two cells meet.
  const auto honeycomb = [seed](double size)
  {
    return [seed, size](const dvec3& p, double)
    {
      const double n = worley_noise(p / size, substream(seed, 40));
      return mix(hu::air, hu::spongy_bone, smooth_ramp(n, 0.58, 0.72));
    };
  };
  head.paint([](const dvec3& p)
    { return ellipsoid_distance(mirrored(p), dvec3(8.5, 52.0, 1.0), dvec3(4.5, 19.0, 12.0)); },
    { { 0.0, honeycomb(8.0) } });
  head.paint([](const dvec3& p)
    { return ellipsoid_distance(mirrored(p), dvec3(53.0, -22.0, -24.0), dvec3(6.5, 8.5, 14.0)); },
    { { 0.0, honeycomb(5.0) } });
  // The middle ear, and the snail of the inner one in the hardest bone.
  head.paint([](const dvec3& p)
    { return ellipsoid_distance(mirrored(p), dvec3(45.0, -3.0, -9.0), dvec3(3.0, 5.0, 7.0)); },
    hu::air);
  head.paint([](const dvec3& p)
    { return torus_distance(mirrored(p), dvec3(36.0, -4.0, -9.0), 3.0, 1.1); },
    hu::cerebrospinal_fluid);
}

}

double cranial_cavity(const dvec3& place)
{
  const dvec3 p = mirrored(place);
  double d = ellipsoid_distance(p, dvec3(0.0, -12.0, 56.0), dvec3(61.0, 79.0, 49.0));
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(20.0, -40.0, 50.0), dvec3(46.0, 50.0, 48.0)), 14.0);
  d = smooth_union(d, ellipsoid_distance(p, dvec3(36.0, 6.0, 16.0), dvec3(26.0, 34.0, 27.0)), 12.0);
  return smooth_union(
    d, ellipsoid_distance(p, dvec3(0.0, -50.0, 4.0), dvec3(53.0, 39.0, 31.0)), 12.0);
}

void paint_skull(PaintedVolume& head, std::uint32_t seed)
{
  namespace hu = hounsfield;
  const auto sponge = [seed](double size, double low, double high)
  {
    return [=](const dvec3& p, double)
    {
      const double n = fbm(p / size, substream(seed, 30), { 3, 2.0, 0.6 });
      return mix(low, high, smooth_ramp(n, -0.3, 0.35));
    };
  };
  const auto outer_table = [](const dvec3& p, double)
  { return mix(250.0, hu::dense_bone, smooth_ramp(suture(p), 0.5, 1.6)); };

  // Thick bone is sponge within a hard crust; the vault has its inner crust toward the brain.
  head.paint(skull_surface,
    { { 0.0, outer_table }, { 1.9, sponge(3.2, hu::marrow, 2.0 * hu::spongy_bone - hu::marrow) } });
  head.paint([](const dvec3& p) { return cranial_cavity(p) - 2.0; }, hu::dense_bone);
  head.paint(
    [](const dvec3& p)
    {
      return capsule_distance(
        mirrored(p), dvec3(46.0, -7.0, -10.0), dvec3(20.0, 4.0, -7.0), 7.0, 5.0);
    },
    hu::dense_bone + 200.0);
  head.paint(lower_jaw, { { 0.0, hu::bone + 200.0 }, { 2.4, sponge(3.2, hu::marrow, 700.0) } });
  head.paint(spine, { { 0.0, hu::bone }, { 1.5, sponge(2.6, 150.0, 550.0) } });
  head.paint(
    [](const dvec3& p) // the hyoid
    {
      return tube_distance(mirrored(p),
        { dvec3(0.0, 32.0, -100.0), dvec3(10.0, 29.0, -100.0), dvec3(20.0, 10.0, -97.0) },
        2.4);
    },
    hu::bone - 300.0);
  paint_teeth(head, true);
  paint_teeth(head, false);
  paint_air_in_bone(head, seed);
}

}
}
