// A mask image as labels on a grid's lattice. Internal to Mappers.
#ifndef mask_from_vtk_h
#define mask_from_vtk_h

#include <array>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

class vtkDataArray;
class vtkImageData;

namespace brume
{
struct Grid;

/// Brings a mask to a grid's lattice, and keeps it while image and lattice stay.
///
/// As VTK's GPU mapper has it, a mask fills the grid's box whatever its own spacing and origin are:
/// one of other dimensions is read at the nearest of its voxels.
class MaskFromVTK
{
public:
  /// `mask` null: none. Returns an empty string, or what is wrong and what to do.
  std::string Update(vtkImageData* mask, const Grid& grid);

  /// As many as the grid has voxels; null without a mask.
  const std::uint8_t* GetLabels() const { return this->Labels; }
  /// Which labels the mask holds.
  const std::array<bool, 256>& GetPresent() const { return this->Present; }
  /// Whether the last Update changed anything.
  bool IsNew() const { return this->New; }

private:
  const std::uint8_t* Labels = nullptr;
  std::vector<std::uint8_t> Copy;
  std::array<bool, 256> Present{};
  bool New = false;
  using Key = std::tuple<vtkDataArray*, unsigned long, unsigned long, int, int, int, int>;
  Key Last{ nullptr, 0, 0, 0, 0, 0, 0 };
};

}

#endif
