// Damaged OpenVDB files.
#include "trial.h"

#include "../support/vdb_files.h"
#include "../unit/scan_files.h"

#include "vtkBrumeOpenVDBReader.h"
#include "vtkBrumeSparseVolume.h"

#include "Transport/sparse_voxels.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkNew.h"

#include <openvdb/tools/Dense.h>

using namespace hostile;

namespace
{

std::string read_sparse(const std::string& path)
{
  vtkNew<vtkCallbackCommand> silent;
  silent->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
  vtkNew<vtkBrumeOpenVDBReader> reader;
  reader->AddObserver(vtkCommand::ErrorEvent, silent);
  reader->SetMaximumMemory(memory_limit);
  reader->SetFileName(path.c_str());
  reader->Update();
  const std::string error = reader->GetErrorMessage();
  if (!error.empty())
  {
    return error;
  }
  vtkBrumeSparseVolume* volume = reader->GetOutput();
  if (!volume || !volume->GetVoxels() || volume->GetVoxels()->places().empty())
  {
    if (volume && volume->GetVoxels() && !volume->GetVoxels()->tiles().empty())
    {
      return {};
    }
    throw std::runtime_error(path + ": read, and no voxels");
  }
  double range[2];
  volume->GetValueRange(range);
  return {};
}

}

TEST(HostileFiles, OpenVdb)
{
  const std::string here = scan_files::folder();
  std::vector<Example> examples;
  const auto add = [&](const openvdb::GridPtrVec& grids, std::uint32_t compression)
  {
    const std::string path = here + "a.vdb";
    openvdb::io::File file(path);
    file.setCompression(compression);
    file.write(grids);
    file.close();
    examples.push_back({ "a.vdb", { { "a.vdb", scan_files::load(path) } } });
  };
  const auto ball = vdb_files::fog("density", { 3, -2, 1 }, 4.0);
  add({ ball }, openvdb::io::COMPRESS_NONE);
  add({ ball }, openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK);
  add({ ball }, openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
  const auto half = vdb_files::fog("half", { 0, 0, 0 }, 3.0);
  half->setSaveFloatAsHalf(true);
  half->tree().addTile(2, openvdb::Coord(4096, 0, 0), 0.5f, true);
  half->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
  const auto fine = vdb_files::fog<openvdb::DoubleGrid>("fine", { 0, 0, 0 }, 2.0);
  add({ half, fine }, openvdb::io::COMPRESS_ACTIVE_MASK);
  try_reader(examples, read_sparse, 60); // few: each is read in a process of its own first
}
