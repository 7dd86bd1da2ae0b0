#include "mesh_check.h"

#include "vtkCellArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

namespace brume::app
{

namespace
{

/// The bytes of a number of a .ply file, 0 for a type that there is not.
int size_of_type(const std::string& type)
{
  static const std::map<std::string, int> sizes{ { "char", 1 }, { "uchar", 1 }, { "int8", 1 },
    { "uint8", 1 }, { "short", 2 }, { "ushort", 2 }, { "int16", 2 }, { "uint16", 2 }, { "int", 4 },
    { "uint", 4 }, { "int32", 4 }, { "uint32", 4 }, { "float", 4 }, { "float32", 4 }, { "double", 8 },
    { "float64", 8 } };
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

struct PlyProperty
{
  int count_size = 0; ///< bytes of a list's length; 0 for a single number
  int size = 0;
};

struct PlyElement
{
  std::string name;
  unsigned long long count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader
{
  std::string format;
  std::vector<PlyElement> elements;
};

/// Reads up to end_header; false for what is no header.
bool read_header(std::istream& in, PlyHeader& header)
{
  std::string line;
  if (!std::getline(in, line) || line.compare(0, 3, "ply") != 0)
  {
    return false;
  }
  for (int lines = 0; lines < 1000 && std::getline(in, line); ++lines)
  {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "end_header")
    {
      return !header.format.empty();
    }
    if (word == "format")
    {
      words >> header.format;
    }
    else if (word == "element")
    {
      PlyElement element;
      words >> element.name >> element.count;
      header.elements.push_back(element);
    }
    else if (word == "property")
    {
      PlyProperty property;
      std::string type;
      words >> type;
      if (type == "list")
      {
        std::string count_type;
        words >> count_type >> type;
        property.count_size = size_of_type(count_type);
        if (property.count_size == 0 || property.count_size > 4)
        {
          return false;
        }
      }
      property.size = size_of_type(type);
      if (property.size == 0 || header.elements.empty())
      {
        return false;
      }
      header.elements.back().properties.push_back(property);
    }
    if (words.fail())
    {
      return false;
    }
  }
  return false;
}

/// Whether a line holds the numbers of an element.
bool is_element(const std::string& line, const PlyElement& element)
{
  std::istringstream words(line);
  std::string word;
  for (const PlyProperty& property : element.properties)
  {
    long long count = 1;
    if (property.count_size > 0)
    {
      words >> word;
      count = words ? std::atoll(word.c_str()) : -1;
    }
    if (count < 0 || count > static_cast<long long>(line.size()))
    {
      return false;
    }
    for (; count > 0; --count)
    {
      words >> word;
    }
    if (!words)
    {
      return false;
    }
  }
  return true;
}

/// A list's length in a file of bytes; −1 at its end.
long long read_count(std::istream& in, int size, bool big_endian)
{
  std::array<unsigned char, 4> bytes{};
  if (!in.read(reinterpret_cast<char*>(bytes.data()), size))
  {
    return -1;
  }
  std::uint32_t value = 0;
  for (int i = 0; i < size; ++i)
  {
    value = value << 8 | bytes[big_endian ? i : size - 1 - i];
  }
  return value;
}

/// Whether the elements' bytes are all there.
bool holds_elements(std::istream& in, const PlyElement& element, bool big_endian,
  unsigned long long file_size)
{
  unsigned long long fixed = 0;
  bool lists = false;
  for (const PlyProperty& property : element.properties)
  {
    fixed += property.count_size > 0 ? property.count_size : property.size;
    lists = lists || property.count_size > 0;
  }
  if (fixed == 0 || element.count > file_size / fixed)
  {
    return element.count == 0;
  }
  if (!lists)
  {
    in.seekg(static_cast<std::streamoff>(fixed * element.count), std::ios::cur);
    return static_cast<unsigned long long>(in.tellg()) <= file_size;
  }
  for (unsigned long long i = 0; i < element.count; ++i)
  {
    for (const PlyProperty& property : element.properties)
    {
      const long long count =
        property.count_size > 0 ? read_count(in, property.count_size, big_endian) : 1;
      if (count < 0)
      {
        return false;
      }
      in.seekg(static_cast<std::streamoff>(count * property.size), std::ios::cur);
      if (!in || static_cast<unsigned long long>(in.tellg()) > file_size)
      {
        return false;
      }
    }
  }
  return true;
}

/// An index of a face of an .obj file, from 1 on, or from the last back with −1.
bool is_index(const std::string& text, long long count)
{
  const long long index = std::atoll(text.c_str());
  return index >= 1 ? index <= count : index < 0 && -index <= count;
}

}

std::string check_ply(const std::string& path)
{
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  const auto file_size = static_cast<unsigned long long>(in.tellg());
  in.seekg(0);
  PlyHeader header;
  if (!read_header(in, header))
  {
    return "it has no header of a .ply file";
  }
  const bool big_endian = header.format == "binary_big_endian";
  if (header.format != "ascii" && !big_endian && header.format != "binary_little_endian")
  {
    return "its format, " + header.format + ", is not read";
  }
  for (const PlyElement& element : header.elements)
  {
    bool whole = true;
    if (header.format == "ascii")
    {
      std::string line;
      for (unsigned long long i = 0; i < element.count && whole; ++i)
      {
        whole = std::getline(in, line) && is_element(line, element);
      }
    }
    else
    {
      whole = holds_elements(in, element, big_endian, file_size);
    }
    if (!whole)
    {
      return "it is cut off: it does not hold " + std::to_string(element.count) + " times '" +
        element.name + "'";
    }
    if (element.count == 0 && (element.name == "vertex" || element.name == "face"))
    {
      return "it holds no surface";
    }
  }
  std::size_t found = 0;
  for (const PlyElement& element : header.elements)
  {
    found += element.name == "vertex" || element.name == "face";
  }
  return found == 2 ? std::string() : "it holds no surface";
}

std::string check_obj(const std::string& path)
{
  std::ifstream in(path);
  std::array<long long, 3> counts{ 0, 0, 0 }; // points, texture points, normals
  std::string line;
  for (long long number = 1; std::getline(in, line); ++number)
  {
    std::istringstream words(line);
    std::string word;
    words >> word;
    counts[0] += word == "v";
    counts[1] += word == "vt";
    counts[2] += word == "vn";
    if (word != "f" && word != "l" && word != "p")
    {
      continue;
    }
    while (words >> word)
    {
      std::istringstream parts(word); // POINT, POINT/TEXTURE, POINT//NORMAL or all three
      std::string part;
      for (std::size_t i = 0; i < 3 && std::getline(parts, part, '/'); ++i)
      {
        if ((i == 0 || !part.empty()) && !is_index(part, counts[i]))
        {
          return "line " + std::to_string(number) + " names a point that is not there before it, '" +
            word.substr(0, 40) + "'";
        }
      }
    }
  }
  return {};
}

std::string check_surface(vtkPolyData* mesh)
{
  const vtkIdType points = mesh->GetNumberOfPoints();
  for (vtkIdType i = 0; i < points; ++i)
  {
    const double* p = mesh->GetPoint(i);
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
    {
      return "its point " + std::to_string(i) + " is not finite";
    }
  }
  vtkNew<vtkIdList> ids;
  for (vtkCellArray* cells :
    { mesh->GetVerts(), mesh->GetLines(), mesh->GetPolys(), mesh->GetStrips() })
  {
    for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell)
    {
      cells->GetCellAtId(cell, ids);
      for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
      {
        if (ids->GetId(i) < 0 || ids->GetId(i) >= points)
        {
          return "its cell " + std::to_string(cell) + " names a point that is not there, " +
            std::to_string(ids->GetId(i));
        }
      }
    }
  }
  return {};
}

}
