#include "picture.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace brume
{

namespace
{

template <typename AnyPicture>
void check(const AnyPicture& picture, const char* what)
{
  const bool positive = picture.width > 0 && picture.height > 0;
  if (!positive ||
    picture.rgb.size() != std::size_t{ 3 } * picture.width * static_cast<std::size_t>(picture.height))
  {
    throw std::invalid_argument(std::string(what) + ": " + std::to_string(picture.width) + " x " +
      std::to_string(picture.height) + " pixels with " + std::to_string(picture.rgb.size()) +
      " values: a picture holds at least one pixel and 3 values a pixel");
  }
}

double srgb_from_linear(double v)
{
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
}

}

void check_shape(const Picture& picture, const char* what)
{
  check(picture, what);
}

void check_shape(const Bitmap& bitmap, const char* what)
{
  check(bitmap, what);
}

Bitmap to_bitmap(const Picture& picture, DisplayCurve curve, double exposure)
{
  const double brightened = std::exp2(exposure);
  check_shape(picture, "picture to display");
  Bitmap bitmap{ picture.width, picture.height, {} };
  bitmap.rgb.resize(picture.rgb.size());
  for (std::size_t pixel = 0; pixel < picture.rgb.size(); pixel += 3)
  {
    const float* in = &picture.rgb[pixel];
    unsigned char* out = &bitmap.rgb[pixel];
    if (!std::isfinite(in[0]) || !std::isfinite(in[1]) || !std::isfinite(in[2]))
    {
      out[0] = 255;
      out[1] = 0;
      out[2] = 255;
      continue;
    }
    for (int channel = 0; channel < 3; ++channel)
    {
      const double v = std::clamp(brightened * in[channel], 0.0, 1.0);
      out[channel] = static_cast<unsigned char>(
        std::lround(255.0 * (curve == DisplayCurve::Srgb ? srgb_from_linear(v) : v)));
    }
  }
  return bitmap;
}

std::vector<unsigned char> encode_png(const Bitmap& bitmap)
{
  check_shape(bitmap, "picture to encode");
  vtkNew<vtkImageData> image;
  image->SetDimensions(bitmap.width, bitmap.height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  std::copy(
    bitmap.rgb.begin(), bitmap.rgb.end(), static_cast<unsigned char*>(image->GetScalarPointer()));

  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  if (!bytes || bytes->GetNumberOfValues() == 0)
  {
    throw std::runtime_error("PNG: the picture could not be encoded: is there enough memory?");
  }
  const unsigned char* first = bytes->GetPointer(0);
  return { first, first + bytes->GetNumberOfValues() };
}

}
