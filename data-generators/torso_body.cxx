// The torso phantom's wall, its lungs, heart and great vessels.
#include "data-generators/hounsfield.h"
#include "data-generators/noise.h"
#include "data-generators/portable_math.h"
#include "data-generators/random.h"
#include "data-generators/shaping.h"
#include "data-generators/signed_distance.h"
#include "data-generators/torso_anatomy.h"

#include <cmath>
#include <iterator>

namespace brume
{
namespace torso
{

namespace
{

using glm::dvec3;

/// A row of a table of girths, from top to bottom.
struct Level
{
  double z;
  Girth girth;
};

/// Between the rows, by cubics through them (Catmull and Rom); beyond them, the last row.
template <std::size_t rows>
Girth between(const Level (&table)[rows], double z)
{
  std::size_t i = 1;
  while (i + 1 < rows && table[i].z > z)
  {
    ++i;
  }
  const auto row = [&](std::size_t n) -> const Level& { return table[n < rows ? n : rows - 1]; };
  const Level& a = row(i > 1 ? i - 2 : 0);
  const Level& b = row(i - 1);
  const Level& c = row(i);
  const Level& d = row(i + 1);
  const double t = saturate((b.z - z) / (b.z - c.z));
  const auto cubic = [&](double Girth::*of)
  {
    const double pb = b.girth.*of;
    const double pc = c.girth.*of;
    const double mb = (pc - a.girth.*of) / (a.z - c.z) * (b.z - c.z);
    const double mc = (d.girth.*of - pb) / (b.z - d.z) * (b.z - c.z);
    return pb + t * (mb + t * (3.0 * (pc - pb) - 2.0 * mb - mc + t * (2.0 * (pb - pc) + mb + mc)));
  };
  return { cubic(&Girth::half_width), cubic(&Girth::half_depth), cubic(&Girth::middle) };
}

constexpr Level skin_levels[] = {
  { 290, { 60, 62, -16 } },
  { 255, { 66, 64, -20 } },
  { 228, { 108, 74, -22 } },
  { 203, { 152, 92, -14 } },
  { 170, { 162, 104, -6 } },
  { 120, { 162, 111, 0 } },
  { 60, { 158, 113, 2 } },
  { 0, { 150, 110, 2 } },
  { -60, { 146, 105, 2 } },
  { -120, { 153, 105, 0 } },
  { -180, { 168, 108, -4 } },
  { -230, { 176, 112, -8 } },
  { -290, { 172, 110, -10 } },
};

constexpr Level rib_levels[] = {
  { 232, { 34, 28, -20 } },
  { 215, { 60, 44, -18 } },
  { 190, { 92, 64, -12 } },
  { 150, { 122, 82, -4 } },
  { 100, { 136, 91, 0 } },
  { 50, { 140, 94, 2 } },
  { 0, { 138, 93, 2 } },
  { -40, { 132, 89, 2 } },
  { -90, { 126, 85, 0 } },
};

/// Thickness of the fat under the skin.
double fat_thickness(double z)
{
  return mix(8.0, 18.0, smooth_ramp(z, 60.0, -120.0));
}

double skin_surface(const dvec3& place)
{
  const dvec3 p = mirrored(place);
  double d = girth_distance(p, between(skin_levels, p.z));
  // The raised arm, and the breast muscle.
  d = smooth_union(d,
    capsule_distance(p, dvec3(122.0, -18.0, 195.0), dvec3(157.0, -18.0, 330.0), 46.0, 40.0),
    34.0);
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(66.0, 78.0, 128.0), dvec3(54.0, 34.0, 40.0)), 26.0);
  // The furrows of the spine and of the breastbone, and the navel.
  const double back =
    sphere_distance(dvec3(p.x, p.y, 0.0), dvec3(0.0, -122.0 + 0.03 * p.z, 0.0), 16.0);
  d = smooth_difference(d, back, 14.0);
  return smooth_difference(
    d, capsule_distance(p, dvec3(0.0, 120.0, -112.0), dvec3(0.0, 101.0, -112.0), 4.0, 4.0), 7.0);
}

}

Girth rib_girth(double z)
{
  return between(rib_levels, z);
}

