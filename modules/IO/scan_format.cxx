#include "scan_format.h"

#include "dicom_series.h"
#include "file_access.h"
#include "header_text.h"
#include "picture_stack.h"
#include "raw_header.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

namespace brume::io
{

namespace
{

const char* const Known =
  "Brume reads DICOM, TIFF, NIfTI, MetaImage, NRRD, VTI and legacy VTK structured points";

bool begins(const std::string& text, const std::string& with)
{
  return text.compare(0, with.size(), with) == 0;
}

bool ends(const std::string& text, const std::string& with)
{
  return text.size() >= with.size() &&
    text.compare(text.size() - with.size(), with.size(), with) == 0;
}

/// Whether the bytes begin with the length of a NIfTI or Analyze header, in either byte order.
bool looks_like_nifti(const std::string& bytes)
{
  return bytes.size() >= 4 &&
    (begins(bytes, std::string("\x5c\x01\x00\x00", 4)) ||
      begins(bytes, std::string("\x00\x00\x01\x5c", 4)) ||
      begins(bytes, std::string("\x1c\x02\x00\x00", 4)) ||
      begins(bytes, std::string("\x00\x00\x02\x1c", 4)));
}

bool looks_like_meta(const std::string& bytes)
{
  const std::string line = bytes.substr(0, bytes.find_first_of("\r\n"));
  const std::size_t equals = line.find('=');
  if (equals == std::string::npos)
  {
    return false;
  }
  const std::string key = trimmed(line.substr(0, equals));
  for (const char* known : { "ObjectType", "ObjectSubType", "NDims", "Comment", "TransformType",
         "ID", "ParentID", "Name", "BinaryData", "CompressedData", "AcquisitionDate", "Modality",
         "DimSize" })
  {
    if (key == known)
    {
      return true;
    }
  }
  return false;
}

bool is_text(const std::string& bytes)
{
  return std::all_of(bytes.begin(), bytes.end(),
    [](unsigned char c) { return c >= 32 || c == '\n' || c == '\r' || c == '\t'; });
}

[[noreturn]] void refuse(const std::string& path, const std::string& bytes, bool deflated)
{
  const std::string name = lowered(path);
  if (begins(bytes, std::string(" BDV\0", 5)))
  {
    fail(path, "is OpenVDB, which is not a dense volume", "read it with vtkBrumeOpenVDBReader");
  }
  if (begins(bytes, "\xff\xd8\xff"))
  {
    fail(path, "is a JPEG picture, not a volume", "save the slices as TIFF or PNG");
  }
  if (begins(bytes, "\x89HDF"))
  {
    fail(path, "is HDF5", "convert it to NIfTI (for MINC: mnc2nii)");
  }
  for (const char* ending : { ".nii", ".nii.gz", ".hdr", ".img", ".mha", ".mhd", ".nrrd", ".nhdr",
         ".vti", ".vtk" })
  {
    if (ends(name, ending))
    {
      fail(path, std::string("is named ") + ending + ", but its content is " +
          (deflated          ? "something else, compressed"
              : is_text(bytes) ? "plain text of another kind"
                               : "something else"),
        "check that the file is what it should be, and whole");
    }
  }
  if (ends(name, ".raw") || ends(name, ".bin") || ends(name, ".dat"))
  {
    fail(path, "is raw data with no header", raw_advice(path));
  }
  fail(path, deflated ? "is compressed, and what is in it is no volume" : "is no volume", Known);
}

}

Format find_format(const std::string& path)
{
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
  {
    // Scans go before pictures of the papers that lie beside them.
    return has_dicom(path) || pictures_in(path).empty() ? Format::Dicom : Format::Pictures;
  }
  if (file_length(path, path) == 0)
  {
    fail(path, "is empty", "copy or download it again");
  }
  const std::string name = lowered(path);
  if (!sidecar_of(path).empty())
  {
    return Format::Raw; // raw bytes may look like anything: a description beside them goes first
  }
  if (ends(name, ".img") || ends(name, ".img.gz"))
  {
    return Format::Nifti; // the header beside it is what can be examined
  }
  std::string bytes(1024, '\0');
  ByteStream stream(path, path, 0, ByteStream::Guess);
  try
  {
    bytes.resize(stream.read(&bytes[0], bytes.size()));
  }
  catch (const std::exception&)
  {
    // A damaged or truncated stream; its first bytes may still tell what it was meant to be.
    if (ends(name, ".nii.gz") || ends(name, ".hdr.gz"))
    {
      return Format::Nifti; // whose reader tells what is wrong
    }
    throw;
  }
  if (looks_like_nifti(bytes))
  {
    return Format::Nifti;
  }
  if (!stream.deflated())
  {
    if (bytes.size() >= 132 && bytes.compare(128, 4, "DICM") == 0)
    {
      return Format::Dicom;
    }
    if (begins(bytes, "\x89PNG") || begins(bytes, std::string("II*\0", 4)) ||
      begins(bytes, std::string("MM\0*", 4)) || begins(bytes, std::string("II+\0", 4)) ||
      begins(bytes, std::string("MM\0+", 4)))
    {
      return Format::Pictures;
    }
    if (ends(name, ".json"))
    {
      return Format::Raw;
    }
    if (begins(bytes, "NRRD000"))
    {
      return Format::Nrrd;
    }
    if (begins(lowered(bytes.substr(0, 14)), "# vtk datafile"))
    {
      return Format::LegacyVtk;
    }
    if (bytes.find("<VTKFile") != std::string::npos)
    {
      return Format::Vti;
    }
    if (looks_like_meta(bytes))
    {
      return Format::MetaImage;
    }
  }
  refuse(path, bytes, stream.deflated());
}

}
