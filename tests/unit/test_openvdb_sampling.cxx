// What Brume reads between the voxels of an OpenVDB file, against OpenVDB's own BoxSampler.
#include "../support/vdb_files.h"
#include "sparse_packets.h"

#include "vtkBrumeOpenVDBReader.h"
#include "vtkBrumeOpenVDBWriter.h"
#include "vtkBrumeSparseVolume.h"

#include "Transport/reference_grid.h"
#include "Transport/sparse_voxels.h"

#include "vtkMatrix4x4.h"
#include "vtkNew.h"

#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

using namespace vdb_files;

namespace
{

const std::string folder = BRUME_TEST_OUTPUT "/openvdb-sampling";

/// A ball with tiles of each level beside it, one of them inactive, and lone voxels on bricks'
/// faces.
openvdb::FloatGrid::Ptr test_grid()
{
  const auto grid = fog("density", { -5, 3, 9 }, 17.0);
  openvdb::FloatTree& tree = grid->tree();
  tree.addTile(1, { 40, 0, 0 }, 0.7f, true);
  tree.addTile(1, { 40, 8, 0 }, 0.4f, false);
  tree.addTile(2, { 128, 0, 0 }, 0.25f, true);
  std::mt19937 random(3);
  for (int n = 0; n < 400; ++n)
  {
    const auto at = [&random] { return static_cast<int>(random() % 120) - 60; };
    // On a face, an edge or a corner of a brick.
    openvdb::Coord c(at(), at(), at());
    for (int axis = 0; axis < 3; ++axis)
    {
      c[axis] = random() % 2 ? (c[axis] & ~7) + (random() % 2 ? 0 : 7) : c[axis];
    }
    tree.setValue(c, static_cast<float>(random() % 1000) / 1000.0f);
  }
  return grid;
}

/// Places of index space: anywhere, on and beside the faces of bricks, in and beside tiles.
std::vector<openvdb::Vec3d> places(std::mt19937& random)
{
  std::uniform_real_distribution<double> anywhere(-64.0, 70.0);
  std::uniform_real_distribution<double> little(-1e-3, 1e-3);
  std::uniform_real_distribution<double> tile(120.0, 264.0);
  std::vector<openvdb::Vec3d> list;
  for (int n = 0; n < 6000; ++n)
  {
    openvdb::Vec3d p(anywhere(random), anywhere(random), anywhere(random));
    if (n % 3 == 1) // by the faces of bricks
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        p[axis] = random() % 2
                    ? 8.0 * std::round(p[axis] / 8.0) + (random() % 2 ? -1.0 : 0.0) + little(random)
                    : p[axis];
      }
    }
    if (n % 3 == 2)
    {
      p = { tile(random), std::abs(2.0 * anywhere(random)), std::abs(2.0 * anywhere(random)) };
    }
    list.push_back(p);
  }
  return list;
}

openvdb::Mat4R rotated()
{
  openvdb::Mat4R m = openvdb::Mat4R::identity();
  m.postScale(openvdb::Vec3d(0.3, 0.5, 0.8));
  m.postRotate(openvdb::math::X_AXIS, 0.7);
  m.postRotate(openvdb::math::Z_AXIS, -1.9);
  m.postTranslate(openvdb::Vec3d(10.0, -20.0, 5.0));
  return m;
}

openvdb::Mat4R sheared()
{
  openvdb::Mat4R m = openvdb::Mat4R::identity();
  m.postScale(openvdb::Vec3d(2.0, 1.0, 0.25));
  m.postShear(openvdb::math::X_AXIS, openvdb::math::Y_AXIS, 0.6);
  m.postShear(openvdb::math::Z_AXIS, openvdb::math::X_AXIS, -0.35);
  m.postRotate(openvdb::math::Y_AXIS, 0.4);
  m.postTranslate(openvdb::Vec3d(-100.0, 0.5, 33.0));
  return m;
}

openvdb::Mat4R mirrored()
{
  openvdb::Mat4R m = rotated();
  m.postScale(openvdb::Vec3d(-1.0, 1.0, 1.0));
  return m;
}

struct Differences
{
  double reference = 0.0; ///< the reference's values at places of the world
  double packets = 0.0;   ///< the kernels' at places of index space
  int inside = 0;         ///< places where the value is not the background
};

