#include "vtkBrumeImageReader.h"

#include "dicom_series.h"
#include "file_series.h"
#include "memory_limit.h"
#include "orientation.h"
#include "picture_stack.h"
#include "raw_header.h"
#include "scan_format.h"
#include "scan_header.h"
#include "scan_values.h"
#include "voxel_reader.h"
#include "vtk_volume_reader.h"

#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkErrorCode.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMatrix3x3.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkBrumeImageReader);

namespace
{
using namespace brume;

/// "0 to 6 s"
std::string spoken_times(const std::vector<double>& times, const std::string& unit)
{
  char text[80];
  std::snprintf(text, sizeof(text), "%g to %g", times.front(), times.back());
  return text + (unit.empty() ? "" : " " + unit);
}
}

struct vtkBrumeImageReader::Internals
{
  std::string Error;
  bool Opened = false; // else the error is one of opening, and no time step can be read
  std::vector<std::string> Messages;
  std::string Format;
  std::string LengthUnit;
  std::string ValueUnit;
  bool PatientAxes = false;

  // A scan, known by its header; or an image that a VTK reader has read whole.
  io::ScanHeader Header;
  GridFrame Frame;
  vtkSmartPointer<vtkImageData> Image;

  // Of a series: when each volume is, and, where each has a file of its own, those.
  std::vector<double> Times;
  std::string TimeUnit;
  std::vector<io::NumberedFile> Files;
  static constexpr std::size_t NoVolume = static_cast<std::size_t>(-1);
  std::size_t Taken = 0; // the volume that Header, Frame and Image are of

  std::string Series; // the one that is wanted
  std::vector<io::DicomChoice> Choices;
  std::uint64_t MaximumMemory = 0;

  void Clear() { *this = Internals(); }

  /// Everything but the voxels of a scan. Throws what the parsers throw.
  void Open(const std::string& path, const io::Progress& progress)
  {
    if (io::is_file_pattern(path))
    {
      this->Files = io::numbered_files(path);
      const std::string first = this->Files[0].path;
      if (io::find_format(first) == io::Format::Pictures &&
        (this->Files.size() == 1 || io::count_pages(first) == 1))
      {
        this->Slices.swap(this->Files); // a stack of pictures, not volumes over time
        this->OpenFile(path, progress);
        this->Times = this->Header.times;
        this->TimeUnit = this->Header.time_unit;
        return;
      }
      this->OpenFile(this->Files[0].path, progress);
      if (this->Files.size() > 1 && this->Header.times.size() > 1)
      {
        io::fail(path, "each of its files is a series itself", "name one of them");
      }
      for (const io::NumberedFile& file : this->Files)
      {
        this->Times.push_back(static_cast<double>(file.number));
      }
      return;
    }
    this->OpenFile(path, progress);
    this->Times = this->Header.times;
    this->TimeUnit = this->Header.time_unit;
  }

  std::vector<io::NumberedFile> Slices; // of a pattern that names pictures; else empty

  /// The pictures that a path stands for; none for one file.
  std::vector<io::NumberedFile> Stack(const std::string& path) const
  {
    std::error_code error;
    return !this->Slices.empty()                    ? this->Slices
      : std::filesystem::is_directory(path, error) ? io::pictures_in(path)
                                                    : std::vector<io::NumberedFile>();
  }