double girth_distance(const dvec3& p, const Girth& g)
{
  const double x = p.x / g.half_width;
  const double y = (p.y - g.middle) / g.half_depth;
  const double k0 = std::sqrt(x * x + y * y);
  const double kx = x / g.half_width;
  const double ky = y / g.half_depth;
  const double k1 = std::sqrt(kx * kx + ky * ky);
  const double inmost = -std::min(g.half_width, g.half_depth);
  return k1 > 0.0 ? std::max(k0 * (k0 - 1.0) / k1, inmost) : inmost;
}

double spine_course(double z)
{
  const double bend = (z - 100.0) / 95.0;
  return -26.0 - 24.0 / (1.0 + bend * bend);
}

double within_ribs(const dvec3& p)
{
  const double cage = girth_distance(p, rib_girth(p.z)) + 7.0;
  return std::max(cage, p.z - 226.0);
}

double under_diaphragm(const dvec3& place)
{
  // Domes above, and straight down from where they are widest.
  const dvec3 p(place.x, place.y, std::max(place.z, -75.0));
  const double right = ellipsoid_distance(p, dvec3(68.0, 2.0, -75.0), dvec3(84.0, 96.0, 128.0));
  const double left = ellipsoid_distance(p, dvec3(-64.0, 4.0, -80.0), dvec3(86.0, 94.0, 118.0));
  return smooth_union(right, left, 18.0);
}

void paint_wall(PaintedVolume& torso)
{
  namespace hu = hounsfield;
  torso.paint(skin_surface, { { 0.0, hu::skin }, { 2.0, hu::fat } });
  torso.paint([](const dvec3& p) { return skin_surface(p) + fat_thickness(p.z); }, hu::muscle);
  // Fat between the muscles of chest wall, shoulder and back.
  const auto seam = [](double depth)
  {
    return [depth](const dvec3& p)
    {
      const double cage = girth_distance(p, rib_girth(p.z));
      return std::max({ std::fabs(cage - depth) - 1.2,
        skin_surface(p) + fat_thickness(p.z) + 2.0,
        std::fabs(p.z - 70.0) - 140.0,
        18.0 - std::fabs(p.x) });
    };
  };
  torso.paint(seam(9.0), hu::fat);
  torso.paint(seam(22.0), hu::fat);
  // The arm's hollow.
  torso.paint(
    [](const dvec3& place)
    {
      const dvec3 p = mirrored(place);
      return std::max(ellipsoid_distance(p, dvec3(122.0, 4.0, 182.0), dvec3(13.0, 22.0, 24.0)),
        10.0 - girth_distance(p, rib_girth(p.z)));
    },
    hu::fat);
}

namespace
{

/// A tree of vessels that grows into a hollow: walls at once, what they hold when it is full grown.
class Tree
{
public:
  Tree(PaintedVolume& torso, std::uint32_t seed, PaintedVolume::Distance hollow)
    : m_torso(torso)
    , m_hollow(std::move(hollow))
    , m_key(seed)
  {
  }

  /// A branch from a place along a direction, and two more from its end, until they are thin or
  /// leave the hollow.
  void grow(const dvec3& from,
    const dvec3& along,
    double radius,
    double length,
    double value,
    double wall)
  {
    if (radius < 0.7 || m_branches > 400)
    {
      return;
    }
    const dvec3 to = from + length * along;
    if (m_hollow(to) > -4.0)
    {
      return;
    }
    ++m_branches;
    const double thin = 0.82 * radius;
    const auto tube = [=](const dvec3& p) { return capsule_distance(p, from, to, radius, thin); };
    if (wall > 0.0)
    {
      m_torso.paint([=](const dvec3& p) { return tube(p) - wall; }, hounsfield::mucosa);
    }
    m_lumens.emplace_back(tube, value);
    // Two branches, opposite each other across, more or less at random.
    dvec3 across(this->number() - 0.5, this->number() - 0.5, this->number() - 0.5);
    across -= glm::dot(across, along) * along;
    const double length_across = glm::length(across);
    if (!(length_across > 1e-3))
    {
      return;
    }
    across /= length_across;
    const double share = mix(0.35, 0.75, this->number());
    const dvec3 one = glm::normalize(along + (0.35 + 0.9 * share) * across);
    const dvec3 other = glm::normalize(along - (0.35 + 0.9 * (1.0 - share)) * across);
    this->grow(to,
      one,
      0.86 * radius * (1.2 - 0.6 * share),
      length * mix(0.7, 0.95, this->number()),
      value,
      0.7 * wall);
    this->grow(to,
      other,
      0.86 * radius * (0.6 + 0.6 * share),
      length * mix(0.7, 0.95, this->number()),
      value,
      0.7 * wall);
  }

