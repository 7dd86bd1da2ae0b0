// Temperatures of an image as a grid on its voxels' lattice. Internal to Mappers.
#ifndef temperature_from_vtk_h
#define temperature_from_vtk_h

#include "Transport/grid.h"

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

class vtkDataArray;
class vtkDataObject;

namespace brume
{

/// Reads an array of an image as floats, in place where it holds such, and keeps copies while the
/// array and the lattice stay.
class TemperatureFromVTK
{
public:
  /// The array of this name beside the values of `values`: of the points, or of the cells where the
  /// values are theirs. Returns an empty string, or what is wrong and what to do.
  std::string Update(vtkDataObject* input, const std::string& array, const Grid& values);
  /// None from now on.
  void Clear();

  /// Its voxels are null where there are none.
  const Grid& GetGrid() const { return this->TheGrid; }
  /// A number that is new whenever the temperatures change; 0 for none.
  std::uint64_t GetRevision() const { return this->Revision; }

private:
  Grid TheGrid;
  std::vector<float> Copy;
  std::uint64_t Revision = 0;
  using Key = std::tuple<vtkDataArray*, unsigned long, unsigned long, int, int, int, int>;
  Key Last{ nullptr, 0, 0, 0, 0, 0, 0 };
};

}

#endif
