// A TIFF of one page a slice, with what ImageJ writes into its description: "ImageJ User Guide", 2012,
// and the fields of its ij.io.TiffEncoder.
#include "image_file.h"

#include "atomic_file.h"
#include "header_text.h"

#include <OpenImageIO/imageio.h>

#include <stdexcept>

namespace brume::io
{

namespace
{

OIIO::TypeDesc type_of(Scalar scalar)
{
  switch (scalar)
  {
    case Scalar::Int8:
      return OIIO::TypeDesc::INT8;
    case Scalar::UInt8:
      return OIIO::TypeDesc::UINT8;
    case Scalar::Int16:
      return OIIO::TypeDesc::INT16;
    case Scalar::UInt16:
      return OIIO::TypeDesc::UINT16;
    case Scalar::Int32:
      return OIIO::TypeDesc::INT32;
    case Scalar::UInt32:
      return OIIO::TypeDesc::UINT32;
    case Scalar::Float32:
      return OIIO::TypeDesc::FLOAT;
    case Scalar::Float64:
      return OIIO::TypeDesc::DOUBLE;
    default:
      return OIIO::TypeDesc::UNKNOWN;
  }
}

/// What a TIFF cannot hold.
void tell_losses(ImageFile& image)
{
  const std::array<double, 9> d = image.direction();
  const bool turned = d != std::array<double, 9>{ { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };
  if (turned || image.affine[3] != 0.0 || image.affine[7] != 0.0 || image.affine[11] != 0.0)
  {
    image.messages.push_back("a TIFF holds neither origin nor direction: they are lost");
  }
  if (image.patient)
  {
    image.messages.push_back("a TIFF does not say how the patient lies: that is lost");
  }
  if (!image.value_unit.empty())
  {
    image.messages.push_back("a TIFF holds no unit of values: '" + image.value_unit + "' is lost");
  }
  const std::array<double, 3> spacing = image.spacing();
  if (spacing[0] != spacing[1])
  {
    image.messages.push_back("its pixels are no squares, which of this TIFF Brume alone reads");
  }
}

}

void write_tiff(ImageFile& image, const std::string& path)
{
  const OIIO::TypeDesc type = type_of(image.scalar);
  if (type == OIIO::TypeDesc::UNKNOWN)
  {
    fail(path, "a TIFF holds no integers of 64 bits", "write another --type, or another format");
  }
  constexpr std::int64_t most_pixels = 1 << 30;
  if (image.dimensions[0] > most_pixels || image.dimensions[1] > most_pixels ||
    image.dimensions[2] > 65535)
  {
    fail(path, "it has more voxels along an axis than a TIFF has pages or pixels", "write a .nrrd");
  }
  tell_losses(image);
  const std::array<double, 3> spacing = image.spacing();
  OIIO::ImageSpec spec(static_cast<int>(image.dimensions[0]),
    static_cast<int>(image.dimensions[1]), image.components, type);
  const std::string slices = std::to_string(image.dimensions[2]);
  // Without a unit ImageJ's readers would take the size of a pixel for none.
  const std::string unit = image.length_unit.empty() ? "pixel" : image.length_unit;
  spec.attribute("ImageDescription", "ImageJ=1.53t\nimages=" + slices + "\nslices=" + slices +
      "\nunit=" + unit + "\nspacing=" + exact(spacing[2]) +
      "\npixel_width=" + exact(spacing[0]) + "\npixel_height=" + exact(spacing[1]) +
      "\nloop=false\n");
  // OpenImageIO writes the resolution of square pixels alone; the two lines above hold any.
  spec.attribute("XResolution", static_cast<float>(1.0 / spacing[0]));
  spec.attribute("YResolution", static_cast<float>(1.0 / spacing[1]));
  spec.attribute("ResolutionUnit", "none");
  spec.attribute("compression", image.compress ? "zip" : "none");
  spec.attribute("DateTime", ""); // OpenImageIO would put the clock into the file
  constexpr std::uint64_t largest_classic = 4000000000u; // offsets of 32 bits, less what pages need
  spec.attribute("tiff:bigtiff", image.bytes() > largest_classic ? 1 : 0);

  AtomicFile file(path);
  const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create("tiff");
  const auto refuse = [&]()
  {
    const std::string why = out ? out->geterror() : OIIO::geterror();
    fail(path, "it cannot be written (" + why + ")", "free some space, or write to another disk");
  };
  const std::size_t page = static_cast<std::size_t>(image.bytes() / image.dimensions[2]);
  for (std::int64_t k = 0; k < image.dimensions[2]; ++k)
  {
    const auto mode = k == 0 ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage;
    if (!out || !out->open(file.temporary_path(), spec, mode) ||
      !out->write_image(type, static_cast<const char*>(image.voxels) + page * k))
    {
      refuse();
    }
    if (image.progress && !image.progress(double(k + 1) / image.dimensions[2]))
    {
      throw std::runtime_error("interrupted");
    }
  }
  if (!out->close())
  {
    refuse();
  }
  file.commit();
}

}
