// A mapper's input as grids: its voxels, where they are, what they range over. Internal to Mappers.
#ifndef grid_from_vtk_h
#define grid_from_vtk_h

#include "Transport/bricks.h"
#include "Transport/grid.h"

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

class vtkBrumeSparseVolume;
class vtkDataArray;
class vtkImageData;
class vtkObject;
class vtkVolumeMapper;
class vtkVolumeProperty;

namespace brume
{

/// A number that no scene of this process has had as a revision.
std::uint64_t next_revision();

/// The names of the arrays of an image's points, or of its cells, for messages.
std::string array_names(vtkImageData* image, bool cells);

class SparseVoxels;

/// Reads the image of a mapper, in place where the kernels know its voxels, or its sparse volume.
/// Keeps copies and ranges while the image and its array say that they were not modified.
class GridFromVTK
{
public:
  /// `array`: of the image's point data, to be read in place of the mapper's scalars; empty: those.
  /// Returns an empty string, or what is wrong and what to do.
  std::string Update(vtkVolumeMapper* mapper,
    vtkVolumeProperty* property,
    const std::string& array,
    int threads);

  /// How the components are meant.
  enum class Meaning
  {
    Independent,   ///< each a volume of its own
    ColourOpacity, ///< two dependent ones: the first is coloured, the second is the value
    RGBOpacity,    ///< four dependent ones: a colour and the value
  };
  Meaning GetMeaning() const { return this->TheMeaning; }

  /// How many volumes the image is: its components where they are independent, else 1.
  int GetNumberOfVolumes() const
  {
    return this->TheMeaning == Meaning::Independent ? this->TheGrid.components : 1;
  }
  Grid GetGrid(int volume) const;
  std::shared_ptr<const BrickRanges> GetRanges(int volume) const
  {
    return this->Ranges[this->GetGrid(volume).component];
  }
  /// The finite values of a component; 0 to 0 where there are none.
  const double* GetRange(int component) const { return this->Range[component]; }
  /// A number that is new whenever voxels, or which of them are read, change.
  std::uint64_t GetRevision() const { return this->Revision; }

  glm::dmat4 DataFromIndex{ 1.0 };
  double Spacing[3] = { 1.0, 1.0, 1.0 };
  double Origin[3] = { 0.0, 0.0, 0.0 };
  /// Structured coordinates of the first voxel's place: the extent's lower end, half a voxel more
  /// for cells.
  double First[3] = { 0.0, 0.0, 0.0 };
  /// Direction of the image's axes in the data's coordinates, row by row. Those of a sparse volume
  /// need not be perpendicular.
  double Direction[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };

private:
  std::string UpdateImage(vtkImageData* image,
    vtkDataArray* scalars,
    bool cells,
    vtkVolumeProperty* property,
    int threads);
  std::string UpdateSparse(vtkBrumeSparseVolume* volume, int threads);
  std::string UpdatePlace(vtkImageData* image, const int extent[6], bool cells);
  void ReadVoxels(vtkDataArray* scalars, const int dims[3], bool cells);
  void MeasureRanges(int threads);

  Grid TheGrid;
  Meaning TheMeaning = Meaning::Independent;
  /// Voxels that could not be read in place: converted or padded.
  std::vector<unsigned char> Converted;
  std::shared_ptr<const SparseVoxels> Sparse;
  std::shared_ptr<const BrickRanges> Ranges[4];
  double Range[4][2] = {};
  std::uint64_t Revision = 0;

  using DataKey = std::tuple<vtkObject*, unsigned long, unsigned long, int, int, int, int, int>;
  DataKey LastData{ nullptr, 0, 0, 0, 0, 0, 0, 0 };
};

}

#endif
