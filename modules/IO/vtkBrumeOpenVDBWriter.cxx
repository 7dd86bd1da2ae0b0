#include "vtkBrumeOpenVDBWriter.h"

#include "image_view.h"
#include "vdb_writer.h"

#include "vtkBrumeSparseVolume.h"

#include "Transport/sparse_voxels.h"

#include "vtkDataArray.h"
#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMatrix4x4.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <new>
#include <set>
#include <stdexcept>
#include <vector>

vtkStandardNewMacro(vtkBrumeOpenVDBWriter);

using namespace brume;

struct vtkBrumeOpenVDBWriter::Internals
{
  std::string Error;
  std::vector<std::string> Messages;
  std::set<std::string> Names;               // of the grids so far
  std::map<std::string, double> Backgrounds; // a setting, kept from one Write() to the next

  void Clear()
  {
    this->Error.clear();
    this->Messages.clear();
    this->Names.clear();
  }

  void Tell(const std::string& message) { this->Messages.push_back(message); }

  /// A name of the grid's own.
  std::string Name(const std::string& wanted)
  {
    const std::string base = wanted.empty() ? "density" : wanted;
    std::string name = base;
    for (int n = 2; !this->Names.insert(name).second; ++n)
    {
      name = base + "_" + std::to_string(n);
    }
    return name;
  }

  void Add(io::VdbWriter& file,
    vtkBrumeSparseVolume* volume,
    const vtkBrumeOpenVDBWriter& self,
    io::VdbDescription d,
    const io::Progress& progress);
  void Add(io::VdbWriter& file,
    vtkImageData* image,
    vtkDataArray* array,
    const vtkBrumeOpenVDBWriter& self,
    io::VdbDescription d,
    const io::Progress& progress);
};

namespace
{

io::VdbClass class_of(int grid_class)
{
  switch (grid_class)
  {
    case vtkBrumeOpenVDBWriter::GridClassFogVolume:
      return io::VdbClass::FogVolume;
    case vtkBrumeOpenVDBWriter::GridClassLevelSet:
      return io::VdbClass::LevelSet;
    default:
      return io::VdbClass::Unknown;
  }
}

bool fits_single(io::Scalar scalar)
{
  switch (scalar)
  {
    case io::Scalar::Int32:
    case io::Scalar::UInt32:
    case io::Scalar::Int64:
    case io::Scalar::UInt64:
    case io::Scalar::Float64:
      return false;
    default:
      return true;
  }
}

void fail_scalars(const std::string& path)
{
  io::fail(path, "the volume has no array of one component on its points", "split its components");
}

}

void vtkBrumeOpenVDBWriter::Internals::Add(io::VdbWriter& file,
  vtkBrumeSparseVolume* volume,
  const vtkBrumeOpenVDBWriter& self,
  io::VdbDescription d,
  const io::Progress& progress)
{
  if (!volume->GetVoxels())
  {
    io::fail(self.FileName, "there are no voxels to write", "see what made the volume");
  }
  const SparseVoxels& voxels = *volume->GetVoxels();
  d.name = this->Name(volume->GetName());
  d.half = self.Half || voxels.type() == VoxelType::Float16;
  d.kind = class_of(self.GridClass);
  if (self.GridClass == GridClassAutomatic)
  {
    d.kind =
      volume->GetGridClass() == vtkBrumeSparseVolume::GridClassLevelSet    ? io::VdbClass::LevelSet
      : volume->GetGridClass() == vtkBrumeSparseVolume::GridClassFogVolume ? io::VdbClass::FogVolume
                                                                           : io::VdbClass::Unknown;
  }
  if (d.kind == io::VdbClass::LevelSet && !(voxels.background() > 0.0))
  {
    io::fail(self.FileName,
      "its background is no width of a band",
      self.GridClass == GridClassLevelSet ? "leave --grid-class out" : "give it another grid class");
  }
  const double* m = volume->GetIndexToWorld()->GetData();
  std::copy(m, m + 16, d.world_from_index.begin());
  file.add(voxels, d, progress);
}

