/**
 * @class   vtkBrumeSparseVolume
 * @brief   a scalar volume that has voxels only where there is something
 *
 * What vtkBrumeOpenVDBReader reads and vtkBrumeVolumeMapper draws: voxels in bricks
 * (brume::SparseVoxels), a matrix that places them in the world, a name, and a few figures. It is
 * never made dense.
 *
 * It is a vtkDataObject, not a vtkDataSet: it has no points and cells to be asked for one by one,
 * and filters of VTK that expect them refuse it with VTK's own words rather than run for days.
 *
 * Copies, shallow or deep, share the voxels: they cannot be changed once they are made.
 */
#ifndef vtkBrumeSparseVolume_h
#define vtkBrumeSparseVolume_h

#include "vtkBrumeDataModelModule.h"
#include "vtkDataObject.h"
#include "vtkNew.h" // for vtkNew

#include <memory> // for std::shared_ptr
#include <string> // for std::string

class vtkInformation;
class vtkInformationVector;
class vtkMatrix4x4;

namespace brume
{
class SparseVoxels;
}

class VTKBRUMEDATAMODEL_EXPORT vtkBrumeSparseVolume : public vtkDataObject
{
public:
  static vtkBrumeSparseVolume* New();
  vtkTypeMacro(vtkBrumeSparseVolume, vtkDataObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

#ifndef __VTK_WRAP__
  ///@{
  /**
   * The voxels. Default: none. Setting them also sets ValueRange to that of all finite ones.
   */
  void SetVoxels(std::shared_ptr<const brume::SparseVoxels> voxels);
  const std::shared_ptr<const brume::SparseVoxels>& GetVoxels() const
  {
    return this->Voxels;
  }
  ///@}
#endif

  ///@{
  /**
   * The world place of a voxel of the *source*, whose coordinates may be negative: affine, the last
   * row 0 0 0 1. Voxel (i, j, k) of GetVoxels() is the source's (i, j, k) + origin(). Default: the
   * identity. A matrix that is not affine or flattens the volume is refused with a vtkErrorMacro.
   */
  void SetIndexToWorld(vtkMatrix4x4* matrix);
  vtkMatrix4x4* GetIndexToWorld();
  ///@}

  ///@{
  /**
   * What the values are called: "density". Default: empty.
   */
  void SetName(const std::string& name);
  const std::string& GetName() const
  {
    return this->Name;
  }
  ///@}

  ///@{
  /**
   * How many voxels the source counted as active; 0 where it does not say. Default 0.
   */
  void SetActiveVoxelCount(vtkIdType count);
  vtkGetMacro(ActiveVoxelCount, vtkIdType);
  ///@}

  /** What the values are, in OpenVDB's words. */
  enum GridClasses
  {
    GridClassUnknown = 0,
    GridClassFogVolume = 1, ///< a density
    GridClassLevelSet = 2   ///< the distance to a surface, negative within
  };
  ///@{
  /**
   * What the values are. Default: unknown. Mappers draw all alike; writers keep it.
   */
  vtkSetClampMacro(GridClass, int, GridClassUnknown, GridClassLevelSet);
  vtkGetMacro(GridClass, int);
  ///@}

  /**
   * The least and the largest finite value, the background among them; 0 and -1 where there is
   * none.
   */
  vtkGetVector2Macro(ValueRange, double);

  /**
   * The box in the world around all voxels that are stored and one of background around them; VTK's
   * uninitialized bounds (1, -1, …) without voxels.
   */
  void GetBounds(double bounds[6]);

  /**
   * The lengths in the world of a voxel's edges.
   */
  void GetSpacing(double spacing[3]);

  /**
   * Memory of the voxels and their table, in KiB.
   */
  unsigned long GetActualMemorySize() override;

  void Initialize() override;
  void ShallowCopy(vtkDataObject* source) override;
  void DeepCopy(vtkDataObject* source) override;

  ///@{
  /**
   * The volume in a pipeline's information; null where it holds something else.
   */
  static vtkBrumeSparseVolume* GetData(vtkInformation* information);
  static vtkBrumeSparseVolume* GetData(vtkInformationVector* vector, int port = 0);
  ///@}

protected:
  vtkBrumeSparseVolume();
  ~vtkBrumeSparseVolume() override;

private:
  vtkBrumeSparseVolume(const vtkBrumeSparseVolume&) = delete;
  void operator=(const vtkBrumeSparseVolume&) = delete;

  void Share(vtkBrumeSparseVolume* source);

  std::shared_ptr<const brume::SparseVoxels> Voxels;
  vtkNew<vtkMatrix4x4> IndexToWorld;
  std::string Name;
  vtkIdType ActiveVoxelCount = 0;
  int GridClass = GridClassUnknown;
  double ValueRange[2] = { 0.0, -1.0 };
};

#endif
