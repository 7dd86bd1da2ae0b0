#include "vtkBrumeImageWriter.h"

#include "atomic_file.h"
#include "header_text.h"
#include "image_file.h"
#include "image_view.h"
#include "scan_header.h"

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"
#include "vtkXMLImageDataWriter.h"

#include <exception>
#include <new>
#include <stdexcept>
#include <vector>

vtkStandardNewMacro(vtkBrumeImageWriter);

using namespace brume;

namespace
{

enum class Kind
{
  Vti,
  Nrrd,
  Meta,
  Nifti,
  Raw,
  Tiff,
  None
};

Kind kind_of(const std::string& path)
{
  const std::string name = io::lowered(path);
  const auto ends = [&name](const std::string& ending)
  {
    return name.size() > ending.size() &&
           name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
  };
  return ends(".vti")                      ? Kind::Vti
         : ends(".nrrd")                   ? Kind::Nrrd
         : ends(".mha")                    ? Kind::Meta
         : ends(".nii") || ends(".nii.gz") ? Kind::Nifti
         : ends(".raw")                    ? Kind::Raw
         : ends(".tif") || ends(".tiff")   ? Kind::Tiff
                                           : Kind::None;
}

/// Hears the writer within.
struct Ear
{
  vtkBrumeImageWriter* outer;
  std::string error;

  static void hear(vtkObject* caller, unsigned long event, void* client, void* data)
  {
    Ear& self = *static_cast<Ear*>(client);
    if (event == vtkCommand::ProgressEvent)
    {
      auto* writer = static_cast<vtkAlgorithm*>(caller);
      self.outer->UpdateProgress(writer->GetProgress());
      writer->SetAbortExecute(self.outer->GetAbortExecute());
    }
    else if (self.error.empty())
    {
      std::string text = data ? static_cast<const char*>(data) : "";
      const std::size_t place = text.find("): ");
      text = place == std::string::npos ? text : text.substr(place + 3);
      self.error = text.substr(0, text.find('\n'));
    }
  }
};

}

struct vtkBrumeImageWriter::Internals
{
  std::string Error;
  std::vector<std::string> Messages;
};

vtkBrumeImageWriter::vtkBrumeImageWriter()
  : Internal(std::make_unique<Internals>())
{
}

vtkBrumeImageWriter::~vtkBrumeImageWriter()
{
  delete[] this->FileName;
}

bool vtkBrumeImageWriter::CanWriteFile(const char* path)
{
  return path && kind_of(path) != Kind::None;
}

const char* vtkBrumeImageWriter::GetErrorMessage() const
{
  return this->Internal->Error.c_str();
}

int vtkBrumeImageWriter::GetNumberOfMessages() const
{
  return static_cast<int>(this->Internal->Messages.size());
}

const char* vtkBrumeImageWriter::GetMessage(int index) const
{
  return index >= 0 && index < this->GetNumberOfMessages() ? this->Internal->Messages[index].c_str()
                                                           : nullptr;
}

int vtkBrumeImageWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

/// VTK's writer makes the XML; units go into field data, which every reader of VTK hands on.
void vtkBrumeImageWriter::WriteVTI(vtkImageData* input)
{
  vtkNew<vtkImageData> image;
  image->ShallowCopy(input);
  const auto tell = [&image](const char* name, const std::string& text)
  {
    image->GetFieldData()->RemoveArray(name);
    if (!text.empty())
    {
      vtkNew<vtkStringArray> array;
      array->SetName(name);
      array->InsertNextValue(text);
      image->GetFieldData()->AddArray(array);
    }
  };
  tell("length_unit", this->LengthUnit);
  tell("value_unit", this->ValueUnit);
  tell("axes", this->PatientAxes ? "RAS" : "");

  AtomicFile file(this->FileName);
  Ear ear{ this, {} };
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&ear);
  observer->SetCallback(&Ear::hear);
  vtkNew<vtkXMLImageDataWriter> writer;
  writer->AddObserver(vtkCommand::ErrorEvent, observer);
  writer->AddObserver(vtkCommand::ProgressEvent, observer);
  writer->SetInputData(image);
  writer->SetFileName(file.temporary_path().c_str());
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetHeaderTypeToUInt64();
  if (this->Compress)
  {
    writer->SetCompressorTypeToZLib();
  }
  else
  {
    writer->SetCompressorTypeToNone();
  }
  const int written = writer->Write();
  if (this->GetAbortExecute())
  {
    throw std::runtime_error("interrupted");
  }
  if (!ear.error.empty() || !written || writer->GetErrorCode() != vtkErrorCode::NoError)
  {
    io::fail(this->FileName,
      "VTK cannot write it (" +
        (ear.error.empty() ? vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode())
                           : ear.error) +
        ")",
      "free some space, or write to another disk");
  }
  file.commit();
}

