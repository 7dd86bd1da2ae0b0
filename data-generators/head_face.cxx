// The head phantom's soft tissue: what the skin shows, and the air behind it.
#include "data-generators/head_anatomy.h"

#include "data-generators/hounsfield.h"
#include "data-generators/signed_distance.h"

namespace brume
{
namespace head
{

namespace
{

using glm::dvec3;

double ear(const dvec3& p)
{
  // A shell that leans out backward from the temple: its own axes are u (along it) and v (across).
  const dvec3 q = p - dvec3(76.0, -10.0, -8.0);
  const double u = 0.88 * q.y - 0.47 * q.x;
  const double v = 0.47 * q.y + 0.88 * q.x;
  const dvec3 local(v, u, q.z - 0.15 * u);
  const double shell = ellipsoid_distance(local, dvec3(0.0, 0.0, 0.0), dvec3(5.5, 17.0, 30.0));
  const double bowl = ellipsoid_distance(local, dvec3(5.5, 2.0, 3.0), dvec3(5.0, 11.5, 22.0));
  const double concha = ellipsoid_distance(local, dvec3(3.0, 4.0, -4.0), dvec3(7.0, 8.0, 10.0));
  const double fold = ellipsoid_distance(local, dvec3(2.0, -2.0, 4.0), dvec3(4.0, 5.5, 17.0));
  double d = smooth_difference(shell, bowl, 3.0);
  d = smooth_union(d, fold, 3.0);
  d = smooth_difference(d, concha, 3.0);
  return smooth_union(d, sphere_distance(local, dvec3(0.0, 1.0, -25.0), 6.0), 5.0);
}

double nose(const dvec3& p)
{
  double d = capsule_distance(p, dvec3(0.0, 82.0, 18.0), dvec3(0.0, 104.0, -24.0), 6.0, 7.5);
  d = smooth_union(d, ellipsoid_distance(p, dvec3(0.0, 80.0, -14.0), dvec3(17.0, 15.0, 26.0)), 9.0);
  d = smooth_union(d, sphere_distance(p, dvec3(0.0, 103.5, -27.0), 10.0), 8.0);
  d = smooth_union(d, ellipsoid_distance(p, dvec3(10.5, 95.0, -31.0), dvec3(7.0, 11.0, 8.0)), 7.0);
  return smooth_union(
    d, ellipsoid_distance(p, dvec3(0.0, 93.0, -35.0), dvec3(4.5, 12.0, 4.0)), 5.0);
}

/// Beyond this distance, millimetres, a shape need not ask where the skin is.
constexpr double reach_of_skin = 4.0;

double skin_surface(const dvec3& place)
{
  const dvec3 p = mirrored(place);
  // The vault follows the cavity: bone and scalp together are 13 mm thick.
  double d = cranial_cavity(p) - 13.0;
  // Neck, with the muscles that run from behind the ear to the breastbone.
  d = smooth_union(
    d, capsule_distance(p, dvec3(0.0, -32.0, -20.0), dvec3(0.0, -36.0, -180.0), 54.0, 52.0), 24.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(50.0, -22.0, -40.0), dvec3(20.0, 14.0, -160.0), 11.0, 11.0), 14.0);
  if (sphere_distance(p, dvec3(78.0, -10.0, -8.0), 40.0) < d + 4.0)
  {
    d = smooth_union(d, ear(p), 4.0);
  }
  // All that follows lies within this ball, and no fillet is wider than 22.
  if (sphere_distance(p, dvec3(0.0, 30.0, -40.0), 105.0) > d + 22.0)
  {
    return d;
  }
  // Forehead, face, cheeks, jaw, chin.
  d = smooth_union(d, ellipsoid_distance(p, dvec3(0.0, 35.0, 22.0), dvec3(60.0, 47.0, 34.0)), 18.0);
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(0.0, 30.0, -32.0), dvec3(64.0, 53.0, 62.0)), 22.0);
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(38.0, 24.0, -12.0), dvec3(35.0, 40.0, 28.0)), 12.0);
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(40.0, 60.0, -16.0), dvec3(22.0, 22.0, 16.0)), 14.0);
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(0.0, 64.0, -62.0), dvec3(34.0, 25.0, 22.0)), 16.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(47.0, 8.0, -56.0), dvec3(16.0, 66.0, -90.0), 14.0, 14.0), 22.0);
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(0.0, 74.0, -91.0), dvec3(17.0, 15.0, 14.0)), 10.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(45.0, 56.0, 20.0), dvec3(47.0, 55.0, -10.0), 10.0, 10.0), 12.0);
  // Floor of the mouth.
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(0.0, 36.0, -92.0), dvec3(32.0, 38.0, 17.0)), 12.0);
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(0.0, 24.0, -122.0), dvec3(9.0, 10.0, 15.0)), 14.0);
  // Eye hollows, then lids over the eyeballs, and the brows above.
  d = smooth_difference(
    d, ellipsoid_distance(p, dvec3(33.0, 96.0, 0.0), dvec3(18.0, 16.0, 12.0)), 12.0);
  d = smooth_union(d, sphere_distance(p, dvec3(32.0, 70.0, 2.0), 14.2), 4.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(12.0, 80.5, 18.0), dvec3(43.0, 70.0, 20.0), 6.0, 5.0), 14.0);
  // The crease of the closed lids.
  d = smooth_difference(d,
    tube_distance(p,
      { dvec3(19.5, 82.5, 1.5),
        dvec3(26.0, 86.5, -2.5),
        dvec3(35.0, 86.5, -3.0),
        dvec3(44.5, 79.5, 0.5) },
      1.1),
    1.5);
  d = smooth_union(d, nose(p), 9.0);
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(0.0, 70.0, -50.0), dvec3(24.0, 20.0, 16.0)), 12.0);
  // Lips, and the line between them.
  d = smooth_union(d, ellipsoid_distance(p, dvec3(0.0, 86.0, -59.5), dvec3(21.0, 9.0, 4.6)), 7.0);
  d = smooth_union(d, ellipsoid_distance(p, dvec3(8.0, 88.0, -58.8), dvec3(11.0, 8.0, 4.2)), 4.0);
  d = smooth_union(d, ellipsoid_distance(p, dvec3(0.0, 86.5, -68.5), dvec3(19.0, 8.5, 5.2)), 7.0);
  d = smooth_difference(d,
    tube_distance(p,
      { dvec3(0.0, 96.5, -63.6),
        dvec3(9.0, 95.5, -63.2),
        dvec3(18.0, 90.5, -64.2),
        dvec3(25.0, 85.0, -65.5) },
      1.3),
    2.0);
  // The groove under the nose, and the hollow above the chin.
  d = smooth_difference(
    d, capsule_distance(p, dvec3(0.0, 95.5, -44.0), dvec3(0.0, 97.5, -54.0), 2.0, 2.6), 5.0);
  d = smooth_difference(
    d, ellipsoid_distance(p, dvec3(0.0, 97.0, -77.5), dvec3(20.0, 8.0, 4.5)), 7.0);
  // Nostrils.
  return smooth_difference(
    d, capsule_distance(p, dvec3(6.5, 97.0, -46.0), dvec3(5.5, 95.0, -30.0), 3.6, 3.6), 2.0);
}