void vtkBrumeOpenVDBWriter::Internals::Add(io::VdbWriter& file,
  vtkImageData* image,
  vtkDataArray* array,
  const vtkBrumeOpenVDBWriter& self,
  io::VdbDescription d,
  const io::Progress& progress)
{
  io::DenseVoxels dense;
  dense.scalar = io::scalar_of_vtk(array->GetDataType());
  dense.voxels = array->GetVoidPointer(0);
  int extent[6];
  image->GetExtent(extent);
  image->GetDimensions(dense.dimensions.data());
  for (int a = 0; a < 3; ++a)
  {
    dense.first[a] = extent[2 * a];
  }
  d.name = this->Name(array->GetName() ? array->GetName() : "");
  d.half = self.Half;
  d.kind = class_of(self.GridClass);
  if (self.GridClass == GridClassAutomatic)
  {
    double range[2];
    array->GetFiniteRange(range, 0);
    d.kind = range[0] >= 0.0 ? io::VdbClass::FogVolume : io::VdbClass::Unknown;
  }
  const double* m = image->GetIndexToPhysicalMatrix()->GetData();
  std::copy(m, m + 16, d.world_from_index.begin());
  const auto own = this->Backgrounds.find(array->GetName() ? array->GetName() : "");
  double background = own == this->Backgrounds.end() ? self.Background : own->second;
  if (d.kind == io::VdbClass::LevelSet)
  {
    const double* spacing = image->GetSpacing();
    background = self.BandWidth > 0.0 ? self.BandWidth
                                      : 3.0 * std::max({ spacing[0], spacing[1], spacing[2] });
  }
  if (!fits_single(dense.scalar))
  {
    this->Tell("its " + std::string(array->GetDataTypeAsString()) +
               " values are rounded to single precision");
  }
  const std::uint64_t active = file.add(dense, background, self.Tolerance, d, progress);
  if (active == 0)
  {
    this->Tell("all of " + d.name + " is background: the grid is empty");
  }
}

vtkBrumeOpenVDBWriter::vtkBrumeOpenVDBWriter()
  : Internal(std::make_unique<Internals>())
{
}

vtkBrumeOpenVDBWriter::~vtkBrumeOpenVDBWriter()
{
  delete[] this->FileName;
}

void vtkBrumeOpenVDBWriter::SetArrayBackground(const char* name, double background)
{
  double& kept = this->Internal->Backgrounds[name ? name : ""];
  if (!(kept == background))
  {
    kept = background;
    this->Modified();
  }
}

void vtkBrumeOpenVDBWriter::ClearArrayBackgrounds()
{
  this->Internal->Backgrounds.clear();
  this->Modified();
}

const char* vtkBrumeOpenVDBWriter::GetErrorMessage() const
{
  return this->Internal->Error.c_str();
}

int vtkBrumeOpenVDBWriter::GetNumberOfMessages() const
{
  return static_cast<int>(this->Internal->Messages.size());
}

const char* vtkBrumeOpenVDBWriter::GetMessage(int index) const
{
  return index >= 0 && index < this->GetNumberOfMessages() ? this->Internal->Messages[index].c_str()
                                                           : nullptr;
}

int vtkBrumeOpenVDBWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkBrumeSparseVolume");
  info->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
  return 1;
}

