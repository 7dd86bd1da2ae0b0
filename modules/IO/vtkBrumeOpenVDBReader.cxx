#include "vtkBrumeOpenVDBReader.h"

#include "file_series.h"
#include "scan_header.h"
#include "vdb_file.h"

#include "vtkBrumeSparseVolume.h"

#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <cmath>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkBrumeOpenVDBReader);

using namespace brume;

struct vtkBrumeOpenVDBReader::Internals
{
  std::string Error;
  std::vector<std::string> Messages;
  std::vector<io::VdbGrid> Grids;
  std::vector<io::NumberedFile> Files; ///< of a series; else empty
  std::string Path;                    ///< the file whose grids Grids are
  std::string LengthUnit;
  std::string ValueUnit;
  bool PatientAxes = false;

  /// The file of the volume nearest to a time; the first of two that are as near.
  std::size_t Nearest(double time) const
  {
    const auto away = [&](std::size_t i)
    { return std::abs(static_cast<double>(this->Files[i].number) - time); };
    std::size_t best = 0;
    for (std::size_t i = 1; i < this->Files.size(); ++i)
    {
      best = away(i) < away(best) ? i : best;
    }
    return best;
  }

  const io::VdbGrid* Grid(int index) const
  {
    return index >= 0 && index < static_cast<int>(this->Grids.size()) ? &this->Grids[index]
                                                                      : nullptr;
  }

  /// The names of all grids with what they are, for messages.
  std::string Names() const
  {
    std::string names;
    for (const io::VdbGrid& grid : this->Grids)
    {
      names += (names.empty() ? "" : ", ") + grid.name + " (" + grid.type + ", " + grid.kind + ")";
    }
    return names;
  }

  /// The grid that is asked for, or the first that can be read. Throws as io::fail() does.
  int Choose(const std::string& path, const std::string& name) const
  {
    const int count = static_cast<int>(this->Grids.size());
    if (count == 0)
    {
      io::fail(path, "it holds no grid", "look at what wrote it");
    }
    int level_set = -1;
    for (int i = 0; i < count; ++i)
    {
      const io::VdbGrid& grid = this->Grids[i];
      if (name.empty() ? grid.refusal.empty() && !grid.level_set : grid.name == name)
      {
        return i;
      }
      level_set = level_set < 0 && grid.refusal.empty() && grid.level_set ? i : level_set;
    }
    if (name.empty() && level_set >= 0)
    {
      return level_set;
    }
    if (name.empty() && count == 1)
    {
      return 0; // whose own refusal says more
    }
    if (name.empty())
    {
      io::fail(path, "none of its grids holds floats that can be read", "it holds " + this->Names());
    }
    io::fail(path, "it has no grid '" + name + "'", "name one of " + this->Names());
  }
};

vtkBrumeOpenVDBReader::vtkBrumeOpenVDBReader()
  : Internal(std::make_unique<Internals>())
{
  this->SetNumberOfInputPorts(0);
}

vtkBrumeOpenVDBReader::~vtkBrumeOpenVDBReader()
{
  delete[] this->FileName;
  delete[] this->GridName;
}

bool vtkBrumeOpenVDBReader::CanReadFile(const char* path)
{
  try
  {
    return path &&
           io::looks_like_vdb(io::is_file_pattern(path) ? io::numbered_files(path)[0].path : path);
  }
  catch (const std::exception&)
  {
    return false; // there is no such file
  }
}

int vtkBrumeOpenVDBReader::GetNumberOfGrids() const
{
  return static_cast<int>(this->Internal->Grids.size());
}

const char* vtkBrumeOpenVDBReader::GetNameOfGrid(int index) const
{
  const io::VdbGrid* grid = this->Internal->Grid(index);
  return grid ? grid->name.c_str() : nullptr;
}

const char* vtkBrumeOpenVDBReader::GetTypeOfGrid(int index) const
{
  const io::VdbGrid* grid = this->Internal->Grid(index);
  return grid ? grid->type.c_str() : nullptr;
}

