// MetaImage. The keys: https://itk.org/Wiki/MetaIO.
#include "image_file.h"

#include "atomic_file.h"
#include "header_text.h"
#include "orientation.h"

namespace brume::io
{

namespace
{

const char* type_name(Scalar scalar)
{
  switch (scalar)
  {
    case Scalar::Int8:
      return "MET_CHAR";
    case Scalar::UInt8:
      return "MET_UCHAR";
    case Scalar::Int16:
      return "MET_SHORT";
    case Scalar::UInt16:
      return "MET_USHORT";
    case Scalar::Int32:
      return "MET_INT";
    case Scalar::UInt32:
      return "MET_UINT";
    case Scalar::Int64:
      return "MET_LONG_LONG";
    case Scalar::UInt64:
      return "MET_ULONG_LONG";
    case Scalar::Float32:
      return "MET_FLOAT";
    case Scalar::Float64:
      return "MET_DOUBLE";
  }
  return "";
}

/// The letters that ITK writes: for each index axis the side that it comes from, which are those of
/// anatomical_code() turned round.
std::string from_letters(const std::array<double, 9>& direction)
{
  std::string code = anatomical_code(direction);
  for (char& letter : code)
  {
    letter = std::string("LRPASI")[std::string("RLAPIS").find(letter)];
  }
  return code;
}

}

void write_meta(ImageFile& image, const std::string& path)
{
  // ITK's world is LPS+; Brume's is RAS+.
  const double sign[3] = { image.patient ? -1.0 : 1.0, image.patient ? -1.0 : 1.0, 1.0 };
  const std::array<double, 9> turn = image.direction();
  const std::array<double, 3> spacing = image.spacing();
  std::string matrix;
  std::string origin;
  std::string steps;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int row = 0; row < 3; ++row)
    {
      const double v = sign[row] * turn[3 * row + axis];
      matrix += " " + exact(v == 0.0 ? 0.0 : v); // no "-0"
    }
    const double o = sign[axis] * image.affine[4 * axis + 3];
    origin += " " + exact(o == 0.0 ? 0.0 : o);
    steps += " " + exact(spacing[axis]);
  }
  const bool length_fits =
    image.length_unit == "mm" || image.length_unit == "cm" || image.length_unit == "um";
  if (!length_fits && !image.length_unit.empty())
  {
    image.messages.push_back("MetaImage knows mm, cm and um: the unit of length, " +
                             image.length_unit + ", is in a comment that Brume alone reads");
  }
  const std::string mark = write_mark(image, length_fits);
  if (!image.patient)
  {
    image.messages.push_back("MetaImage's axes are a patient's: that these are not is in a comment "
                             "that Brume alone reads");
  }
  const std::string packed = image.compress ? zlib_stream(image) : std::string();
  std::string head = "ObjectType = Image\nNDims = 3\n";
  head += mark.empty() ? "" : "Comment = " + mark + "\n";
  head += "BinaryData = True\n";
  head +=
    std::string("BinaryDataByteOrderMSB = ") + (machine_is_big_endian() ? "True" : "False") + "\n";
  head += std::string("CompressedData = ") + (image.compress ? "True" : "False") + "\n";
  head += image.compress ? "CompressedDataSize = " + std::to_string(packed.size()) + "\n" : "";
  head += "TransformMatrix =" + matrix + "\n";
  head += "Offset =" + origin + "\n";
  head += "CenterOfRotation = 0 0 0\n";
  head +=
    "AnatomicalOrientation = " + (image.patient ? from_letters(turn) : std::string("???")) + "\n";
  head += "ElementSpacing =" + steps + "\n";
  head += length_fits ? "DistanceUnits = " + image.length_unit + "\n" : "";
  head += image.value_unit == "HU" ? "Modality = MET_MOD_CT\n" : "";
  head += "DimSize = " + std::to_string(image.dimensions[0]) + " " +
          std::to_string(image.dimensions[1]) + " " + std::to_string(image.dimensions[2]) + "\n";
  head += image.components > 1
            ? "ElementNumberOfChannels = " + std::to_string(image.components) + "\n"
            : "";
  head += std::string("ElementType = ") + type_name(image.scalar) + "\n";
  head += "ElementDataFile = LOCAL\n";

  AtomicFile file(path);
  file.write(head.data(), head.size());
  if (image.compress)
  {
    file.write(packed.data(), packed.size());
  }
  else
  {
    write_plain(file, image);
  }
  file.commit();
}

}
