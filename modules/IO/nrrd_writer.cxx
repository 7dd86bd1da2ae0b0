// NRRD. The fields: G. Kindlmann, "Definition of NRRD File Format",
// https://teem.sourceforge.net/nrrd/format.html.
#include "image_file.h"

#include "atomic_file.h"
#include "header_text.h"

namespace brume::io
{

namespace
{

const char* type_name(Scalar scalar)
{
  return scalar == Scalar::Float32   ? "float"
         : scalar == Scalar::Float64 ? "double"
                                     : scalar_name(scalar);
}

std::string vector_text(const std::array<double, 12>& affine, int column)
{
  return "(" + exact(affine[column]) + "," + exact(affine[4 + column]) + "," +
         exact(affine[8 + column]) + ")";
}

/// Without line ends, and blanks at its ends.
std::string line_of(std::string text)
{
  for (char& c : text)
  {
    c = static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return trimmed(text);
}

/// In quotes, which the format asks for; a quote or a line end within cannot be had.
std::string quoted(std::string text)
{
  for (char& c : text)
  {
    c = c == '"' || static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return '"' + text + '"';
}

}

void write_nrrd(ImageFile& image, const std::string& path)
{
  const bool several = image.components > 1;
  const std::string first = several ? std::to_string(image.components) + " " : "";
  std::string head = "NRRD0005\n# Complete NRRD file format specification at:\n"
                     "# http://teem.sourceforge.net/nrrd/format.html\n";
  const std::string name = line_of(image.array);
  head += name.empty() ? "" : "content: " + name + "\n";
  head += std::string("type: ") + type_name(image.scalar) + "\n";
  head += std::string("dimension: ") + (several ? "4" : "3") + "\n";
  head += image.patient ? "space: right-anterior-superior\n" : "space dimension: 3\n";
  head += "sizes: " + first + std::to_string(image.dimensions[0]) + " " +
          std::to_string(image.dimensions[1]) + " " + std::to_string(image.dimensions[2]) + "\n";
  head += std::string("space directions: ") + (several ? "none " : "") +
          vector_text(image.affine, 0) + " " + vector_text(image.affine, 1) + " " +
          vector_text(image.affine, 2) + "\n";
  head += std::string("kinds: ") + (several ? "list " : "") + "domain domain domain\n";
  head += std::string("endian: ") + (machine_is_big_endian() ? "big" : "little") + "\n";
  head += std::string("encoding: ") + (image.compress ? "gzip" : "raw") + "\n";
  if (!image.length_unit.empty())
  {
    const std::string unit = quoted(image.length_unit);
    head += "space units: " + unit + " " + unit + " " + unit + "\n";
  }
  head += "space origin: " + vector_text(image.affine, 3) + "\n";
  if (!image.value_unit.empty())
  {
    head += "sample units: " + quoted(image.value_unit) + "\n";
  }
  head += "\n";

  AtomicFile file(path);
  file.write(head.data(), head.size());
  if (image.compress)
  {
    write_gzip(file, image);
  }
  else
  {
    write_plain(file, image);
  }
  file.commit();
}

}
