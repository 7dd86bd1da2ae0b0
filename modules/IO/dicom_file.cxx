#include "dicom_file.h"

#include "dicom_decode.h"
#include "header_text.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDICOMDictHash.h"
#include "vtkDICOMItem.h"
#include "vtkDICOMMetaData.h"
#include "vtkDICOMParser.h"
#include "vtkDICOMTag.h"
#include "vtkDICOMValue.h"
#include "vtkNew.h"

#include <cmath>
#include <limits>

namespace brume::io
{

namespace
{

const char* const Remedy = "check that the file is whole, or export the series again";
constexpr double NotThere = std::numeric_limits<double>::quiet_NaN();

/// A value's numbers where there are `count` of them and all are finite.
template <std::size_t Count>
bool take(const vtkDICOMValue& value, std::array<double, Count>& numbers)
{
  if (value.GetNumberOfValues() != Count)
  {
    return false;
  }
  std::array<double, Count> read;
  for (std::size_t i = 0; i < Count; ++i)
  {
    read[i] = value.GetDouble(i);
    if (!std::isfinite(read[i]) || std::abs(read[i]) > 1e9)
    {
      return false;
    }
  }
  numbers = read;
  return true;
}

double number(const vtkDICOMValue& value, double otherwise)
{
  std::array<double, 1> one;
  return take(value, one) ? one[0] : otherwise;
}

/// A count or a code; −1 where it is not there. vtk-dicom's own conversion of texts to int overflows.
int whole(const vtkDICOMValue& value)
{
  const double v = number(value, -1);
  return v >= 0 && v <= 2147483647.0 && v == std::floor(v) ? static_cast<int>(v) : -1;
}

/// "HHMMSS.FFFFFF", or a date in front of it, in seconds of the day.
double seconds_of(const vtkDICOMValue& value)
{
  std::string text = trimmed(value.AsString());
  const std::size_t point = std::min(text.find('.'), text.size());
  if (point > 6)
  {
    text.erase(0, point - 6);
  }
  std::vector<double> parsed;
  if (text.size() < 6 || text.find_first_not_of("0123456789.") != std::string::npos ||
    !parse_numbers(text.substr(0, 2) + " " + text.substr(2, 2) + " " + text.substr(4), parsed) ||
    parsed.size() != 3)
  {
    return NotThere;
  }
  return parsed[0] * 3600 + parsed[1] * 60 + parsed[2];
}

/// At most 64 characters that can be printed.
std::string plain(const vtkDICOMValue& value)
{
  std::string text = trimmed(value.AsUTF8String()).substr(0, 64);
  for (char& c : text)
  {
    c = static_cast<unsigned char>(c) < 32 || c == 127 ? ' ' : c;
  }
  return text;
}

DicomFrame frame_of(vtkDICOMMetaData* meta, int index)
{
  const auto get = [&](DC::EnumType tag) -> const vtkDICOMValue& { return meta->Get(0, index, tag); };
  DicomFrame frame;
  frame.placed = take(get(DC::ImagePositionPatient), frame.position) &&
    take(get(DC::ImageOrientationPatient), frame.rows);
  std::array<double, 2> spacing; // between rows, then between columns
  if ((take(get(DC::PixelSpacing), spacing) || take(get(DC::ImagerPixelSpacing), spacing)) &&
    spacing[0] > 0 && spacing[1] > 0)
  {
    frame.pixel = { { spacing[1], spacing[0] } };
  }
  frame.between = std::abs(number(get(DC::SpacingBetweenSlices), 0));
  if (frame.between == 0)
  {
    frame.between = std::abs(number(get(DC::SliceThickness), 0));
  }
  frame.slope = number(get(DC::RescaleSlope), 1);
  frame.intercept = number(get(DC::RescaleIntercept), 0);
  frame.slope = frame.slope == 0 ? 1 : frame.slope;
  const double position = number(get(DC::TemporalPositionIndex), NotThere);
  frame.times = { { std::isnan(position) ? number(get(DC::TemporalPositionIdentifier), NotThere)
                                         : position,
    number(get(DC::TriggerTime), NotThere) / 1000, seconds_of(get(DC::AcquisitionTime)),
    seconds_of(get(DC::ContentTime)) } };
  return frame;
}

/// The places of frames that have no functional groups of their own: offsets from slice to slice, as a
/// dose has them (PS3.3, C.8.8.3.2), else even steps. Without these all would lie at one place.
void place_frames(vtkDICOMMetaData* meta, DicomFile& file)
{
  std::vector<DicomFrame>& frames = file.frames;
  if (frames.size() < 2 || !frames[0].placed || meta->Has(DC::PerFrameFunctionalGroupsSequence))
  {
    return;
  }
  const DicomFrame first = frames[0];
  const std::array<double, 6>& r = first.rows;
  std::array<double, 3> normal{
    { r[1] * r[5] - r[2] * r[4], r[2] * r[3] - r[0] * r[5], r[0] * r[4] - r[1] * r[3] }
  };
  const vtkDICOMValue& offsets = meta->Get(DC::GridFrameOffsetVector);
  const bool told = offsets.GetNumberOfValues() == frames.size();
  const double signed_gap = number(meta->Get(DC::SpacingBetweenSlices), 0);
  const double gap = signed_gap != 0 ? signed_gap : first.between > 0 ? first.between : 1;
  // Offsets that do not begin at 0 are the patient's z itself, of slices across it.
  const double start = told ? offsets.GetDouble(0) : 0;
  const bool across = std::abs(normal[2]) > 0.999;
  const double base = start == 0 ? 0 : across ? first.position[2] : start;
  const double sense = start != 0 && across && normal[2] < 0 ? -1 : 1;
  for (std::size_t i = 0; i < frames.size(); ++i)
  {
    const double away = told ? sense * (offsets.GetDouble(i) - base) : gap * static_cast<double>(i);
    if (!std::isfinite(away) || std::abs(away) > 1e9)
    {
      fail(file.path, "its GridFrameOffsetVector does not tell where its slices lie", Remedy);
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      frames[i].position[axis] = first.position[axis] + away * normal[axis];
    }
  }
  file.spread = !told;
}

void take_format(vtkDICOMMetaData* meta, DicomFile& file)
{
  const std::string& path = file.path;
  file.width = whole(meta->Get(DC::Columns));
  file.height = whole(meta->Get(DC::Rows));
  if (file.width < 1 || file.height < 1)
  {
    fail(path, "gives no Rows and Columns", Remedy);
  }
  const int samples = whole(meta->Get(DC::SamplesPerPixel));
  file.components = samples < 1 ? 1 : samples;
  file.planar = file.components > 1 && whole(meta->Get(DC::PlanarConfiguration)) == 1;
  const int allocated = whole(meta->Get(DC::BitsAllocated));
  const bool is_signed = whole(meta->Get(DC::PixelRepresentation)) == 1;
  if (file.layout.pixel_element == 0x0010)
  {
    if (allocated != 8 && allocated != 16 && allocated != 32)
    {
      fail(path,
        allocated < 0 ? std::string("does not say how many bits a pixel has")
                      : "its pixels have " + std::to_string(allocated) + " bits",
        "Brume reads 8, 16 and 32: convert it (gdcmconv --raw)");
    }
    file.scalar = allocated == 8 ? (is_signed ? Scalar::Int8 : Scalar::UInt8)
      : allocated == 16          ? (is_signed ? Scalar::Int16 : Scalar::UInt16)
                                 : (is_signed ? Scalar::Int32 : Scalar::UInt32);
    const int stored = whole(meta->Get(DC::BitsStored));
    file.bits = stored >= 1 && stored <= allocated ? stored : allocated;
  }
  else
  {
    file.scalar = file.layout.pixel_element == 0x0008 ? Scalar::Float32 : Scalar::Float64;
    file.bits = 8 * scalar_size(file.scalar);
  }
  const std::string colours = meta->Get(DC::PhotometricInterpretation).AsString();
  if (colours.find("422") != std::string::npos && !file.layout.encapsulated)
  {
    fail(path, "its colours are of half resolution (" + shortened(colours) + ")",
      "convert it to RGB (dcm2img, gdcmconv)");
  }
}

}

std::uint64_t DicomFile::frame_bytes() const
{
  return static_cast<std::uint64_t>(width) * height * components * scalar_size(scalar);
}

/// Frames of one file: what each takes beside its pixels bounds their number.
constexpr std::uint64_t MostFrames = 65536;

DicomFile read_dicom_file(const std::string& path)
{
  DicomFile file;
  file.path = path;
  file.layout = dicom_layout(path);
  if (file.layout.pixel_offset == 0)
  {
    fail(path, "holds no pixels", "name a file or folder of pictures");
  }

  if (file.layout.encapsulated && !can_decode(file.layout.transfer_syntax))
  {
    fail(path,
      "its pixels are compressed as " + syntax_name(file.layout.transfer_syntax) +
        ", which Brume does not read",
      "decompress it first (gdcmconv --raw IN OUT)");
  }

  // What is asked of the parser: all else is passed over.
  vtkDICOMItem query;
  for (DC::EnumType tag : { DC::SOPInstanceUID, DC::AcquisitionTime, DC::ContentTime, DC::Modality,
         DC::SeriesDescription, DC::SliceThickness, DC::SpacingBetweenSlices, DC::TriggerTime,
         DC::ImagerPixelSpacing, DC::SeriesInstanceUID, DC::SeriesNumber, DC::InstanceNumber,
         DC::ImagePositionPatient, DC::ImageOrientationPatient, DC::TemporalPositionIdentifier,
         DC::TemporalResolution, DC::SamplesPerPixel, DC::PhotometricInterpretation,
         DC::PlanarConfiguration, DC::NumberOfFrames, DC::Rows, DC::Columns, DC::PixelSpacing,
         DC::BitsAllocated, DC::BitsStored, DC::PixelRepresentation, DC::RescaleIntercept,
         DC::RescaleSlope, DC::GridFrameOffsetVector, DC::DoseGridScaling, DC::DoseUnits,
         DC::SharedFunctionalGroupsSequence,
         DC::PerFrameFunctionalGroupsSequence, DC::SpecificCharacterSet })
  {
    query.Set(tag, vtkDICOMValue());
  }
  bool bad = false;
  vtkNew<vtkCallbackCommand> ear;
  ear->SetClientData(&bad);
  ear->SetCallback([](vtkObject*, unsigned long, void* flag, void*) { *static_cast<bool*>(flag) = true; });
  vtkNew<vtkDICOMMetaData> meta;
  vtkNew<vtkDICOMParser> parser;
  meta->AddObserver(vtkCommand::ErrorEvent, ear);
  parser->AddObserver(vtkCommand::ErrorEvent, ear);
  parser->AddObserver(vtkCommand::WarningEvent, ear);
  parser->SetQueryItem(query);
  parser->SetMetaData(meta);
  parser->SetFileName(path.c_str());
  parser->Update();
  if (bad)
  {
    fail(path, "is damaged: vtk-dicom cannot read its header", "copy or download it again");
  }

  take_format(meta, file);
  file.series_uid = plain(meta->Get(DC::SeriesInstanceUID));
  file.instance_uid = plain(meta->Get(DC::SOPInstanceUID));
  file.description = plain(meta->Get(DC::SeriesDescription));
  file.modality = plain(meta->Get(DC::Modality));
  file.series_number = whole(meta->Get(DC::SeriesNumber));
  file.instance_number = whole(meta->Get(DC::InstanceNumber));
  file.temporal_resolution = number(meta->Get(DC::TemporalResolution), 0);

  const int told = whole(meta->Get(DC::NumberOfFrames));
  const std::uint64_t frames = static_cast<std::uint64_t>(std::max(told, 1));
  if (frames > MostFrames)
  {
    fail(path,
      "it has " + std::to_string(frames) + " frames, and Brume reads up to " +
        std::to_string(MostFrames),
      "split it");
  }
  const std::uint64_t most = file.layout.encapsulated
    ? file.layout.fragments
    : file.layout.pixel_length / std::max<std::uint64_t>(file.frame_bytes(), 1);
  if (frames > most)
  {
    fail(path,
      "the file is cut short: it promises " + std::to_string(frames) + " pictures of " +
        std::to_string(file.width) + " x " + std::to_string(file.height) +
        ", and its pixels are enough for " + std::to_string(most),
      "copy or download it again");
  }
  for (std::uint64_t i = 0; i < frames; ++i)
  {
    file.frames.push_back(frame_of(meta, static_cast<int>(i)));
  }
  place_frames(meta, file);
  const double scaling = number(meta->Get(DC::DoseGridScaling), 0);
  if (file.modality == "RTDOSE" && scaling > 0)
  {
    for (DicomFrame& frame : file.frames)
    {
      frame.slope = scaling;
      frame.intercept = 0;
    }
    const std::string unit = plain(meta->Get(DC::DoseUnits));
    file.value_unit = unit == "GY" ? "Gy" : "";
  }
  return file;
}

}
