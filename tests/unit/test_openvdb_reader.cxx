// vtkBrumeOpenVDBReader against OpenVDB's own accessor, on files that OpenVDB writes.
#include "../support/vdb_files.h"

#include "vtkBrumeOpenVDBReader.h"
#include "vtkBrumeSparseVolume.h"

#include "Transport/sparse_voxels.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"

#include <openvdb/io/Stream.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <openvdb/tools/LevelSetUtil.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

using namespace vdb_files;

namespace
{

/// A reader whose errors are heard rather than printed.
struct Reader
{
  vtkNew<vtkBrumeOpenVDBReader> reader;
  vtkNew<vtkCallbackCommand> ear;
  int errors = 0;
  int progress = 0;

  explicit Reader(const std::string& path, const char* grid = nullptr)
  {
    this->ear->SetClientData(this);
    this->ear->SetCallback(
      [](vtkObject*, unsigned long event, void* data, void*)
      {
        auto& self = *static_cast<Reader*>(data);
        ++(event == vtkCommand::ErrorEvent ? self.errors : self.progress);
      });
    this->reader->AddObserver(vtkCommand::ErrorEvent, this->ear);
    this->reader->AddObserver(vtkCommand::ProgressEvent, this->ear);
    this->reader->SetFileName(path.c_str());
    this->reader->SetGridName(grid);
    this->reader->Update();
  }
  vtkBrumeSparseVolume* output() { return this->reader->GetOutput(); }
  std::string error() { return this->reader->GetErrorMessage(); }
};

/// Every voxel of the box around the volume, and some beyond it, are those of OpenVDB's accessor.
template <class Grid>
void expect_same_values(vtkBrumeSparseVolume* volume, const Grid& grid)
{
  ASSERT_TRUE(volume->GetVoxels());
  const brume::SparseVoxels& voxels = *volume->GetVoxels();
  const auto accessor = grid.getConstAccessor();
  const auto& o = voxels.origin();
  std::mt19937 random(2);
  const std::size_t all = std::size_t(voxels.dims()[0]) * voxels.dims()[1] * voxels.dims()[2];
  const std::size_t stride = 1 + all / 400000;
  for (std::size_t n = 0; n < all; n += 1 + random() % (2 * stride - 1))
  {
    const int i = int(n % voxels.dims()[0]);
    const int j = int(n / voxels.dims()[0] % voxels.dims()[1]);
    const int k = int(n / voxels.dims()[0] / voxels.dims()[1]);
    ASSERT_EQ(voxels.value(i, j, k), float(accessor.getValue({ i + o[0], j + o[1], k + o[2] })))
      << i << ' ' << j << ' ' << k;
  }
  for (auto voxel = grid.cbeginValueOn(); voxel; ++voxel)
  {
    openvdb::CoordBBox box;
    voxel.getBoundingBox(box);
    for (const openvdb::Coord& c : { box.min(), box.max() })
    {
      ASSERT_EQ(voxels.value(c[0] - o[0], c[1] - o[1], c[2] - o[2]), float(*voxel));
    }
  }
  EXPECT_EQ(volume->GetActiveVoxelCount(), vtkIdType(grid.activeVoxelCount()));
}

void expect_same_place(vtkBrumeSparseVolume* volume, const openvdb::GridBase& grid)
{
  for (const openvdb::Vec3d& p : { openvdb::Vec3d(0, 0, 0), openvdb::Vec3d(3, -7, 20) })
  {
    const openvdb::Vec3d expected = grid.indexToWorld(p);
    const double in[4] = { p[0], p[1], p[2], 1.0 };
    double out[4];
    volume->GetIndexToWorld()->MultiplyPoint(in, out);
    for (int a = 0; a < 3; ++a)
    {
      EXPECT_NEAR(out[a], expected[a], 1e-9);
    }
  }
}

const std::string folder = BRUME_TEST_OUTPUT;

}