/// The largest differences between what Brume and OpenVDB find, of grids with values up to 1.
Differences compare(vtkBrumeSparseVolume* volume, const openvdb::FloatGrid& grid)
{
  Differences d;
  const brume::SparseVoxels& voxels = *volume->GetVoxels();
  const auto reference = brume::ReferenceGrid::make(voxels.grid(), 0.0);
  vtkNew<vtkMatrix4x4> to_index;
  vtkMatrix4x4::Invert(volume->GetIndexToWorld(), to_index);
  const openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::BoxSampler> sampler(grid);
  std::mt19937 random(5);
  std::vector<glm::vec3> singles;
  std::vector<double> expected;
  for (const openvdb::Vec3d& place : places(random))
  {
    const openvdb::Vec3d world = grid.indexToWorld(place);
    const double in[4] = { world[0], world[1], world[2], 1.0 };
    double out[4];
    to_index->MultiplyPoint(in, out);
    glm::dvec3 index;
    bool within = true;
    for (int axis = 0; axis < 3; ++axis)
    {
      index[axis] = out[axis] - voxels.origin()[axis];
      // Beyond the box Brume's volume ends.
      within =
        within && index[axis] >= voxels.first()[axis] && index[axis] <= voxels.dims()[axis] - 1;
    }
    const double value = sampler.wsSample(world);
    if (!within)
    {
      EXPECT_EQ(value, grid.background());
      continue;
    }
    d.inside += value != grid.background();
    d.reference = std::max(d.reference, std::abs(reference->value(index, 0) - value));
    singles.emplace_back(index);
    const glm::vec3& s = singles.back(); // rounded: OpenVDB is asked at the very same place
    expected.push_back(sampler.isSample(openvdb::Vec3d(double(s.x) + voxels.origin()[0],
      double(s.y) + voxels.origin()[1],
      double(s.z) + voxels.origin()[2])));
  }
  const std::vector<float> packets = packet_values(voxels, singles);
  for (std::size_t i = 0; i < packets.size(); ++i)
  {
    d.packets = std::max(d.packets, std::abs(packets[i] - expected[i]));
  }
  EXPECT_GT(singles.size(), 5000u);
  return d;
}

class OpenVDBSampling : public testing::TestWithParam<std::pair<const char*, openvdb::Mat4R>>
{
};

TEST_P(OpenVDBSampling, AgreesWithBoxSampler)
{
  std::filesystem::create_directories(folder);
  const auto grid = test_grid();
  grid->setTransform(openvdb::math::Transform::createLinearTransform(GetParam().second));
  const std::string name = GetParam().first;
  vtkNew<vtkBrumeOpenVDBReader> reader;
  reader->SetFileName(write(folder, name + ".vdb", { grid }).c_str());
  reader->Update();
  ASSERT_STREQ(reader->GetErrorMessage(), "");
  const Differences d = compare(reader->GetOutput(), *grid);
  EXPECT_LT(d.reference, 1e-6);
  EXPECT_LT(d.packets, 1e-6);
  EXPECT_GT(d.inside, 1500);
  RecordProperty("largest_difference_reference", std::to_string(d.reference));
  RecordProperty("largest_difference_packets", std::to_string(d.packets));
  std::printf("%s: largest difference %.3g (reference), %.3g (kernels)\n",
    name.c_str(),
    d.reference,
    d.packets);

  // What Brume writes, OpenVDB samples the same.
  vtkNew<vtkBrumeOpenVDBWriter> writer;
  const std::string path = folder + "/" + name + "-again.vdb";
  writer->SetInputConnection(reader->GetOutputPort());
  writer->SetFileName(path.c_str());
  ASSERT_EQ(writer->Write(), 1) << writer->GetErrorMessage();
  openvdb::io::File file(path);
  file.open();
  const auto again = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("density"));
  const Differences second = compare(reader->GetOutput(), *again);
  EXPECT_LT(second.reference, 1e-6);
  EXPECT_LT(second.packets, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Transforms,
  OpenVDBSampling,
  testing::Values(std::pair("identity", openvdb::Mat4R::identity()),
    std::pair("rotated", rotated()),
    std::pair("sheared", sheared()),
    std::pair("mirrored", mirrored())),
  [](const auto& info) { return std::string(info.param.first); });

}