  /// Paints what the branches hold, once all their walls are there: a fork is open.
  void fill()
  {
    for (const auto& [tube, value] : m_lumens)
    {
      m_torso.paint(tube, value);
    }
    m_lumens.clear();
  }

private:
  double number() { return unit_float(mix_bits(m_key ^ mix_bits(++m_count))); }

  PaintedVolume& m_torso;
  PaintedVolume::Distance m_hollow;
  std::vector<std::pair<PaintedVolume::Distance, double>> m_lumens;
  std::uint32_t m_key;
  std::uint32_t m_count = 0;
  int m_branches = 0;
};

/// What lies between the lungs.
double mediastinum(const dvec3& p)
{
  double d = ellipsoid_distance(p, dvec3(-22.0, 36.0, 78.0), dvec3(56.0, 50.0, 52.0));
  d =
    smooth_union(d, ellipsoid_distance(p, dvec3(18.0, 18.0, 96.0), dvec3(38.0, 40.0, 46.0)), 10.0);
  d = smooth_union(
    d, capsule_distance(p, dvec3(-2.0, 8.0, 128.0), dvec3(0.0, 0.0, 240.0), 30.0, 24.0), 16.0);
  d = smooth_union(d,
    capsule_distance(p, dvec3(-16.0, -26.0, 150.0), dvec3(-12.0, -22.0, -40.0), 16.0, 16.0),
    10.0);
  // The front edge, behind the breastbone.
  const double front = std::max(std::fabs(p.x + 3.0) - 5.0, -p.y);
  d = smooth_union(d, front, 12.0);
  // The vertebral bodies, with what is beside them.
  const double spine =
    std::sqrt(p.x * p.x + (p.y - spine_course(p.z)) * (p.y - spine_course(p.z))) - 23.0;
  return smooth_union(d, spine, 12.0);
}

double lungs(const dvec3& p)
{
  double d = within_ribs(p);
  d = smooth_intersection(d, -mediastinum(p), 6.0);
  d = smooth_intersection(d, -34.0 - p.z, 6.0); // the lowest that lungs reach, behind
  return smooth_intersection(d, 3.0 - under_diaphragm(p), 4.0);
}

}

