// DICOM series for the tests, written by vtk-dicom.
#pragma once

#include "vtkDICOMCTGenerator.h"
#include "vtkDICOMMRGenerator.h"
#include "vtkDICOMMetaData.h"
#include "vtkDICOMWriter.h"

#include "vtkImageData.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace dicom_files
{

struct Series
{
  std::array<int, 3> size{ { 6, 5, 7 } };
  std::array<double, 3> spacing{ { 0.75, 1.25, 2.5 } };
  /// From mm along the axes to the patient (LPS+), rows.
  std::array<double, 12> place{ { 1, 0, 0, -20, 0, 1, 0, -30, 0, 0, 1, 40 } };
  double slope = 1;
  double intercept = -1024;
  std::string description = "Head";
  std::string number = "3";
  int times = 1;           ///< volumes over time
  double time_step = 1500; ///< ms
  const char* syntax = nullptr;
};

/// What a voxel's stored number is.
inline int stored(const Series& s, int i, int j, int k, int t = 0)
{
  return i + s.size[0] * (j + s.size[1] * (k + s.size[2] * t)) + 7;
}

/// Writes a folder of one file a slice, in the order of the slices and times; returns their names.
inline std::vector<std::string> write(const Series& s, const std::string& folder)
{
  std::filesystem::create_directories(folder);
  vtkNew<vtkImageData> image;
  image->SetDimensions(s.size[0], s.size[1], s.size[2]);
  image->SetSpacing(s.spacing.data());
  image->AllocateScalars(VTK_SHORT, s.times);
  auto* out = static_cast<short*>(image->GetScalarPointer());
  for (int k = 0; k < s.size[2]; ++k)
    for (int j = 0; j < s.size[1]; ++j)
      for (int i = 0; i < s.size[0]; ++i)
        for (int t = 0; t < s.times; ++t)
        {
          *out++ = static_cast<short>(stored(s, i, j, k, t));
        }
  vtkNew<vtkMatrix4x4> matrix;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
    {
      matrix->SetElement(row, column, s.place[4 * row + column]);
    }
  vtkNew<vtkDICOMMetaData> meta;
  meta->Set(DC::SeriesDescription, s.description);
  meta->Set(DC::SeriesNumber, s.number);
  meta->Set(DC::Modality, s.times > 1 ? "MR" : "CT");
  vtkNew<vtkDICOMCTGenerator> scan;
  vtkNew<vtkDICOMMRGenerator> resonance; // which has temporal positions
  vtkNew<vtkDICOMWriter> writer;
  writer->SetInputData(image);
  writer->SetMetaData(meta);
  writer->SetGenerator(
    s.times > 1 ? static_cast<vtkDICOMGenerator*>(resonance) : static_cast<vtkDICOMGenerator*>(scan));
  writer->SetMemoryRowOrderToFileNative();
  writer->SetFileSliceOrderToSame();
  writer->SetPatientMatrix(matrix);
  writer->SetRescaleSlope(s.slope);
  writer->SetRescaleIntercept(s.intercept);
  writer->SetTransferSyntaxUID(s.syntax);
  if (s.times > 1)
  {
    writer->TimeAsVectorOn();
    writer->SetTimeDimension(s.times);
    writer->SetTimeSpacing(s.time_step);
  }
  const std::string pattern = folder + "/%s-%04d.dcm";
  writer->SetFilePattern(pattern.c_str());
  writer->SetFilePrefix(("s" + s.number).c_str());
  writer->Write();
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
  {
    const std::string name = entry.path().filename().string();
    if (name.compare(0, s.number.size() + 2, "s" + s.number + "-") == 0)
    {
      names.push_back(entry.path().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Gives files names that say nothing of their order. Returns the new names, by the old order.
inline std::vector<std::string> shuffle(const std::vector<std::string>& names, unsigned seed)
{
  std::vector<int> numbers(names.size());
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    numbers[i] = static_cast<int>(i);
  }
  std::shuffle(numbers.begin(), numbers.end(), std::mt19937(seed));
  std::vector<std::string> shuffled;
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    const std::filesystem::path old(names[i]);
    const std::string name = (old.parent_path() /
      ("x" + std::to_string(seed) + "_" + std::to_string(numbers[i]))).string();
    std::filesystem::rename(old, name);
    shuffled.push_back(name);
  }
  return shuffled;
}

}
