// DICOM files made byte by byte, for what vtk-dicom's writer does not write. Explicit VR, little endian;
// the structures are those of PS3.5, sections 7 and A.4, and annex G.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace dicom_bytes
{

inline const char* const Plain = "1.2.840.10008.1.2.1";
inline const char* const Rle = "1.2.840.10008.1.2.5";

/// A whole number, the lowest byte first.
inline std::string number(std::uint64_t value, int bytes)
{
  std::string text;
  for (int i = 0; i < bytes; ++i)
  {
    text.push_back(static_cast<char>(value >> (8 * i)));
  }
  return text;
}

inline std::string tag(std::uint32_t group_and_element)
{
  return number(group_and_element >> 16, 2) + number(group_and_element & 0xffff, 2);
}

/// An element; values are padded to an even length as their kind asks.
inline std::string element(std::uint32_t name, const std::string& vr, std::string value)
{
  if (value.size() % 2)
  {
    value.push_back(vr == "UI" || vr == "OB" ? '\0' : ' ');
  }
  const bool wide = vr == "OB" || vr == "OW" || vr == "SQ";
  return tag(name) + vr + (wide ? number(0, 2) + number(value.size(), 4) : number(value.size(), 2)) +
    value;
}

inline std::string us(std::uint32_t name, unsigned value)
{
  return element(name, "US", number(value, 2));
}

inline std::string item(const std::string& content)
{
  return tag(0xfffee000) + number(content.size(), 4) + content;
}

/// A sequence of one item.
inline std::string sequence(std::uint32_t name, const std::string& content)
{
  return element(name, "SQ", item(content));
}

/// A file of a data set, whose elements are in rising order.
inline std::string file(const std::string& syntax, const std::string& data_set)
{
  const std::string meta = element(0x00020002, "UI", "1.2.840.10008.5.1.4.1.1.7") +
    element(0x00020003, "UI", "1.2.3.4") + element(0x00020010, "UI", syntax);
  return std::string(128, '\0') + "DICM" +
    element(0x00020000, "UL", number(meta.size(), 4)) + meta + data_set;
}

/// What says how the pixels lie.
inline std::string pixel_format(int width, int height, int frames, int samples = 1, int planar = 0)
{
  return us(0x00280002, static_cast<unsigned>(samples)) +
    element(0x00280004, "CS", samples == 3 ? "RGB" : "MONOCHROME2") +
    (samples == 3 ? us(0x00280006, static_cast<unsigned>(planar)) : "") +
    element(0x00280008, "IS", std::to_string(frames)) + us(0x00280010, static_cast<unsigned>(height)) +
    us(0x00280011, static_cast<unsigned>(width));
}

inline std::string bits_of(int bits)
{
  const auto count = static_cast<unsigned>(bits);
  return us(0x00280100, count) + us(0x00280101, count) + us(0x00280102, count - 1) + us(0x00280103, 0);
}

/// A picture of 8 or 16 bits in RLE: a segment for each byte of a pixel, the highest first; runs of
/// equal bytes and stretches of others (PS3.5, annex G).
inline std::string rle(const std::string& pixels, std::size_t bytes)
{
  std::vector<std::string> segments;
  for (std::size_t byte = bytes; byte-- > 0;)
  {
    std::string plane;
    for (std::size_t i = byte; i < pixels.size(); i += bytes)
    {
      plane.push_back(pixels[i]);
    }
    std::string packed;
    for (std::size_t i = 0; i < plane.size();)
    {
      std::size_t run = 1;
      while (i + run < plane.size() && run < 128 && plane[i + run] == plane[i])
      {
        ++run;
      }
      packed.push_back(static_cast<char>(run > 1 ? 257 - run : 0));
      packed.push_back(plane[i]);
      i += run;
    }
    packed.append(packed.size() % 2, '\0');
    segments.push_back(packed);
  }
  std::string head = number(segments.size(), 4);
  std::size_t place = 64;
  for (const std::string& segment : segments)
  {
    head += number(place, 4);
    place += segment.size();
  }
  head.resize(64, '\0');
  for (const std::string& segment : segments)
  {
    head += segment;
  }
  return head;
}

/// Compressed pixels, a fragment a frame, with an empty table of offsets.
inline std::string fragments(const std::vector<std::string>& frames)
{
  std::string out = tag(0x7fe00010) + "OB" + number(0, 2) + number(0xffffffff, 4) + item("");
  for (const std::string& frame : frames)
  {
    out += item(frame);
  }
  return out + tag(0xfffee0dd) + number(0, 4);
}

}