TEST(OpenVDBReader, ReadsFloats)
{
  const auto grid = fog("density", { -40, 13, 5 });
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
  const std::string path = write(folder, "float.vdb", { grid });
  EXPECT_TRUE(vtkBrumeOpenVDBReader::CanReadFile(path.c_str()));
  Reader reader(path);
  EXPECT_EQ(reader.error(), "");
  EXPECT_EQ(reader.errors, 0);
  EXPECT_GT(reader.progress, 0);
  expect_same_values(reader.output(), *grid);
  expect_same_place(reader.output(), *grid);
  EXPECT_EQ(reader.output()->GetName(), "density");
  EXPECT_EQ(reader.output()->GetVoxels()->type(), brume::VoxelType::Float32);
  EXPECT_EQ(reader.reader->GetNumberOfGrids(), 1);
  EXPECT_STREQ(reader.reader->GetTypeOfGrid(0), "float");
  EXPECT_STREQ(reader.reader->GetKindOfGrid(0), "fog volume");
  EXPECT_EQ(reader.reader->GetNameOfGrid(1), nullptr);
  double range[2];
  reader.output()->GetValueRange(range);
  EXPECT_EQ(range[0], 0.0);
  EXPECT_EQ(range[1], 1.0);
  double bounds[6], spacing[3];
  reader.output()->GetBounds(bounds);
  reader.output()->GetSpacing(spacing);
  EXPECT_EQ(spacing[1], 0.25);
  const openvdb::CoordBBox active = grid->evalActiveVoxelBoundingBox();
  for (int a = 0; a < 3; ++a)
  {
    EXPECT_LE(bounds[2 * a], 0.25 * (active.min()[a] - 1));
    EXPECT_GE(bounds[2 * a + 1], 0.25 * (active.max()[a] + 1));
    EXPECT_GE(bounds[2 * a], 0.25 * (active.min()[a] - 8));
    EXPECT_LE(bounds[2 * a + 1], 0.25 * (active.max()[a] + 8));
  }
}

TEST(OpenVDBReader, KeepsHalves)
{
  const auto grid = fog("density");
  grid->setSaveFloatAsHalf(true);
  const std::string path = write(folder, "half.vdb", { grid });
  Reader reader(path);
  EXPECT_EQ(reader.error(), "");
  EXPECT_STREQ(reader.reader->GetTypeOfGrid(0), "half");
  ASSERT_TRUE(reader.output()->GetVoxels());
  EXPECT_EQ(reader.output()->GetVoxels()->type(), brume::VoxelType::Float16);
  openvdb::io::File file(path);
  file.open();
  expect_same_values(
    reader.output(), *openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("density")));
}

TEST(OpenVDBReader, RoundsDoublesAndSaysSo)
{
  const auto grid = fog<openvdb::DoubleGrid>("density");
  Reader reader(write(folder, "double.vdb", { grid }));
  EXPECT_EQ(reader.error(), "");
  expect_same_values(reader.output(), *grid);
  EXPECT_EQ(reader.reader->GetNumberOfMessages(), 1);
}

TEST(OpenVDBReader, ReadsTilesOfEveryLevelAndABackground)
{
  const auto grid = fog("density", { 2, 3, 4 }, 30.0, 0.125);
  openvdb::FloatTree& tree = grid->tree();
  tree.addTile(1, openvdb::Coord(-16, 0, -200), 0.5f, true);    // 8³
  tree.addTile(2, openvdb::Coord(128, 128, -256), 0.75f, true); // 128³
  tree.addTile(3, openvdb::Coord(-8192, 0, 0), 1.5f, true);     // 4096³
  tree.addTile(1, openvdb::Coord(64, -64, 0), 0.25f, false); // inactive, and a value all the same
  Reader reader(write(folder, "tiles.vdb", { grid }));
  EXPECT_EQ(reader.error(), "");
  expect_same_values(reader.output(), *grid);
  EXPECT_EQ(reader.output()->GetVoxels()->background(), 0.125);
  EXPECT_EQ(reader.output()->GetVoxels()->tile_slots(), 4u);
  EXPECT_LT(reader.output()->GetActualMemorySize(), 40000u); // KiB, for 7·10¹⁰ voxels
}