double airway(const dvec3& place)
{
  const dvec3 p = mirrored(place);
  // Either side of the septum; three shelves, the conchae, reach in from the side wall.
  double nasal = ellipsoid_distance(p, dvec3(6.0, 56.0, -19.0), dvec3(5.0, 31.0, 20.0));
  for (double z : { -31.0, -20.0, -9.0 })
  {
    nasal = smooth_difference(
      nasal, capsule_distance(p, dvec3(10.0, 80.0, z), dvec3(9.0, 34.0, z - 1.0), 3.4, 3.4), 1.5);
  }
  nasal = std::max(nasal, 1.3 - p.x);
  double d = std::min(
    nasal, capsule_distance(p, dvec3(6.5, 99.0, -50.0), dvec3(5.5, 90.0, -28.0), 3.4, 3.6));
  const dvec3 wide(0.6 * p.x, p.y, p.z);
  d = std::min(d,
    tube_distance(wide,
      { dvec3(0.0, 24.0, -22.0),
        dvec3(0.0, 8.0, -38.0),
        dvec3(0.0, 6.0, -75.0),
        dvec3(0.0, 4.0, -100.0) },
      6.0));
  d = smooth_union(
    d, capsule_distance(p, dvec3(0.0, 10.0, -104.0), dvec3(0.0, 8.0, -170.0), 6.0, 8.5), 5.0);
  // Over the tongue.
  d = std::min(d,
    tube_distance(dvec3(0.25 * p.x, p.y, p.z),
      { dvec3(0.0, 66.0, -56.0),
        dvec3(0.0, 45.0, -48.0),
        dvec3(0.0, 22.0, -54.0),
        dvec3(0.0, 8.0, -68.0) },
      1.6));
  // The ear's canal.
  return std::min(
    d, capsule_distance(p, dvec3(82.0, -6.0, -12.0), dvec3(50.0, -3.0, -10.0), 4.2, 2.8));
}

}