const char* vtkBrumeOpenVDBReader::GetKindOfGrid(int index) const
{
  const io::VdbGrid* grid = this->Internal->Grid(index);
  return grid ? grid->kind.c_str() : nullptr;
}

const char* vtkBrumeOpenVDBReader::GetLengthUnit() const
{
  return this->Internal->LengthUnit.c_str();
}

const char* vtkBrumeOpenVDBReader::GetValueUnit() const
{
  return this->Internal->ValueUnit.c_str();
}

bool vtkBrumeOpenVDBReader::GetPatientAxes() const
{
  return this->Internal->PatientAxes;
}

const char* vtkBrumeOpenVDBReader::GetErrorMessage() const
{
  return this->Internal->Error.c_str();
}

int vtkBrumeOpenVDBReader::GetNumberOfMessages() const
{
  return static_cast<int>(this->Internal->Messages.size());
}

const char* vtkBrumeOpenVDBReader::GetMessage(int index) const
{
  return index >= 0 && index < this->GetNumberOfMessages() ? this->Internal->Messages[index].c_str()
                                                           : nullptr;
}

vtkBrumeSparseVolume* vtkBrumeOpenVDBReader::GetOutput()
{
  return vtkBrumeSparseVolume::SafeDownCast(this->GetOutputDataObject(0));
}

int vtkBrumeOpenVDBReader::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkBrumeSparseVolume");
  return 1;
}

int vtkBrumeOpenVDBReader::RequestDataObject(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputVector)
{
  if (!vtkBrumeSparseVolume::GetData(outputVector))
  {
    vtkNew<vtkBrumeSparseVolume> output;
    outputVector->GetInformationObject(0)->Set(vtkDataObject::DATA_OBJECT(), output);
  }
  return 1;
}

template <class Work>
void vtkBrumeOpenVDBReader::Guard(const Work& work)
{
  std::string& error = this->Internal->Error;
  try
  {
    work();
    return;
  }
  catch (const std::bad_alloc&)
  {
    error = std::string(this->FileName) +
            ": there is not memory enough for it: close other programs or take a part of it";
  }
  catch (const std::exception& caught)
  {
    error = caught.what();
  }
  this->GridIndex = -1;
  this->SetErrorCode(vtkErrorCode::FileFormatError);
  vtkErrorMacro(<< error);
}

int vtkBrumeOpenVDBReader::RequestInformation(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputVector)
{
  Internals& self = *this->Internal;
  self = Internals();
  this->GridIndex = -1;
  this->SetErrorCode(vtkErrorCode::NoError);
  this->SetAbortExecute(0);
  vtkInformation* info = outputVector->GetInformationObject(0);
  info->Remove(vtkStreamingDemandDrivenPipeline::TIME_STEPS());
  info->Remove(vtkStreamingDemandDrivenPipeline::TIME_RANGE());
  this->Guard(
    [&]
    {
      if (!this->FileName || !*this->FileName)
      {
        throw std::runtime_error("vtkBrumeOpenVDBReader: no file name is set: call SetFileName");
      }
      self.Path = this->FileName;
      if (io::is_file_pattern(self.Path))
      {
        self.Files = io::numbered_files(self.Path);
        self.Path = self.Files[0].path;
      }
      self.Grids = io::list_vdb_grids(self.Path,
        static_cast<std::uint64_t>(this->MaximumMemory),
          [this](double done)
          {
            this->UpdateProgress(done);
            return !this->GetAbortExecute();
          });
      if (self.Files.size() > 1)
      {
        std::vector<double> times;
        for (const io::NumberedFile& file : self.Files)
        {
          times.push_back(static_cast<double>(file.number));
        }
        const double range[2] = { times.front(), times.back() };
        info->Set(vtkStreamingDemandDrivenPipeline::TIME_STEPS(),
          times.data(),
          static_cast<int>(times.size()));
        info->Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range, 2);
      }
    });
  return 1; // the output is empty then; a failure here would only repeat the error in other words
}

