#include "vtkBrumeEnvironmentReader.h"

#include "environment_io.h"

#include "vtkDataObject.h"
#include "vtkErrorCode.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <new>
#include <stdexcept>

vtkStandardNewMacro(vtkBrumeEnvironmentReader);

struct vtkBrumeEnvironmentReader::Internals
{
  std::string Error;
  brume::io::EnvironmentPicture Picture; ///< between RequestInformation and RequestData

  /// Keeps what went wrong in place of the picture.
  void Read(const char* path, vtkTypeInt64 limit)
  {
    this->Error.clear();
    this->Picture = brume::io::EnvironmentPicture();
    try
    {
      if (!path || !*path)
      {
        throw std::runtime_error(
          "vtkBrumeEnvironmentReader: no file name is set: call SetFileName");
      }
      this->Picture = brume::io::read_environment(path, static_cast<std::uint64_t>(limit));
    }
    catch (const std::bad_alloc&)
    {
      this->Error =
        std::string(path) + ": there is not memory enough for it: take a smaller picture";
    }
    catch (const std::exception& error)
    {
      this->Error = error.what();
    }
  }
};

vtkBrumeEnvironmentReader::vtkBrumeEnvironmentReader()
  : Internal(std::make_unique<Internals>())
{
  this->SetNumberOfInputPorts(0);
}

vtkBrumeEnvironmentReader::~vtkBrumeEnvironmentReader()
{
  delete[] this->FileName;
}

const char* vtkBrumeEnvironmentReader::GetErrorMessage() const
{
  return this->Internal->Error.c_str();
}

int vtkBrumeEnvironmentReader::RequestInformation(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputVector)
{
  Internals& self = *this->Internal;
  this->SetErrorCode(vtkErrorCode::NoError);
  self.Read(this->FileName, this->MaximumMemory);
  const int extent[6] = {
    0, self.Picture.width - 1, 0, self.Picture.height - 1, 0, self.Error.empty() ? 0 : -1
  };
  vtkInformation* info = outputVector->GetInformationObject(0);
  info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  vtkDataObject::SetPointDataActiveScalarInfo(info, VTK_FLOAT, 3);
  if (!self.Error.empty())
  {
    this->SetErrorCode(vtkErrorCode::FileFormatError);
    vtkErrorMacro(<< self.Error);
  }
  return 1; // the output is empty then; a failure here would only repeat the error in other words
}

int vtkBrumeEnvironmentReader::RequestData(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputVector)
{
  Internals& self = *this->Internal;
  vtkImageData* output = vtkImageData::GetData(outputVector);
  output->Initialize();
  if (!self.Error.empty())
  {
    return 1; // RequestInformation has said it
  }
  if (self.Picture.rgb.empty())
  {
    self.Read(this->FileName, this->MaximumMemory); // the output had been released
    if (!self.Error.empty())
    {
      this->SetErrorCode(vtkErrorCode::FileFormatError);
      vtkErrorMacro(<< self.Error);
      return 1;
    }
  }
  vtkNew<vtkFloatArray> radiance;
  radiance->SetName("radiance");
  radiance->SetNumberOfComponents(3);
  radiance->SetNumberOfTuples(static_cast<vtkIdType>(self.Picture.width) * self.Picture.height);
  std::copy(self.Picture.rgb.begin(), self.Picture.rgb.end(), radiance->GetPointer(0));
  output->SetDimensions(self.Picture.width, self.Picture.height, 1);
  output->GetPointData()->SetScalars(radiance);
  self.Picture = brume::io::EnvironmentPicture();
  return 1;
}

void vtkBrumeEnvironmentReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << '\n';
  os << indent << "MaximumMemory: " << this->MaximumMemory << '\n';
  os << indent << "ErrorMessage: " << this->GetErrorMessage() << '\n';
}