void paint_lungs(PaintedVolume& torso, std::uint32_t seed)
{
  namespace hu = hounsfield;
  // Fat and glands between the lungs.
  torso.paint(
    [](const dvec3& p) {
      return std::max({ mediastinum(p) + 1.0, within_ribs(p), -under_diaphragm(p) - 2.0 });
    },
    -70.0);
  const auto tissue = [seed](const dvec3& p, double depth)
  {
    // A little denser toward the back, where a patient who lies has more blood, and uneven.
    const double mottle = 25.0 * fbm(p / 14.0, substream(seed, 70), { 3, 2.0, 0.6 });
    const double value = hu::lung + mottle - 0.25 * p.y;
    // Fissures: one slanting in both lungs, a level one in the right.
    const double slanting = std::fabs(0.72 * (p.z - 92.0) + 0.69 * (p.y + 2.0)) +
                            2.0 * perlin_noise(p / 40.0, substream(seed, 71));
    double fissure = std::max(slanting, 0.0);
    if (p.x > 0.0 && 0.72 * (p.z - 92.0) + 0.69 * (p.y + 2.0) > 0.0)
    {
      fissure = std::min(fissure, std::fabs(p.z - 104.0 - 0.05 * p.x));
    }
    return mix(-640.0, value, smooth_ramp(std::min(fissure, depth), 0.4, 1.8));
  };
  torso.paint(lungs, { { 0.0, tissue } });

  // The trees: arteries and veins from the hilum, bronchi among them.
  const dvec3 right(44.0, -4.0, 112.0);
  const dvec3 left(-46.0, -6.0, 108.0);
  Tree arteries(torso, substream(seed, 72), lungs);
  Tree airways(torso, substream(seed, 73), lungs);
  static const dvec3 ways[] = { { 0.25, 0.25, 0.95 },
    { 0.8, 0.5, 0.2 },
    { 0.75, -0.5, 0.3 },
    { 0.6, 0.35, -0.75 },
    { 0.55, -0.5, -0.7 } };
  // On the left the heart is in the way: there the fourth goes out more to the side.
  const auto along_of = [](int way, double side)
  {
    const dvec3 along = way == 3 && side < 0.0 ? dvec3(0.75, 0.2, -0.62) : ways[way];
    return glm::normalize(dvec3(side * along.x, along.y, along.z));
  };
  const int count = static_cast<int>(std::size(ways));
  const dvec3 beside(4.0, 3.0, 3.0);
  for (int way = 0; way < count; ++way)
  {
    for (const double side : { 1.0, -1.0 })
    {
      const dvec3 along = along_of(way, side);
      const dvec3 hilum = (side > 0.0 ? right : left) + side * beside;
      arteries.grow(hilum + 8.0 * along, along, 4.0, 27.0, hu::portal_phase_vein, 0.0);
    }
  }
  arteries.fill();
  // After the vessels, which would else cut them where they cross; from the main bronchi's ends on.
  for (int way = 0; way < count; ++way)
  {
    for (const double side : { 1.0, -1.0 })
    {
      const dvec3 along = along_of(way, side);
      airways.grow(side > 0.0 ? right : left, along, 2.6, 32.0, hu::air, 1.0);
    }
  }
  airways.fill();

  // Windpipe and main bronchi; the gullet behind.
  const auto windpipe = [](const dvec3& p)
  {
    const double main = tube_distance(
      p, { dvec3(0.0, 10.0, 300.0), dvec3(0.0, 2.0, 210.0), dvec3(1.0, -8.0, 138.0) }, 8.5);
    const double right_branch =
      capsule_distance(p, dvec3(3.0, -9.0, 137.0), dvec3(42.0, -4.0, 112.0), 7.0, 5.5);
    const double left_branch =
      capsule_distance(p, dvec3(-2.0, -9.0, 137.0), dvec3(-44.0, -6.0, 108.0), 6.5, 5.0);
    return smooth_union(main, std::min(right_branch, left_branch), 3.0);
  };
  torso.paint([=](const dvec3& p) { return windpipe(p) - 1.8; }, hu::cartilage);
  torso.paint(windpipe, hu::air);
  const auto gullet = [](const dvec3& p)
  {
    return tube_distance(p,
      { dvec3(-2.0, -10.0, 300.0),
        dvec3(-5.0, -20.0, 200.0),
        dvec3(-5.0, -26.0, 130.0),
        dvec3(-10.0, -14.0, 60.0),
        dvec3(-24.0, -4.0, 28.0) },
      6.5);
  };
  torso.paint(gullet, hu::muscle);
  torso.paint([=](const dvec3& p) { return gullet(p) + 4.8; }, hu::air);
}

