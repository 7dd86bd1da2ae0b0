#include "../support/transport_scenes.h"

#include "Transport/ray.h"

#include <gtest/gtest.h>

#include <limits>

using namespace transport_scenes;

namespace
{

/// A grid of 5 × 4 × 3 points, box [0, 4] × [0, 3] × [0, 2], seen by a camera whose clip cube is the
/// given box of index space: rays run along −z from its top to its bottom.
struct BoxView
{
  Voxels<std::uint8_t> voxels{ 5, 4, 3, [](int, int, int) { return 1; } };
  Scene scene;

  BoxView(const glm::dvec3& lower, const glm::dvec3& upper)
  {
    scene.volumes[0].grid = voxels.grid();
    const glm::dvec3 half = 0.5 * (upper - lower);
    const glm::dmat4 world_from_clip = glm::scale(
      glm::translate(glm::dmat4(1.0), 0.5 * (upper + lower)), glm::dvec3(half.x, half.y, -half.z));
    scene.camera.clip_from_world = glm::inverse(world_from_clip);
  }
  RaySegment ray(int x, int y, int width, int height) const
  {
    return RayMaker(scene, width, height).segment(x, y);
  }
};

TEST(RayMaker, CutsToTheBoxAlongAnAxis)
{
  const BoxView view_box({ 0, 0, -8 }, { 4, 3, 8 });
  for (int y = 0; y < 3; ++y)
  {
    for (int x = 0; x < 4; ++x)
    {
      const RaySegment s = view_box.ray(x, y, 4, 3);
      EXPECT_DOUBLE_EQ(s.length, 2.0);
      EXPECT_DOUBLE_EQ(s.start_offset, 6.0);
      EXPECT_DOUBLE_EQ(s.begin.x, x + 0.5);
      EXPECT_DOUBLE_EQ(s.begin.y, y + 0.5);
      EXPECT_DOUBLE_EQ(s.begin.z, 2.0);
      EXPECT_DOUBLE_EQ(s.end.z, 0.0);
    }
  }
}

// Rays in a face, along an edge and through a corner's edge count as inside; a hair outside, as out.
TEST(RayMaker, FacesAndEdgesBelongToTheBox)
{
  for (double x : { 0.0, 4.0 })
  {
    for (double y : { 0.0, 1.5, 3.0 })
    {
      // One pixel: its ray runs through the middle of the clip cube.
      EXPECT_DOUBLE_EQ(BoxView({ x - 1, y - 1, -8 }, { x + 1, y + 1, 8 }).ray(0, 0, 1, 1).length, 2.0)
        << x << " " << y;
    }
  }
  EXPECT_EQ(BoxView({ -2.001, 0, -8 }, { 1.999, 3, 8 }).ray(0, 0, 1, 1).length, 0.0);
  EXPECT_EQ(BoxView({ 0, 5, -8 }, { 4, 8, 8 }).ray(0, 0, 1, 1).length, 0.0);
}

TEST(RayMaker, NothingBeforeTheNearOrBehindTheFarPlane)
{
  EXPECT_DOUBLE_EQ(BoxView({ 0, 0, 0.5 }, { 4, 3, 1.25 }).ray(0, 0, 1, 1).length, 0.75);
  EXPECT_EQ(BoxView({ 0, 0, 3 }, { 4, 3, 8 }).ray(0, 0, 1, 1).length, 0.0);
  EXPECT_EQ(BoxView({ 0, 0, -8 }, { 4, 3, -1 }).ray(0, 0, 1, 1).length, 0.0);
  // The camera inside: the way begins on the near plane.
  EXPECT_EQ(BoxView({ 0, 0, -8 }, { 4, 3, 1 }).ray(0, 0, 1, 1).start_offset, 0.0);
}

TEST(RayMaker, EndsAtASurface)
{
  BoxView view_box({ 0, 0, -8 }, { 4, 3, 8 });
  const auto length = [&](float depth)
  {
    view_box.scene.surface_depth = { depth };
    return view_box.ray(0, 0, 1, 1).length;
  };
  EXPECT_DOUBLE_EQ(length(1.0f), 2.0);
  EXPECT_DOUBLE_EQ(length(2.0f), 2.0); // beyond the far plane is the far plane
  EXPECT_DOUBLE_EQ(length(-0.125f), 1.0); // z = 1
  EXPECT_EQ(length(-0.5f), 0.0); // in front of the box
  EXPECT_EQ(length(-1.0f), 0.0); // on the near plane
  EXPECT_DOUBLE_EQ(length(std::numeric_limits<float>::quiet_NaN()), 2.0);
}

TEST(RayMaker, MinusZeroIsZero)
{
  // A camera that looks along +x with a mirrored y makes steps of −0 along y and z.
  BoxView view_box({ 0, 0, 0 }, { 1, 1, 1 });
  glm::dmat4 world_from_clip(0.0);
  world_from_clip[2] = glm::dvec4(10.0, -0.0, -0.0, 0.0);
  world_from_clip[0] = glm::dvec4(0.0, -2.0, 0.0, 0.0);
  world_from_clip[1] = glm::dvec4(0.0, 0.0, 2.0, 0.0);
  world_from_clip[3] = glm::dvec4(0.0, 0.0, -0.0, 1.0);
  view_box.scene.camera.clip_from_world = glm::inverse(world_from_clip);
  const RaySegment s = view_box.ray(0, 0, 1, 1);
  EXPECT_NEAR(s.length, 4.0, 1e-12); // along the edge y = z = 0
  EXPECT_NEAR(s.start_offset, 10.0, 1e-12);
}

TEST(RayMaker, AFlatOrBrokenMatrixIsAMiss)
{
  BoxView view_box({ 0, 0, 0 }, { 1, 1, 1 });
  view_box.scene.camera.clip_from_world = glm::dmat4(0.0);
  EXPECT_EQ(view_box.ray(0, 0, 1, 1).length, 0.0);
  view_box.scene.camera.clip_from_world =
    glm::dmat4(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(view_box.ray(0, 0, 1, 1).length, 0.0);
}

// Against rays made without matrices: perspective and parallel, oblique, uneven spacing, far away.
TEST(RayMaker, AgreesWithRaysMadeByHand)
{
  BoxView view_box({ 0, 0, 0 }, { 1, 1, 1 });
  const glm::dvec3 spacing(0.5, 2.0, 1.25);
  view_box.scene.volumes[0].data_from_index = placed(spacing, glm::dvec3(1e5, -3e4, 7e3));
  for (bool parallel : { false, true })
  {
    const View view = view_of(view_box.scene, glm::dvec3(-0.4, 0.7, 0.5), parallel);
    view_box.scene.camera = view.camera(4.0 / 3.0);
    int hits = 0;
    for (int y = 0; y < 24; ++y)
    {
      for (int x = 0; x < 32; ++x)
      {
        const RaySegment s = view_box.ray(x, y, 32, 24);
        long double from[3], to[3];
        view.ray(x, y, 32, 24, from, to);
        if (s.length == 0.0)
        {
          continue;
        }
        ++hits;
        // Both ends lie on the ray, and each on a face of the box.
        for (const glm::dvec3& end : { s.begin, s.end })
        {
          glm::dvec3 world = (end - glm::dvec3(2.0, 1.5, 1.0)) * spacing;
          glm::dvec3 a(from[0], from[1], from[2]);
          glm::dvec3 d = glm::normalize(glm::dvec3(to[0] - from[0], to[1] - from[1], to[2] - from[2]));
          EXPECT_LT(glm::length(glm::cross(world - a, d)), 1e-8);
          double face = 1.0;
          for (int axis = 0; axis < 3; ++axis)
          {
            face = std::min({ face,
              std::abs(end[axis]),
              std::abs(end[axis] - view_box.scene.volumes[0].grid.upper(axis)) });
          }
          EXPECT_LT(face, 1e-8);
        }
        EXPECT_NEAR(s.length, glm::length((s.end - s.begin) * spacing), 1e-8);
        glm::dvec3 a(from[0], from[1], from[2]);
        EXPECT_NEAR(s.start_offset,
          glm::length((s.begin - glm::dvec3(2.0, 1.5, 1.0)) * spacing - a), 1e-8);
      }
    }
    EXPECT_GT(hits, 100);
  }
}

}