  /// One file, of a series the first volume.
  void OpenFile(const std::string& path, const io::Progress& progress)
  {
    this->Header = io::ScanHeader();
    this->Image = nullptr;
    const io::Format format =
      this->Slices.empty() ? io::find_format(path) : io::Format::Pictures;
    if (format == io::Format::LegacyVtk)
    {
      this->Header = io::read_legacy_header(path);
    }
    if (format == io::Format::Vti || (format == io::Format::LegacyVtk && this->Header.parts.empty()))
    {
      this->Header = io::ScanHeader();
      io::VtkVolume volume = format == io::Format::Vti
        ? io::read_vti(path, this->MaximumMemory, progress)
        : io::read_legacy(path, this->MaximumMemory, progress);
      this->Image = volume.image;
      this->Format = volume.format;
      this->Messages = volume.messages;
      this->LengthUnit = volume.length_unit;
      this->ValueUnit = volume.value_unit;
      this->PatientAxes = volume.patient_axes;
      return;
    }
    if (format != io::Format::LegacyVtk)
    {
      this->Header = format == io::Format::Dicom
        ? io::read_dicom_header(path, this->Series, this->Choices)
        : format == io::Format::Pictures         ? io::read_picture_header(path, this->Stack(path))
        : format == io::Format::Raw              ? io::read_raw_header(path)
        : format == io::Format::Nifti            ? io::read_nifti_header(path)
        : format == io::Format::MetaImage        ? io::read_meta_header(path)
                                                 : io::read_nrrd_header(path);
    }
    io::check_header(io::select_volume(this->Header, 0));
    io::check_series(this->Header);
    io::check_memory(path, io::memory_need(this->Header), this->MaximumMemory);
    const std::array<long long, 3> dimensions{ { this->Header.dimensions[0],
      this->Header.dimensions[1], this->Header.dimensions[2] } };
    try
    {
      this->Frame = frame_of_affine(this->Header.affine, dimensions);
    }
    catch (const std::invalid_argument& error)
    {
      io::fail(path, error.what(), "repair the header's orientation");
    }
    this->Format = this->Header.format;
    this->Messages = this->Header.messages;
    this->LengthUnit = this->Header.length_unit;
    this->ValueUnit = this->Header.value_unit;
    this->PatientAxes = this->Header.patient;
    if (this->Frame.shear_degrees > 0)
    {
      this->Messages.push_back("the axes are not perpendicular (by " +
        std::to_string(this->Frame.shear_degrees).substr(0, 5) +
        " degrees); the closest perpendicular axes are taken");
    }
    if (this->Frame.reversed_axis >= 0)
    {
      this->Messages.push_back("the file is left-handed; its index axis " +
        std::to_string(this->Frame.reversed_axis + 1) + " is stored in reverse");
    }
  }

  /// The volume whose time is nearest; the first of two that are as near.
  std::size_t Nearest(double time) const
  {
    std::size_t best = 0;
    for (std::size_t i = 1; i < this->Times.size(); ++i)
    {
      if (std::abs(this->Times[i] - time) < std::abs(this->Times[best] - time))
      {
        best = i;
      }
    }
    return best;
  }

  /// What RequestInformation has told of the volumes' lattice.
  struct Lattice
  {
    std::array<int, 3> Dimensions;
    int Type;
    int Components;
    bool operator==(const Lattice& o) const
    {
      return Dimensions == o.Dimensions && Type == o.Type && Components == o.Components;
    }
  };
  Lattice GetLattice() const
  {
    Lattice lattice{ { { 0, 0, 0 } }, VTK_VOID, 0 };
    if (this->Image)
    {
      this->Image->GetDimensions(lattice.Dimensions.data());
      vtkDataArray* scalars = this->Image->GetPointData()->GetScalars();
      lattice.Type = scalars->GetDataType();
      lattice.Components = scalars->GetNumberOfComponents();
      return lattice;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      lattice.Dimensions[axis] = static_cast<int>(this->Header.dimensions[axis]);
    }
    lattice.Type = io::value_type(this->Header);
    lattice.Components = static_cast<int>(this->Header.components);
    return lattice;
  }

  /// Goes to a volume of a series whose volumes have files of their own.
  void TakeFile(std::size_t index, const io::Progress& progress)
  {
    const bool released = !this->Image && this->Header.path.empty();
    if (this->Files.empty() || (index == this->Taken && !released))
    {
      return;
    }
    const Lattice first = this->First;
    this->Taken = NoVolume; // until it is known to be one of the series
    this->OpenFile(this->Files[index].path, progress);
    if (!(this->GetLattice() == first))
    {
      io::fail(this->Files[index].path,
        "is not of the size and type of the series' first, " + this->Files[0].path,
        "name the files of one series");
    }
    this->Taken = index;
  }
  Lattice First{ { { 0, 0, 0 } }, VTK_VOID, 0 };

  void ReadScan(std::size_t index, vtkImageData* image, const io::Progress& progress) const
  {
    const io::ScanHeader header =
      this->Files.empty() ? io::select_volume(this->Header, index) : this->Header;
    io::check_header(header);
    vtkSmartPointer<vtkDataArray> stored;
    stored.TakeReference(vtkDataArray::CreateDataArray(io::vtk_type(header.scalar)));
    stored->SetNumberOfComponents(static_cast<int>(header.components));
    stored->SetNumberOfTuples(static_cast<vtkIdType>(header.voxels()));
    io::read_voxels(header, stored->GetVoidPointer(0), progress);
    vtkSmartPointer<vtkDataArray> values =
      io::rescales(header) ? io::rescaled(stored, header) : stored;
    if (this->Frame.reversed_axis >= 0)
    {
      io::reverse_axis(values->GetVoidPointer(0), header.dimensions,
        header.components * values->GetDataTypeSize(), this->Frame.reversed_axis);
    }
    values->SetName(header.array.c_str());
    image->SetExtent(0, static_cast<int>(header.dimensions[0] - 1), 0,
      static_cast<int>(header.dimensions[1] - 1), 0, static_cast<int>(header.dimensions[2] - 1));
    image->SetSpacing(this->Frame.spacing.data());
    image->SetOrigin(this->Frame.origin.data());
    image->SetDirectionMatrix(this->Frame.direction.data());
    image->GetPointData()->SetScalars(values);
  }
};