void paint_heart(PaintedVolume& torso)
{
  namespace hu = hounsfield;
  // Along u from the base to the tip, which points to the left, to the front and down.
  const dvec3 u = glm::normalize(dvec3(-0.72, 0.48, -0.50));
  const dvec3 v = glm::normalize(glm::cross(dvec3(0.0, 0.0, 1.0), u));
  const dvec3 w = glm::cross(u, v);
  const auto local = [=](const dvec3& p, const dvec3& centre)
  {
    const dvec3 q = p - centre;
    return dvec3(glm::dot(q, u), glm::dot(q, v), glm::dot(q, w));
  };
  const auto left_chamber = [=](const dvec3& p)
  {
    return ellipsoid_distance(
      local(p, dvec3(-36.0, 32.0, 76.0)), dvec3(0.0), dvec3(47.0, 30.0, 30.0));
  };
  const auto right_chamber = [=](const dvec3& p)
  {
    const double body =
      ellipsoid_distance(local(p, dvec3(-14.0, 52.0, 70.0)), dvec3(0.0), dvec3(48.0, 24.0, 28.0));
    const double outflow =
      capsule_distance(p, dvec3(-10.0, 52.0, 88.0), dvec3(-14.0, 38.0, 116.0), 17.0, 13.0);
    return smooth_union(body, outflow, 10.0);
  };
  const auto left_atrium = [](const dvec3& p)
  { return ellipsoid_distance(p, dvec3(2.0, -6.0, 104.0), dvec3(34.0, 20.0, 24.0)); };
  const auto right_atrium = [](const dvec3& p)
  { return ellipsoid_distance(p, dvec3(36.0, 24.0, 88.0), dvec3(24.0, 26.0, 34.0)); };
  torso.paint(
    [=](const dvec3& p)
    {
      return smooth_union(smooth_union(left_chamber(p), right_chamber(p), 8.0),
        smooth_union(left_atrium(p) - 2.0, right_atrium(p) - 2.0, 6.0),
        8.0);
    },
    hu::heart_muscle);
  torso.paint(right_atrium, hu::portal_phase_vein);
  torso.paint([=](const dvec3& p)
    { return smooth_difference(right_chamber(p) + 4.0, left_chamber(p), 2.0); },
    hu::portal_phase_vein);
  torso.paint(left_atrium, hu::portal_phase_artery);
  torso.paint([=](const dvec3& p) { return left_chamber(p) + 11.0; }, hu::portal_phase_artery);
  // The two papillary muscles, and the coronary arteries in the fat of the grooves.
  torso.paint(
    [=](const dvec3& p)
    {
      const dvec3 q = local(p, dvec3(-36.0, 32.0, 76.0));
      return std::min(capsule_distance(q, dvec3(26.0, 9.0, 9.0), dvec3(4.0, 11.0, 9.0), 4.0, 2.0),
        capsule_distance(q, dvec3(26.0, -9.0, -9.0), dvec3(4.0, -11.0, -9.0), 4.0, 2.0));
    },
    hu::heart_muscle);
  const auto coronary = [](const std::vector<dvec3>& course)
  { return [course](const dvec3& p) { return tube_distance(p, course, 1.7); }; };
  for (const std::vector<dvec3>& course : { std::vector<dvec3>{ dvec3(-12.0, 26.0, 112.0),
                                              dvec3(-34.0, 44.0, 108.0),
                                              dvec3(-52.0, 64.0, 84.0),
                                              dvec3(-66.0, 66.0, 56.0) },
         std::vector<dvec3>{
           dvec3(-24.0, 34.0, 112.0), dvec3(-52.0, 16.0, 104.0), dvec3(-62.0, 4.0, 84.0) },
         std::vector<dvec3>{ dvec3(4.0, 32.0, 112.0),
           dvec3(30.0, 52.0, 100.0),
           dvec3(34.0, 54.0, 66.0),
           dvec3(10.0, 34.0, 46.0) } })
  {
    torso.paint(coronary(course), hu::portal_phase_artery);
  }
}