TEST(OpenVDBReader, TakesAnyAffineTransform)
{
  const openvdb::Mat4d matrices[] = {
    openvdb::math::rotation<openvdb::Mat4d>(openvdb::Vec3d(1, 2, 3).unit(), 0.7),
    openvdb::Mat4d(
      1.0, 0.3, 0.0, 0.0, 0.0, 2.0, -0.4, 0.0, 0.1, 0.0, -3.0, 0.0, 100.0, -200.0, 5.0, 1.0),
  };
  for (const openvdb::Mat4d& matrix : matrices)
  {
    const auto grid = fog("density");
    grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
    Reader reader(write(folder, "affine.vdb", { grid }));
    EXPECT_EQ(reader.error(), "");
    expect_same_place(reader.output(), *grid);
  }
}

TEST(OpenVDBReader, ChoosesAmongSeveralGrids)
{
  const auto surface =
    openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(10.0f, openvdb::Vec3f(0, 0, 0), 1.0f);
  surface->setName("surface");
  const auto velocity = openvdb::Vec3SGrid::create();
  velocity->setName("a velocity");
  const auto smoke = fog("smoke", { 0, 0, 0 }, 9.0);
  const auto heat = fog("heat", { 0, 0, 0 }, 11.0);
  const auto again = fog("smoke", { 0, 0, 0 }, 13.0);
  const std::string path = write(folder, "several.vdb", { velocity, surface, smoke, heat, again });
  {
    Reader reader(path);
    EXPECT_EQ(reader.error(), "");
    EXPECT_EQ(reader.reader->GetNumberOfGrids(), 5);
    EXPECT_EQ(reader.reader->GetGridIndex(), 2);
    EXPECT_STREQ(reader.reader->GetKindOfGrid(1), "level set");
    expect_same_values(reader.output(), *smoke);
    ASSERT_EQ(reader.reader->GetNumberOfMessages(), 1);
    EXPECT_NE(std::string(reader.reader->GetMessage(0)).find("heat"), std::string::npos);
  }
  {
    Reader reader(path, "heat");
    expect_same_values(reader.output(), *heat);
    // The same reader, another grid.
    reader.reader->SetGridName(reader.reader->GetNameOfGrid(4));
    reader.reader->Update();
    EXPECT_EQ(reader.error(), "");
    expect_same_values(reader.output(), *again);
  }
  for (const auto& [name, words] : { std::pair("a velocity", "holds vec3s"),
         std::pair("none", "no grid 'none'") })
  {
    Reader reader(path, name);
    EXPECT_EQ(reader.errors, 1);
    EXPECT_EQ(reader.error().find(path + ": "), 0u);
    EXPECT_NE(reader.error().find(words), std::string::npos) << reader.error();
    EXPECT_FALSE(reader.output()->GetVoxels());
    EXPECT_EQ(reader.reader->GetGridIndex(), -1);
  }
}