int vtkBrumeOpenVDBReader::RequestData(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputVector)
{
  Internals& self = *this->Internal;
  vtkBrumeSparseVolume* output = vtkBrumeSparseVolume::GetData(outputVector);
  output->Initialize();
  if (!self.Error.empty() && self.Grids.empty())
  {
    return 1; // RequestInformation has said it
  }
  self.Error.clear();
  self.Messages.clear();
  this->Guard(
    [&]
    {
      if (!self.Files.empty())
      {
        vtkInformation* info = outputVector->GetInformationObject(0);
        const bool asked = info->Has(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP());
        const io::NumberedFile& file = self.Files[asked
            ? self.Nearest(info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP()))
            : 0];
        if (file.path != self.Path)
        {
          self.Grids = io::list_vdb_grids(file.path,
            static_cast<std::uint64_t>(this->MaximumMemory),
              [this](double done)
              {
                this->UpdateProgress(done);
                return !this->GetAbortExecute();
              });
          self.Path = file.path;
        }
        output->GetInformation()->Set(
          vtkDataObject::DATA_TIME_STEP(), static_cast<double>(file.number));
        self.Messages.push_back("a series of " + std::to_string(self.Files.size()) +
                                " volumes, at " + std::to_string(self.Files.front().number) +
                                " to " + std::to_string(self.Files.back().number) + "; that at " +
                                std::to_string(file.number) + " is taken");
      }
      const int index = self.Choose(self.Path, this->GridName ? this->GridName : "");
      const io::VdbVolume volume = io::read_vdb_grid(self.Path,
        self.Grids[index],
        this->LevelSets == LevelSetsAsFog,
        static_cast<std::uint64_t>(this->MaximumMemory),
        [this](double done)
        {
          this->UpdateProgress(done);
          return !this->GetAbortExecute();
        });
      vtkNew<vtkMatrix4x4> matrix;
      matrix->DeepCopy(volume.world_from_index.data());
      output->SetVoxels(volume.voxels);
      output->SetIndexToWorld(matrix);
      output->SetName(volume.name);
      output->SetActiveVoxelCount(static_cast<vtkIdType>(volume.active_voxels));
      output->SetGridClass(volume.level_set ? vtkBrumeSparseVolume::GridClassLevelSet
          : volume.fog_volume               ? vtkBrumeSparseVolume::GridClassFogVolume
                                            : vtkBrumeSparseVolume::GridClassUnknown);
      self.LengthUnit = volume.length_unit;
      self.ValueUnit = volume.value_unit;
      self.PatientAxes = volume.patient;
      self.Messages.insert(self.Messages.end(), volume.messages.begin(), volume.messages.end());
      if (!this->GridName || !*this->GridName)
      {
        const std::size_t others = self.Grids.size() - 1;
        if (others > 0)
        {
          self.Messages.push_back(
            "of its grids, " + self.Names() + ", " + volume.name + " is taken");
        }
      }
      this->GridIndex = index;
      this->UpdateProgress(1);
    });
  if (this->GridIndex < 0)
  {
    output->Initialize();
  }
  return 1;
}

void vtkBrumeOpenVDBReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << '\n';
  os << indent << "GridName: " << (this->GridName ? this->GridName : "(none)") << '\n';
  os << indent << "LevelSets: " << (this->LevelSets == LevelSetsAsFog ? "fog" : "distances") << '\n';
  os << indent << "MaximumMemory: " << this->MaximumMemory << '\n';
  os << indent << "GridIndex: " << this->GridIndex << '\n';
  for (int i = 0; i < this->GetNumberOfGrids(); ++i)
  {
    os << indent << "Grid: " << this->GetNameOfGrid(i) << " (" << this->GetTypeOfGrid(i) << ", "
       << this->GetKindOfGrid(i) << ")\n";
  }
  os << indent << "ErrorMessage: " << this->GetErrorMessage() << '\n';
  for (int i = 0; i < this->GetNumberOfMessages(); ++i)
  {
    os << indent << "Message: " << this->GetMessage(i) << '\n';
  }
}
