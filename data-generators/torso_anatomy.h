// The parts of the torso phantom, in the order in which they are painted. Not installed.
//
// Places are in the phantom's RAS+ millimetres (torso_ct.h). What is alike on both sides is written
// once, for x above 0, and asked at |x|.
#pragma once

#include "data-generators/painted_volume.h"

#include <cstdint>

namespace brume
{
namespace torso
{

/// p on the patient's right.
inline glm::dvec3 mirrored(const glm::dvec3& p)
{
  return { p.x < 0.0 ? -p.x : p.x, p.y, p.z };
}

/// An ellipse across the body at some height: half its width and depth, and the y of its middle.
struct Girth
{
  double half_width, half_depth, middle;
};
/// Of the rib cage: the surface that the middles of the ribs lie on.
Girth rib_girth(double z);

/// Distance to an elliptical tube with that girth, to first order.
double girth_distance(const glm::dvec3& p, const Girth& girth);

/// The y of the middles of the vertebral bodies.
double spine_course(double z);

/// Signed distance to all that lies under the diaphragm's domes.
double under_diaphragm(const glm::dvec3& p);
/// Signed distance to the hollow that the ribs enclose.
double within_ribs(const glm::dvec3& p);

/// Skin, fat, muscles.
void paint_wall(PaintedVolume& torso);
/// The organs under the diaphragm.
void paint_belly(PaintedVolume& torso, std::uint32_t seed);
/// Lungs, with the vessels and airways in them; windpipe and gullet.
void paint_lungs(PaintedVolume& torso, std::uint32_t seed);
void paint_heart(PaintedVolume& torso);
void paint_bones(PaintedVolume& torso, std::uint32_t seed);
/// The great vessels.
void paint_vessels(PaintedVolume& torso);

}
}
