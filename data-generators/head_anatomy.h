// The parts of the head phantom, in the order in which they are painted. Not installed.
//
// Places are in the phantom's RAS+ millimetres (head_ct.h). What is alike on both sides is written
// once, for x above 0, and asked at |x|.
#pragma once

#include "data-generators/painted_volume.h"

#include <cstdint>

namespace brume
{
namespace head
{

/// p on the patient's right.
inline glm::dvec3 mirrored(const glm::dvec3& p)
{
  return { p.x < 0.0 ? -p.x : p.x, p.y, p.z };
}

/// Signed distance to the inside of the skull, from which brain and vault both take their shape.
double cranial_cavity(const glm::dvec3& p);

/// Skin, fat, muscle, cartilage, glands, and the air of nose, mouth and throat.
void paint_soft_tissue(PaintedVolume& head);
/// Skull, jaws, teeth, vertebrae, and the air within bone.
void paint_skull(PaintedVolume& head, std::uint32_t seed);
/// Eyes, with what fills their sockets.
void paint_eyes(PaintedVolume& head);
/// Brain, with its fluid, veins and arteries.
void paint_brain(PaintedVolume& head, std::uint32_t seed, double edge);

}
}