void vtkBrumeOpenVDBWriter::WriteData()
{
  Internals& self = *this->Internal;
  self.Clear();
  this->SetErrorCode(vtkErrorCode::NoError);
  try
  {
    if (!this->FileName || !*this->FileName)
    {
      throw std::runtime_error("vtkBrumeOpenVDBWriter: no file name is set: call SetFileName");
    }
    if (!std::isfinite(this->Background) || !std::isfinite(this->Tolerance))
    {
      io::fail(this->FileName, "the background or the tolerance is no number", "set finite ones");
    }
    io::VdbWriter file;
    io::VdbDescription description;
    description.length_unit = this->LengthUnit;
    description.value_unit = this->ValueUnit;
    description.patient = this->PatientAxes;
    const int inputs = this->GetNumberOfInputConnections(0);
    for (int i = 0; i < inputs; ++i)
    {
      const auto progress = [this, i, inputs](double done)
      {
        this->UpdateProgress(0.5 * (i + done) / inputs);
        return !this->GetAbortExecute();
      };
      vtkDataObject* input = this->GetInputDataObject(0, i);
      if (auto* volume = vtkBrumeSparseVolume::SafeDownCast(input))
      {
        self.Add(file, volume, *this, description, progress);
        continue;
      }
      auto* image = vtkImageData::SafeDownCast(input);
      io::view_of(image, this->FileName); // throws for an image that is none
      vtkPointData* points = image->GetPointData();
      int grids = 0;
      for (int a = 0; a < points->GetNumberOfArrays(); ++a)
      {
        vtkDataArray* array = points->GetArray(a); // null for words
        if (!array || array->GetNumberOfTuples() != image->GetNumberOfPoints())
        {
          continue;
        }
        if (array->GetDataType() == VTK_BIT)
        {
          self.Tell(std::string("its array ") +
                    (array->GetName() ? array->GetName() : "(no name)") +
                    " of single bits is left out");
          continue;
        }
        if (array->GetNumberOfComponents() > 1)
        {
          self.Tell(std::string("its array ") +
                    (array->GetName() ? array->GetName() : "(no name)") + " of " +
                    std::to_string(array->GetNumberOfComponents()) + " components is left out");
          continue;
        }
        self.Add(file, image, array, *this, description, progress);
        ++grids;
      }
      if (grids == 0)
      {
        fail_scalars(this->FileName);
      }
    }
    if (inputs == 0)
    {
      throw std::runtime_error("vtkBrumeOpenVDBWriter: there is no input: call AddInputConnection");
    }
    if (this->Half)
    {
      self.Tell("values are rounded to half precision, 11 bits, and end at 65504");
    }
    if (!this->LengthUnit.empty() || !this->ValueUnit.empty() || this->PatientAxes)
    {
      self.Tell(
        "OpenVDB has no fields for units and a patient's axes: they are in metadata that Brume "
        "alone reads");
    }
    file.write(this->FileName,
      [this](double done)
      {
        this->UpdateProgress(0.5 + 0.5 * done);
        return !this->GetAbortExecute();
      });
    this->UpdateProgress(1);
    return;
  }
  catch (const std::bad_alloc&)
  {
    self.Error = std::string(this->FileName) +
                 ": there is not memory enough to write it: close other programs";
  }
  catch (const std::invalid_argument& error)
  {
    self.Error =
      std::string(this->FileName) + ": " + error.what() + ": give the volume another place";
  }
  catch (const std::exception& error)
  {
    self.Error = error.what();
  }
  this->SetErrorCode(vtkErrorCode::UserError);
  vtkErrorMacro(<< self.Error);
}

void vtkBrumeOpenVDBWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << '\n';
  os << indent << "Half: " << this->Half << '\n';
  os << indent << "Background: " << this->Background << '\n';
  for (const auto& background : this->Internal->Backgrounds)
  {
    os << indent << "Background of " << background.first << ": " << background.second << '\n';
  }
  os << indent << "Tolerance: " << this->Tolerance << '\n';
  os << indent << "GridClass: " << this->GridClass << '\n';
  os << indent << "BandWidth: " << this->BandWidth << '\n';
  os << indent << "LengthUnit: " << this->LengthUnit << '\n';
  os << indent << "ValueUnit: " << this->ValueUnit << '\n';
  os << indent << "PatientAxes: " << this->PatientAxes << '\n';
  os << indent << "ErrorMessage: " << this->GetErrorMessage() << '\n';
  for (int i = 0; i < this->GetNumberOfMessages(); ++i)
  {
    os << indent << "Message: " << this->GetMessage(i) << '\n';
  }
}