vtkBrumeImageReader::vtkBrumeImageReader()
  : Internal(new Internals)
{
  this->SetNumberOfInputPorts(0);
}

vtkBrumeImageReader::~vtkBrumeImageReader()
{
  delete[] this->FileName;
  delete[] this->Series;
}

const char* vtkBrumeImageReader::GetErrorMessage() const
{
  return this->Internal->Error.c_str();
}

int vtkBrumeImageReader::GetNumberOfMessages() const
{
  return static_cast<int>(this->Internal->Messages.size());
}

const char* vtkBrumeImageReader::GetMessage(int index) const
{
  return index >= 0 && index < this->GetNumberOfMessages()
    ? this->Internal->Messages[index].c_str()
    : nullptr;
}

const char* vtkBrumeImageReader::GetFormat() const
{
  return this->Internal->Format.c_str();
}

const char* vtkBrumeImageReader::GetLengthUnit() const
{
  return this->Internal->LengthUnit.c_str();
}

const char* vtkBrumeImageReader::GetValueUnit() const
{
  return this->Internal->ValueUnit.c_str();
}

int vtkBrumeImageReader::GetNumberOfSeries() const
{
  return static_cast<int>(this->Internal->Choices.size());
}

const char* vtkBrumeImageReader::GetNameOfSeries(int index) const
{
  return index >= 0 && index < this->GetNumberOfSeries() ? this->Internal->Choices[index].text.c_str()
                                                         : nullptr;
}

const char* vtkBrumeImageReader::GetUIDOfSeries(int index) const
{
  return index >= 0 && index < this->GetNumberOfSeries() ? this->Internal->Choices[index].uid.c_str()
                                                         : nullptr;
}

const char* vtkBrumeImageReader::GetTimeUnit() const
{
  return this->Internal->TimeUnit.c_str();
}

bool vtkBrumeImageReader::GetPatientAxes() const
{
  return this->Internal->PatientAxes;
}

bool vtkBrumeImageReader::CanReadFile(const char* path)
{
  try
  {
    const std::string name = path ? path : "";
    io::find_format(io::is_file_pattern(name) ? io::numbered_files(name)[0].path : name);
    return true;
  }
  catch (const std::exception&)
  {
    return false;
  }
}