TEST(OpenVDBReader, ReadsLevelSetsAsFogOrAsDistances)
{
  // Also of doubles, and with a transform that is none of a level set's.
  const auto ball =
    openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(40.0f, openvdb::Vec3f(3, 0, 0), 1.5f);
  ball->setName("ball");
  const auto deep =
    openvdb::tools::createLevelSetSphere<openvdb::DoubleGrid>(30.0, openvdb::Vec3d(0, 0, 0), 1.0, 5.0);
  deep->setName("deep");
  openvdb::FloatGrid::Ptr broken = ball->deepCopy();
  broken->setName("broken");
  broken->tree().root().setBackground(-1.0f, /*updateChildNodes=*/false);
  const std::string path = write(folder, "level-sets.vdb", { ball, deep, broken });

  Reader fog(path);
  EXPECT_EQ(fog.error(), "");
  EXPECT_STREQ(fog.reader->GetNameOfGrid(fog.reader->GetGridIndex()), "ball");
  EXPECT_EQ(fog.output()->GetGridClass(), vtkBrumeSparseVolume::GridClassFogVolume);
  ASSERT_GE(fog.reader->GetNumberOfMessages(), 1);
  EXPECT_NE(std::string(fog.reader->GetMessage(0)).find("depth of 4.5"), std::string::npos);
  const openvdb::FloatGrid::Ptr expected = ball->deepCopy();
  openvdb::tools::sdfToFogVolume(*expected);
  expect_same_values(fog.output(), *expected);
  EXPECT_EQ(fog.output()->GetValueRange()[0], 0.0);
  EXPECT_EQ(fog.output()->GetValueRange()[1], 1.0);

  fog.reader->SetLevelSets(vtkBrumeOpenVDBReader::LevelSetsAsDistances);
  for (const openvdb::GridBase::Ptr& grid : { openvdb::GridBase::Ptr(ball), openvdb::GridBase::Ptr(deep) })
  {
    fog.reader->SetGridName(grid->getName().c_str());
    fog.reader->Update();
    EXPECT_EQ(fog.error(), "");
    EXPECT_EQ(fog.output()->GetGridClass(), vtkBrumeSparseVolume::GridClassLevelSet);
    if (grid == ball)
    {
      expect_same_values(fog.output(), *ball);
      EXPECT_FLOAT_EQ(fog.output()->GetValueRange()[0], -4.5f);
    }
    else
    {
      expect_same_values(fog.output(), *deep);
    }
  }
  Reader without_band(path, "broken");
  EXPECT_NE(without_band.error().find("no width of a band"), std::string::npos)
    << without_band.error();
}

TEST(OpenVDBReader, ReadsAFileThatWasSavedAsAStream)
{
  const auto grid = fog("density");
  const std::string path = folder + "/stream.vdb";
  {
    std::ofstream out(path, std::ios::binary);
    openvdb::io::Stream(out).write(openvdb::GridCPtrVec{ grid });
  }
  Reader reader(path);
  EXPECT_EQ(reader.error(), "");
  expect_same_values(reader.output(), *grid);
}

TEST(OpenVDBReader, ReadsEachCompression)
{
  const auto grid = fog("density");
  for (std::uint32_t flags : { std::uint32_t(openvdb::io::COMPRESS_NONE),
         std::uint32_t(openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK),
         std::uint32_t(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK) })
  {
    const std::string path = folder + "/compressed.vdb";
    openvdb::io::File file(path);
    file.setCompression(flags);
    file.write(openvdb::GridPtrVec{ grid });
    file.close();
    Reader reader(path);
    EXPECT_EQ(reader.error(), "");
    expect_same_values(reader.output(), *grid);
  }
}

TEST(OpenVDBReader, RefusesWhatHoldsNothing)
{
  const auto empty = openvdb::FloatGrid::create();
  empty->setName("density");
  Reader reader(write(folder, "empty.vdb", { empty }));
  EXPECT_EQ(reader.errors, 1);
  EXPECT_NE(reader.error().find("holds no voxels"), std::string::npos);
  Reader none(write(folder, "none.vdb", {}));
  EXPECT_NE(none.error().find("holds no grid"), std::string::npos) << none.error();
}

TEST(OpenVDBReader, RefusesAPerspectiveTransform)
{
  const auto grid = fog("density");
  grid->setTransform(openvdb::math::Transform::createFrustumTransform(
    openvdb::BBoxd(openvdb::Vec3d(-30), openvdb::Vec3d(30)), 0.5, 10.0));
  Reader reader(write(folder, "frustum.vdb", { grid }));
  EXPECT_EQ(reader.errors, 1);
  EXPECT_NE(reader.error().find("frustum"), std::string::npos) << reader.error();
}

// Cut at many places: always one error, never voxels, never a crash.
TEST(OpenVDBReader, FindsATruncatedFileOut)
{
  const std::string path = write(folder, "whole.vdb", { fog("a"), fog("b") });
  std::ifstream in(path, std::ios::binary);
  std::stringstream content;
  content << in.rdbuf();
  const std::string bytes = content.str();
  const std::string cut = folder + "/cut.vdb";
  for (double part : { 0.0, 0.00005, 0.0001, 0.0003, 0.0006, 0.001, 0.01, 0.3, 0.6, 0.9, 0.99999 })
  {
    std::ofstream(cut, std::ios::binary)
      .write(bytes.data(), std::streamsize(part * double(bytes.size())));
    Reader reader(cut);
    EXPECT_EQ(reader.errors, 1) << part;
    EXPECT_EQ(reader.error().find(cut + ": "), 0u) << reader.error();
    EXPECT_EQ(reader.error().find('\n'), std::string::npos);
    EXPECT_FALSE(reader.output()->GetVoxels());
  }
}