void vtkBrumeImageWriter::WriteData()
{
  Internals& self = *this->Internal;
  self = Internals();
  this->SetErrorCode(vtkErrorCode::NoError);
  try
  {
    if (!this->FileName || !*this->FileName)
    {
      throw std::runtime_error("vtkBrumeImageWriter: no file name is set: call SetFileName");
    }
    const Kind kind = kind_of(this->FileName);
    if (kind == Kind::None)
    {
      io::fail(this->FileName,
        "its ending names no format that holds a volume",
        "end it in .vti, .nrrd, .mha, .nii, .nii.gz, .raw or .tif");
    }
    vtkImageData* image = vtkImageData::SafeDownCast(this->GetInput());
    io::ImageFile file = io::view_of(image, this->FileName);
    file.patient = this->PatientAxes;
    file.length_unit = this->LengthUnit;
    file.value_unit = this->ValueUnit;
    file.compress = this->Compress;
    file.progress = [this](double done)
    {
      this->UpdateProgress(done);
      return !this->GetAbortExecute();
    };
    const int arrays = image->GetPointData()->GetNumberOfArrays();
    if (kind != Kind::Vti && arrays > 1)
    {
      self.Messages.push_back(
        "of its " + std::to_string(arrays) + " arrays the scalars alone, " +
        (file.array.empty() ? std::string("which have no name") : file.array) +
        ", are written: .vti and .vdb hold several");
    }
    switch (kind)
    {
      case Kind::Vti:
        this->WriteVTI(image);
        break;
      case Kind::Nrrd:
        io::write_nrrd(file, this->FileName);
        break;
      case Kind::Meta:
        io::write_meta(file, this->FileName);
        break;
      case Kind::Raw:
        io::write_raw(file, this->FileName);
        break;
      case Kind::Tiff:
        io::write_tiff(file, this->FileName);
        break;
      default:
        io::write_nifti(file, this->FileName);
    }
    self.Messages.insert(self.Messages.end(), file.messages.begin(), file.messages.end());
    const bool named = kind == Kind::Vti || kind == Kind::Nrrd || kind == Kind::Raw; // which tells it
    if (!named && arrays == 1 && !file.array.empty() && file.array != io::ScanHeader().array)
    {
      self.Messages.push_back("the name of its array, " + file.array + ", is left out");
    }
    this->UpdateProgress(1);
    return;
  }
  catch (const std::bad_alloc&)
  {
    self.Error = std::string(this->FileName) +
                 ": there is not memory enough to write it: close other programs";
  }
  catch (const std::exception& error)
  {
    self.Error = error.what();
  }
  this->SetErrorCode(vtkErrorCode::UserError);
  vtkErrorMacro(<< self.Error);
}

void vtkBrumeImageWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << '\n';
  os << indent << "LengthUnit: " << this->LengthUnit << '\n';
  os << indent << "ValueUnit: " << this->ValueUnit << '\n';
  os << indent << "PatientAxes: " << this->PatientAxes << '\n';
  os << indent << "Compress: " << this->Compress << '\n';
  os << indent << "ErrorMessage: " << this->GetErrorMessage() << '\n';
  for (int i = 0; i < this->GetNumberOfMessages(); ++i)
  {
    os << indent << "Message: " << this->GetMessage(i) << '\n';
  }
}