int vtkBrumeImageReader::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  Internals& self = *this->Internal;
  self.Clear();
  self.MaximumMemory = static_cast<std::uint64_t>(this->MaximumMemory);
  self.Series = this->Series ? this->Series : "";
  this->SetErrorCode(vtkErrorCode::NoError);
  this->SetAbortExecute(0);
  vtkInformation* info = outputVector->GetInformationObject(0);
  int extent[6] = { 0, -1, 0, -1, 0, -1 };
  try
  {
    if (!this->FileName || !*this->FileName)
    {
      throw std::runtime_error("vtkBrumeImageReader: no file name is set: call SetFileName");
    }
    self.Open(this->FileName,
      [this](double done)
      {
        this->UpdateProgress(done);
        return !this->GetAbortExecute();
      });
    self.First = self.GetLattice();
    vtkImageData* image = self.Image;
    if (image)
    {
      image->GetExtent(extent);
      info->Set(vtkDataObject::SPACING(), image->GetSpacing(), 3);
      info->Set(vtkDataObject::ORIGIN(), image->GetOrigin(), 3);
      info->Set(vtkDataObject::DIRECTION(), image->GetDirectionMatrix()->GetData(), 9);
      vtkDataArray* scalars = image->GetPointData()->GetScalars();
      vtkDataObject::SetPointDataActiveScalarInfo(
        info, scalars->GetDataType(), scalars->GetNumberOfComponents());
    }
    else
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        extent[2 * axis + 1] = static_cast<int>(self.Header.dimensions[axis] - 1);
      }
      info->Set(vtkDataObject::SPACING(), self.Frame.spacing.data(), 3);
      info->Set(vtkDataObject::ORIGIN(), self.Frame.origin.data(), 3);
      info->Set(vtkDataObject::DIRECTION(), self.Frame.direction.data(), 9);
      vtkDataObject::SetPointDataActiveScalarInfo(
        info, io::value_type(self.Header), static_cast<int>(self.Header.components));
    }
    info->Remove(vtkStreamingDemandDrivenPipeline::TIME_STEPS());
    info->Remove(vtkStreamingDemandDrivenPipeline::TIME_RANGE());
    if (self.Times.size() > 1)
    {
      const auto ends = std::minmax_element(self.Times.begin(), self.Times.end());
      const double range[2] = { *ends.first, *ends.second };
      info->Set(vtkStreamingDemandDrivenPipeline::TIME_STEPS(), self.Times.data(),
        static_cast<int>(self.Times.size()));
      info->Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range, 2);
    }
  }
  catch (const std::bad_alloc&)
  {
    self.Error = std::string(this->FileName) +
      ": there is not memory enough for it: close other programs or take a part of it";
  }
  catch (const std::exception& error)
  {
    self.Error = error.what();
  }
  info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  if (!self.Error.empty())
  {
    this->SetErrorCode(vtkErrorCode::FileFormatError);
    vtkErrorMacro(<< self.Error);
  }
  self.Opened = self.Error.empty();
  return 1; // the output is empty then; a failure here would only repeat the error in other words
}

int vtkBrumeImageReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  Internals& self = *this->Internal;
  vtkImageData* output = vtkImageData::GetData(outputVector);
  output->Initialize();
  if (!self.Opened)
  {
    return 1; // RequestInformation has said it
  }
  self.Error.clear(); // of another time step
  this->SetErrorCode(vtkErrorCode::NoError);
  try
  {
    const io::Progress progress = [this](double done)
    {
      this->UpdateProgress(done);
      return !this->GetAbortExecute();
    };
    vtkInformation* info = outputVector->GetInformationObject(0);
    const bool asked = info->Has(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP());
    const std::size_t index =
      asked ? self.Nearest(info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP())) : 0;
    self.TakeFile(index, progress);
    if (!self.Image && self.Header.path.empty())
    {
      self.Open(this->FileName, progress); // the output had been released
    }
    if (self.Image)
    {
      output->ShallowCopy(self.Image);
      self.Image = nullptr;
    }
    else
    {
      self.ReadScan(index, output, progress);
    }
    if (self.Times.size() > 1)
    {
      self.Messages.erase(std::remove_if(self.Messages.begin(), self.Messages.end(),
                            [](const std::string& m) { return m.compare(0, 12, "a series of ") == 0; }),
        self.Messages.end());
      char time[40];
      std::snprintf(time, sizeof(time), "%g", self.Times[index]);
      self.Messages.push_back("a series of " + std::to_string(self.Times.size()) +
        " volumes, at " + spoken_times(self.Times, self.TimeUnit) + "; that at " + time +
        " is taken");
      output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), self.Times[index]);
    }
    this->UpdateProgress(1);
    return 1;
  }
  catch (const std::bad_alloc&)
  {
    self.Error = std::string(this->FileName) +
      ": there is not memory enough for it: close other programs or take a part of it";
  }
  catch (const std::exception& error)
  {
    self.Error = error.what();
  }
  output->Initialize();
  this->SetErrorCode(vtkErrorCode::FileFormatError);
  vtkErrorMacro(<< self.Error);
  return 1;
}

void vtkBrumeImageReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << '\n';
  os << indent << "Series: " << (this->Series ? this->Series : "(none)") << '\n';
  os << indent << "MaximumMemory: " << this->MaximumMemory << '\n';
  os << indent << "TimeUnit: " << this->GetTimeUnit() << '\n';
  os << indent << "Format: " << this->GetFormat() << '\n';
  os << indent << "LengthUnit: " << this->GetLengthUnit() << '\n';
  os << indent << "ValueUnit: " << this->GetValueUnit() << '\n';
  os << indent << "PatientAxes: " << this->GetPatientAxes() << '\n';
  os << indent << "ErrorMessage: " << this->GetErrorMessage() << '\n';
  for (int i = 0; i < this->GetNumberOfMessages(); ++i)
  {
    os << indent << "Message: " << this->GetMessage(i) << '\n';
  }
}