TEST(OpenVDBReader, RefusesWhatIsNotOpenVDB)
{
  const std::string path = folder + "/not.vdb";
  std::ofstream(path) << "NRRD0004\n";
  EXPECT_FALSE(vtkBrumeOpenVDBReader::CanReadFile(path.c_str()));
  EXPECT_FALSE(vtkBrumeOpenVDBReader::CanReadFile("/none"));
  EXPECT_FALSE(vtkBrumeOpenVDBReader::CanReadFile(nullptr));
  for (const std::string& bad : { path, folder, folder + "/missing.vdb", std::string() })
  {
    Reader reader(bad);
    EXPECT_EQ(reader.errors, 1);
    EXPECT_FALSE(reader.output()->GetVoxels());
  }
}

TEST(OpenVDBReader, ReadsAgainAfterAnError)
{
  const auto grid = fog("density");
  const std::string path = write(folder, "again.vdb", { grid });
  Reader reader(folder + "/missing.vdb");
  EXPECT_EQ(reader.errors, 1);
  reader.reader->SetFileName(path.c_str());
  reader.reader->Update();
  EXPECT_EQ(reader.error(), "");
  expect_same_values(reader.output(), *grid);
}

TEST(OpenVDBReader, OfALargeStreamTheGridsAreListed)
{
  // Without a table of contents all nodes are read to list the grids: half a million here.
  openvdb::initialize();
  const auto mask = openvdb::MaskGrid::create();
  mask->setName("mask");
  constexpr int Leaves = 80; // a side
  for (int z = 0; z < Leaves; ++z)
    for (int y = 0; y < Leaves; ++y)
      for (int x = 0; x < Leaves; ++x)
      {
        mask->tree().touchLeaf({ 8 * x, 8 * y, 8 * z })->setValueOn(7);
      }
  const auto grid = fog("density");
  const std::string path = folder + "/stream.vdb";
  {
    std::ofstream out(path, std::ios::binary);
    openvdb::io::Stream(out).write(openvdb::GridCPtrVec{ mask, grid });
  }
  EXPECT_GT(std::filesystem::file_size(path), 32u << 20);
  Reader read(path);
  ASSERT_EQ(read.error(), "");
  EXPECT_EQ(read.reader->GetNumberOfGrids(), 2);
  EXPECT_EQ(read.output()->GetActiveVoxelCount(), static_cast<vtkIdType>(grid->activeVoxelCount()));
  std::filesystem::remove(path);
}

TEST(SparseVolume, CopiesShareTheVoxels)
{
  Reader reader(write(folder, "copy.vdb", { fog("density") }));
  vtkBrumeSparseVolume* volume = reader.output();
  for (bool deep : { false, true })
  {
    vtkNew<vtkBrumeSparseVolume> copy;
    deep ? copy->DeepCopy(volume) : copy->ShallowCopy(volume);
    EXPECT_EQ(copy->GetVoxels(), volume->GetVoxels());
    EXPECT_EQ(copy->GetName(), "density");
    EXPECT_EQ(copy->GetActiveVoxelCount(), volume->GetActiveVoxelCount());
    double a[6], b[6];
    copy->GetBounds(a);
    volume->GetBounds(b);
    EXPECT_TRUE(std::equal(a, a + 6, b));
    EXPECT_GE(copy->GetActualMemorySize(), 1u);
    copy->Initialize();
    EXPECT_FALSE(copy->GetVoxels());
    copy->GetBounds(a);
    EXPECT_GT(a[0], a[1]);
    std::ostringstream text;
    volume->Print(text);
    EXPECT_NE(text.str().find("bricks"), std::string::npos);
  }
}