void paint_vessels(PaintedVolume& torso)
{
  namespace hu = hounsfield;
  struct Course
  {
    std::vector<dvec3> places;
    double radius;
  };
  const auto paint = [&](const std::vector<Course>& courses, double value)
  {
    for (const Course& c : courses)
    {
      torso.paint([c](const dvec3& p) { return tube_distance(p, c.places, c.radius); }, value);
    }
  };
  // Veins: the upper and the lower hollow vein and what drains into them.
  paint(
    { { { dvec3(24.0, 14.0, 190.0), dvec3(28.0, 14.0, 150.0), dvec3(32.0, 18.0, 110.0) }, 9.0 },
      { { dvec3(60.0, 10.0, 222.0), dvec3(28.0, 16.0, 196.0) }, 6.0 },
      { { dvec3(-70.0, 10.0, 222.0), dvec3(-20.0, 24.0, 202.0), dvec3(26.0, 16.0, 188.0) }, 6.0 },
      { { dvec3(30.0, 12.0, 300.0), dvec3(30.0, 12.0, 205.0) }, 6.0 },
      { { dvec3(-32.0, 12.0, 300.0), dvec3(-30.0, 14.0, 212.0) }, 5.5 },
      { { dvec3(15.0, 2.0, -148.0),
          dvec3(17.0, 2.0, -60.0),
          dvec3(22.0, 2.0, 10.0),
          dvec3(32.0, 14.0, 66.0) },
        10.0 },
      { { dvec3(15.0, 2.0, -146.0),
          dvec3(44.0, -6.0, -190.0),
          dvec3(64.0, 34.0, -260.0),
          dvec3(66.0, 40.0, -300.0) },
        6.5 },
      { { dvec3(13.0, 2.0, -146.0),
          dvec3(-36.0, -8.0, -190.0),
          dvec3(-62.0, 34.0, -260.0),
          dvec3(-64.0, 40.0, -300.0) },
        6.5 },
      { { dvec3(20.0, 2.0, -66.0), dvec3(44.0, -24.0, -72.0) }, 4.5 },
      { { dvec3(14.0, 10.0, -62.0), dvec3(-20.0, 12.0, -58.0), dvec3(-46.0, -22.0, -60.0) }, 4.5 },
      // The pulmonary trunk and its two branches.
      { { dvec3(-14.0, 38.0, 112.0), dvec3(-16.0, 26.0, 132.0), dvec3(-14.0, 10.0, 140.0) }, 12.0 },
      { { dvec3(-12.0, 10.0, 138.0), dvec3(20.0, 0.0, 128.0), dvec3(48.0, -1.0, 116.0) }, 8.5 },
      { { dvec3(-16.0, 10.0, 140.0), dvec3(-34.0, -6.0, 132.0), dvec3(-50.0, -8.0, 114.0) },
        8.5 } },
    hu::portal_phase_vein);
  // Arteries: the veins of the lungs carry the same blood.
  paint(
    { { { dvec3(20.0, -8.0, 106.0), dvec3(50.0, -8.0, 98.0) }, 5.5 },
      { { dvec3(-20.0, -10.0, 106.0), dvec3(-50.0, -10.0, 96.0) }, 5.5 },
      { { dvec3(-12.0, 24.0, 98.0),
          dvec3(2.0, 22.0, 118.0),
          dvec3(12.0, 26.0, 146.0),
          dvec3(8.0, 18.0, 168.0),
          dvec3(-6.0, 2.0, 176.0),
          dvec3(-18.0, -18.0, 168.0),
          dvec3(-23.0, -30.0, 146.0) },
        13.5 },
      { { dvec3(-23.0, -30.0, 146.0),
          dvec3(-22.0, -32.0, 90.0),
          dvec3(-16.0, -22.0, 20.0),
          dvec3(-12.0, -4.0, -30.0) },
        11.0 },
      { { dvec3(-12.0, -4.0, -30.0), dvec3(-8.0, 0.0, -80.0), dvec3(-4.0, 2.0, -136.0) }, 8.8 },
      { { dvec3(-4.0, 2.0, -136.0),
          dvec3(32.0, 4.0, -186.0),
          dvec3(54.0, 34.0, -250.0),
          dvec3(60.0, 50.0, -300.0) },
        5.0 },
      { { dvec3(-4.0, 2.0, -136.0),
          dvec3(-34.0, 2.0, -186.0),
          dvec3(-54.0, 34.0, -250.0),
          dvec3(-58.0, 50.0, -300.0) },
        5.0 },
      { { dvec3(34.0, 0.0, -188.0), dvec3(38.0, -34.0, -220.0) }, 3.2 },
      { { dvec3(-34.0, -2.0, -188.0), dvec3(-38.0, -34.0, -220.0) }, 3.2 },
      { { dvec3(4.0, 14.0, 176.0), dvec3(20.0, 14.0, 212.0) }, 6.0 },
      { { dvec3(20.0, 14.0, 212.0), dvec3(26.0, 8.0, 300.0) }, 3.6 },
      { { dvec3(20.0, 14.0, 212.0),
          dvec3(62.0, 4.0, 226.0),
          dvec3(112.0, -8.0, 224.0),
          dvec3(134.0, -14.0, 300.0) },
        4.0 },
      { { dvec3(-6.0, 6.0, 178.0), dvec3(-22.0, 8.0, 230.0), dvec3(-26.0, 8.0, 300.0) }, 3.6 },
      { { dvec3(-14.0, -8.0, 174.0),
          dvec3(-40.0, -2.0, 220.0),
          dvec3(-112.0, -8.0, 224.0),
          dvec3(-134.0, -14.0, 300.0) },
        4.4 },
      // To liver and spleen, bowel and kidneys.
      { { dvec3(-10.0, 0.0, -38.0), dvec3(-8.0, 18.0, -42.0), dvec3(28.0, 24.0, -38.0) }, 3.0 },
      { { dvec3(-8.0, 18.0, -42.0), dvec3(-48.0, 0.0, -32.0), dvec3(-78.0, -26.0, -16.0) }, 3.0 },
      { { dvec3(-9.0, 2.0, -52.0), dvec3(-4.0, 24.0, -76.0), dvec3(4.0, 34.0, -130.0) }, 3.4 },
      { { dvec3(-8.0, 0.0, -64.0), dvec3(44.0, -26.0, -76.0) }, 2.8 },
      { { dvec3(-8.0, 0.0, -62.0), dvec3(-46.0, -26.0, -66.0) }, 2.8 } },
    hu::portal_phase_artery);
}

}
}
