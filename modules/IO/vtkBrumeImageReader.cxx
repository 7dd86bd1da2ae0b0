#include "vtkBrumeImageReader.h"

#include "orientation.h"
#include "scan_format.h"
#include "scan_header.h"
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

#include "vtksys/SystemInformation.hxx"

#include <new>
#include <stdexcept>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkBrumeImageReader);

namespace
{
using namespace brume;

int vtk_type(io::Scalar scalar)
{
  switch (scalar)
  {
    case io::Scalar::Int8:
      return VTK_SIGNED_CHAR;
    case io::Scalar::UInt8:
      return VTK_UNSIGNED_CHAR;
    case io::Scalar::Int16:
      return VTK_SHORT;
    case io::Scalar::UInt16:
      return VTK_UNSIGNED_SHORT;
    case io::Scalar::Int32:
      return VTK_INT;
    case io::Scalar::UInt32:
      return VTK_UNSIGNED_INT;
    case io::Scalar::Int64:
      return VTK_TYPE_INT64;
    case io::Scalar::UInt64:
      return VTK_TYPE_UINT64;
    case io::Scalar::Float32:
      return VTK_FLOAT;
    case io::Scalar::Float64:
      return VTK_DOUBLE;
  }
  return VTK_VOID;
}

bool rescales(const io::ScanHeader& header)
{
  return header.slope != 1 || header.intercept != 0;
}

/// The type that values have once slope and intercept are applied.
int value_type(const io::ScanHeader& header)
{
  if (!rescales(header))
  {
    return vtk_type(header.scalar);
  }
  const bool wide = io::scalar_size(header.scalar) >= 4 && header.scalar != io::Scalar::Float32;
  return wide ? VTK_DOUBLE : VTK_FLOAT;
}

template <typename In, typename Out>
void rescale(const In* in, Out* out, vtkIdType count, double slope, double intercept)
{
  for (vtkIdType i = 0; i < count; ++i)
  {
    out[i] = static_cast<Out>(slope * static_cast<double>(in[i]) + intercept);
  }
}

vtkSmartPointer<vtkDataArray> rescaled(vtkDataArray* stored, const io::ScanHeader& header)
{
  vtkSmartPointer<vtkDataArray> values;
  values.TakeReference(vtkDataArray::CreateDataArray(value_type(header)));
  values->SetNumberOfComponents(stored->GetNumberOfComponents());
  values->SetNumberOfTuples(stored->GetNumberOfTuples());
  const vtkIdType count = stored->GetNumberOfValues();
  void* out = values->GetVoidPointer(0);
  switch (stored->GetDataType())
  {
    vtkTemplateMacro(if (value_type(header) == VTK_FLOAT) rescale(
                       static_cast<const VTK_TT*>(stored->GetVoidPointer(0)),
                       static_cast<float*>(out), count, header.slope, header.intercept);
                     else rescale(static_cast<const VTK_TT*>(stored->GetVoidPointer(0)),
                       static_cast<double*>(out), count, header.slope, header.intercept));
  }
  return values;
}

/// A volume larger than the machine's memory would be granted page by page, and then end the
/// program with no word: it is refused here.
void check_memory(const io::ScanHeader& header)
{
  vtksys::SystemInformation machine;
  const double memory = static_cast<double>(machine.GetHostMemoryTotal()) * 1024;
  double need = static_cast<double>(header.bytes());
  if (rescales(header))
  {
    need *= 1 + static_cast<double>(value_type(header) == VTK_FLOAT ? 4 : 8) /
        io::scalar_size(header.scalar);
  }
  if (memory > 0 && need > memory)
  {
    const auto gigabytes = [](double bytes) { return std::to_string(bytes / 1e9).substr(0, 5); };
    io::fail(header.path, "takes " + gigabytes(need) + " GB of memory, and this machine has " +
        gigabytes(memory), "take a part of it, or a machine with more");
  }
}
}

struct vtkBrumeImageReader::Internals
{
  std::string Error;
  std::vector<std::string> Messages;
  std::string Format;
  std::string LengthUnit;
  std::string ValueUnit;
  bool PatientAxes = false;

  // A scan, known by its header; or an image that a VTK reader has read whole.
  io::ScanHeader Header;
  GridFrame Frame;
  vtkSmartPointer<vtkImageData> Image;

  void Clear() { *this = Internals(); }

  /// Everything but the voxels of a scan. Throws what the parsers throw.
  void Open(const std::string& path, const io::Progress& progress)
  {
    const io::Format format = io::find_format(path);
    if (format == io::Format::LegacyVtk)
    {
      this->Header = io::read_legacy_header(path);
    }
    if (format == io::Format::Vti || (format == io::Format::LegacyVtk && this->Header.parts.empty()))
    {
      this->Header = io::ScanHeader();
      io::VtkVolume volume = format == io::Format::Vti ? io::read_vti(path, progress)
                                                       : io::read_legacy(path, progress);
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
      this->Header = format == io::Format::Nifti ? io::read_nifti_header(path)
        : format == io::Format::MetaImage        ? io::read_meta_header(path)
                                                 : io::read_nrrd_header(path);
    }
    io::check_header(this->Header);
    check_memory(this->Header);
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

  void ReadScan(vtkImageData* image, const io::Progress& progress) const
  {
    vtkSmartPointer<vtkDataArray> stored;
    stored.TakeReference(vtkDataArray::CreateDataArray(vtk_type(this->Header.scalar)));
    stored->SetNumberOfComponents(static_cast<int>(this->Header.components));
    stored->SetNumberOfTuples(static_cast<vtkIdType>(this->Header.voxels()));
    io::read_voxels(this->Header, stored->GetVoidPointer(0), progress);
    if (this->Frame.reversed_axis >= 0)
    {
      io::reverse_axis(stored->GetVoidPointer(0), this->Header.dimensions,
        this->Header.components * io::scalar_size(this->Header.scalar), this->Frame.reversed_axis);
    }
    vtkSmartPointer<vtkDataArray> values =
      rescales(this->Header) ? rescaled(stored, this->Header) : stored;
    values->SetName(this->Header.array.c_str());
    image->SetExtent(0, static_cast<int>(this->Header.dimensions[0] - 1), 0,
      static_cast<int>(this->Header.dimensions[1] - 1), 0,
      static_cast<int>(this->Header.dimensions[2] - 1));
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

bool vtkBrumeImageReader::GetPatientAxes() const
{
  return this->Internal->PatientAxes;
}

bool vtkBrumeImageReader::CanReadFile(const char* path)
{
  try
  {
    io::find_format(path ? path : "");
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
        info, value_type(self.Header), static_cast<int>(self.Header.components));
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
  return 1; // the output is empty then; a failure here would only repeat the error in other words
}

int vtkBrumeImageReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  Internals& self = *this->Internal;
  vtkImageData* output = vtkImageData::GetData(outputVector);
  output->Initialize();
  if (!self.Error.empty())
  {
    return 1; // RequestInformation has said it
  }
  try
  {
    const io::Progress progress = [this](double done)
    {
      this->UpdateProgress(done);
      return !this->GetAbortExecute();
    };
    if (self.Image || self.Header.path.empty())
    {
      if (!self.Image)
      {
        self.Open(this->FileName, progress); // the output had been released
      }
      output->ShallowCopy(self.Image);
      self.Image = nullptr;
    }
    else
    {
      self.ReadScan(output, progress);
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