void paint_soft_tissue(PaintedVolume& head)
{
  namespace hu = hounsfield;
  // What lies below the skin stays at least 2.5 mm below it.
  const auto below_skin = [](PaintedVolume::Distance shape)
  {
    return [shape](const dvec3& p)
    {
      const double d = shape(p);
      return d < 2.0 * reach_of_skin ? std::max(d, skin_surface(p) + 2.5) : d;
    };
  };
  head.paint(skin_surface, { { 0.0, hu::skin }, { 2.0, hu::fat }, { 5.0, hu::muscle } });

  // Fat of cheeks, neck and temples, with the chewing muscles left in it.
  head.paint(below_skin(
               [](const dvec3& p) {
                 return ellipsoid_distance(
                   mirrored(p), dvec3(40.0, 52.0, -42.0), dvec3(14.0, 16.0, 17.0));
               }),
    hu::fat);
  head.paint(below_skin(
               [](const dvec3& p) {
                 return ellipsoid_distance(
                   mirrored(p), dvec3(58.0, 26.0, -36.0), dvec3(6.0, 14.0, 28.0));
               }),
    hu::muscle);
  head.paint(below_skin(
               [](const dvec3& p) {
                 return ellipsoid_distance(
                   mirrored(p), dvec3(60.0, -6.0, -46.0), dvec3(9.0, 13.0, 20.0));
               }),
    hu::gland);
  head.paint(
    [](const dvec3& p)
    {
      const dvec3 q = mirrored(p);
      return std::min(
        capsule_distance(q, dvec3(32.0, -12.0, -60.0), dvec3(30.0, -4.0, -170.0), 5.0, 5.0),
        capsule_distance(q, dvec3(0.0, -72.0, -60.0), dvec3(0.0, -80.0, -170.0), 3.0, 3.0));
    },
    hu::fat);

  // Tongue, gristle of nose, ear and larynx.
  head.paint([](const dvec3& p)
    { return ellipsoid_distance(p, dvec3(0.0, 42.0, -66.0), dvec3(21.0, 30.0, 17.0)); },
    hu::muscle + 10.0);
  head.paint([](const dvec3& p) { return ear(mirrored(p)) + 2.0; }, hu::cartilage);
  head.paint(
    [](const dvec3& p)
    {
      const dvec3 q = mirrored(p);
      return std::min(box_distance(q, dvec3(0.0, 73.0, -20.0), dvec3(1.0, 22.0, 16.0), 0.8),
        capsule_distance(q, dvec3(4.0, 100.0, -24.0), dvec3(9.0, 100.0, -30.0), 1.5, 1.5));
    },
    hu::cartilage);
  head.paint(
    [](const dvec3& p)
    {
      const dvec3 q = mirrored(p);
      // Two plates that meet in front, and the rings of the windpipe below.
      return std::min(
        capsule_distance(q, dvec3(2.0, 24.0, -118.0), dvec3(18.0, 2.0, -116.0), 2.2, 2.0),
        capsule_distance(q, dvec3(1.0, 22.0, -126.0), dvec3(16.0, 2.0, -126.0), 2.0, 2.0));
    },
    hu::cartilage);
  head.paint(
    [](const dvec3& p)
    {
      const double lining = airway(p) - 1.8;
      return lining < 2.0 * reach_of_skin ? std::max(lining, skin_surface(p)) : lining;
    },
    hu::mucosa);
  head.paint(airway, hu::air);
}

}
}
