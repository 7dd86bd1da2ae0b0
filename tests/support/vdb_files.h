// OpenVDB files for the tests, and one that tells what a reader complained of.
#pragma once

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <random>
#include <string>

namespace vdb_files
{

/// A ball with a rough edge, in [0, 1], 0 outside.
inline double rough_ball(int i, int j, int k, double radius)
{
  const double r = std::sqrt(double(i) * i + double(j) * j + double(k) * k) / radius;
  const double bumps = 0.2 * std::sin(0.5 * i) * std::sin(0.4 * j) * std::sin(0.3 * k);
  return std::min(1.0, std::max(0.0, 1.0 - r * r + bumps));
}

/// A fog volume of such a ball around `centre`.
template <class Grid = openvdb::FloatGrid>
typename Grid::Ptr fog(const std::string& name,
  const openvdb::Coord& centre = { 0, 0, 0 },
  double radius = 21.0,
  double background = 0.0)
{
  openvdb::initialize();
  using Value = typename Grid::ValueType;
  auto grid = Grid::create(static_cast<Value>(background));
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  auto accessor = grid->getAccessor();
  const int edge = static_cast<int>(radius * 1.3);
  for (int k = -edge; k <= edge; ++k)
    for (int j = -edge; j <= edge; ++j)
      for (int i = -edge; i <= edge; ++i)
      {
        const double value = rough_ball(i, j, k, radius);
        if (value > 0.0)
        {
          accessor.setValue(centre + openvdb::Coord(i, j, k), static_cast<Value>(value));
        }
      }
  return grid;
}

inline std::string write(const std::string& folder,
  const std::string& name,
  const openvdb::GridPtrVec& grids)
{
  const std::string path = folder + "/" + name;
  openvdb::io::File file(path);
  file.setCompression(openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK);
  file.write(grids);
  file.close();
  return path;
}

}
