#include "dicom_layout.h"

#include "file_access.h"
#include "scan_header.h"

#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>

namespace brume::io
{

namespace
{

constexpr std::uint32_t Undefined = 0xffffffff;
constexpr int DeepestNesting = 16;

/// Numbers of a file at any place, through one buffer.
class Bytes
{
public:
  Bytes(const std::string& path, std::uint64_t length)
    : path_(path)
    , file_(std::fopen(path.c_str(), "rb"), &close)
    , length_(length)
  {
    if (!file_)
    {
      fail(path, "cannot be opened", "check its permissions");
    }
  }
  std::uint64_t length() const { return length_; }
  /// `count` bytes (up to 64) at a place. Throws fail() beyond the file's end.
  const unsigned char* at(std::uint64_t place, std::size_t count)
  {
    if (place < begin_ || place + count > begin_ + size_)
    {
      if (place > length_ || count > length_ - place)
      {
        fail(path_, "the file is cut short within its header", "copy or download it again");
      }
      begin_ = place;
      size_ = 0;
      if (fseeko(file_.get(), static_cast<off_t>(place), SEEK_SET) == 0)
      {
        size_ = std::fread(buffer_, 1, sizeof(buffer_), file_.get());
      }
      if (size_ < count)
      {
        fail(path_, "the file is cut short within its header", "copy or download it again");
      }
    }
    return buffer_ + (place - begin_);
  }

private:
  static void close(std::FILE* file)
  {
    if (file)
    {
      std::fclose(file);
    }
  }
  std::string path_;
  std::unique_ptr<std::FILE, void (*)(std::FILE*)> file_;
  std::uint64_t length_;
  std::uint64_t begin_ = 0;
  std::size_t size_ = 0;
  unsigned char buffer_[8192];
};

struct Element
{
  std::uint16_t group = 0;
  std::uint16_t element = 0;
  char vr[2] = { 0, 0 }; ///< none for items and where it is implicit
  std::uint32_t length = 0;
  std::uint64_t value = 0; ///< where it begins
};

class Walker
{
public:
  Walker(const std::string& path, std::uint64_t length)
    : path_(path)
    , bytes_(path, length)
  {
  }

  DicomLayout walk()
  {
    DicomLayout layout;
    std::uint64_t at = meta(layout);
    if (layout.transfer_syntax == "1.2.840.10008.1.2.1.99")
    {
      fail(path_, "its data set is deflated as a whole, which Brume does not read",
        "write it anew without (gdcmconv --raw, or dcmconv +te)");
    }
    layout.big_endian = big_ = layout.transfer_syntax == "1.2.840.10008.1.2.2";
    implicit_ = layout.transfer_syntax == "1.2.840.10008.1.2";
    while (at + 8 <= bytes_.length() && layout.pixel_offset == 0)
    {
      const Element e = head(at, bytes_.length());
      const bool pixels = e.group == 0x7fe0 &&
        (e.element == 0x0010 || e.element == 0x0008 || e.element == 0x0009);
      if (pixels)
      {
        layout.pixel_element = e.element;
        layout.pixel_offset = e.value;
        layout.pixel_length = e.length;
        layout.encapsulated = e.length == Undefined;
        if (layout.encapsulated)
        {
          count_fragments(layout);
        }
      }
      else
      {
        at = skip(e, bytes_.length(), 0);
      }
    }
    return layout;
  }

private:
  [[noreturn]] void damaged(std::uint64_t at)
  {
    fail(path_, "its data element at byte " + std::to_string(at) + " is longer than what it is in",
      "the file is damaged: copy or download it again");
  }
  std::uint16_t u16(std::uint64_t at)
  {
    const unsigned char* b = bytes_.at(at, 2);
    return static_cast<std::uint16_t>(big_ ? b[0] << 8 | b[1] : b[1] << 8 | b[0]);
  }
  std::uint32_t u32(std::uint64_t at)
  {
    const std::uint32_t first = u16(at);
    const std::uint32_t second = u16(at + 2);
    return big_ ? first << 16 | second : second << 16 | first;
  }

  /// An element's head; its value ends by `end`, unless its length is undefined.
  Element head(std::uint64_t at, std::uint64_t end)
  {
    Element e;
    e.group = u16(at);
    e.element = u16(at + 2);
    if (e.group == 0xfffe || implicit_)
    {
      e.length = u32(at + 4);
      e.value = at + 8;
    }
    else
    {
      std::memcpy(e.vr, bytes_.at(at + 4, 2), 2);
      static const char* const longs[] = { "OB", "OD", "OF", "OL", "OV", "OW", "SQ", "SV", "UC",
        "UN", "UR", "UT", "UV" };
      bool is_long = false;
      for (const char* name : longs)
      {
        is_long = is_long || std::memcmp(e.vr, name, 2) == 0;
      }
      e.length = is_long ? u32(at + 8) : u16(at + 6);
      e.value = at + (is_long ? 12 : 8);
    }
    if (e.length != Undefined && (e.value > end || e.length > end - e.value))
    {
      damaged(at);
    }
    return e;
  }

  /// Where the next element begins.
  std::uint64_t skip(const Element& e, std::uint64_t end, int depth)
  {
    const bool sequence = e.length == Undefined || std::memcmp(e.vr, "SQ", 2) == 0;
    if (!sequence)
    {
      return e.value + e.length;
    }
    if (depth >= DeepestNesting)
    {
      fail(path_, "its sequences are nested more than " + std::to_string(DeepestNesting) + " deep",
        "the file is damaged: copy or download it again");
    }
    const bool unknown = std::memcmp(e.vr, "UN", 2) == 0;
    const bool before = implicit_;
    implicit_ = implicit_ || unknown; // PS3.5, 6.2.2: unknown sequences are implicit
    const std::uint64_t last = e.length == Undefined ? end : e.value + e.length;
    std::uint64_t at = e.value;
    bool open = true;
    while (open && at + 8 <= last)
    {
      const Element item = head(at, last);
      if (item.group != 0xfffe || (item.element != 0xe000 && item.element != 0xe0dd))
      {
        fail(path_, "a sequence holds something other than items at byte " + std::to_string(at),
          "the file is damaged: copy or download it again");
      }
      open = item.element != 0xe0dd;
      at = item.value;
      if (open)
      {
        at = skip_item(item, last, depth + 1);
      }
    }
    if (open && e.length == Undefined)
    {
      fail(path_, "the file is cut short within a sequence", "copy or download it again");
    }
    implicit_ = before;
    return e.length == Undefined ? at : last;
  }

  std::uint64_t skip_item(const Element& item, std::uint64_t end, int depth)
  {
    const std::uint64_t last = item.length == Undefined ? end : item.value + item.length;
    std::uint64_t at = item.value;
    while (at + 8 <= last)
    {
      const Element e = head(at, last);
      if (e.group == 0xfffe)
      {
        if (e.element == 0xe00d)
        {
          return e.value;
        }
        damaged(at);
      }
      at = skip(e, last, depth);
    }
    if (item.length == Undefined)
    {
      fail(path_, "the file is cut short within a sequence", "copy or download it again");
    }
    return last;
  }

  /// Reads group 2, which is explicit and little-endian; returns where the data set begins.
  std::uint64_t meta(DicomLayout& layout)
  {
    std::uint64_t at = 132;
    while (at + 8 <= bytes_.length() && u16(at) == 0x0002)
    {
      const Element e = head(at, bytes_.length());
      if (e.element == 0x0010 && e.length <= 64)
      {
        const auto* text = reinterpret_cast<const char*>(bytes_.at(e.value, e.length));
        layout.transfer_syntax.assign(text, e.length);
        while (!layout.transfer_syntax.empty() &&
          (layout.transfer_syntax.back() == '\0' || layout.transfer_syntax.back() == ' '))
        {
          layout.transfer_syntax.pop_back();
        }
      }
      at = skip(e, bytes_.length(), 0);
    }
    if (layout.transfer_syntax.empty())
    {
      fail(path_, "does not say how it is encoded (transfer syntax)",
        "write it anew with a DICOM tool (gdcmconv)");
    }
    return at;
  }

  void count_fragments(DicomLayout& layout)
  {
    std::uint64_t at = layout.pixel_offset;
    bool table = true;
    while (true)
    {
      if (at + 8 > bytes_.length())
      {
        fail(path_, "the file is cut short within its pixels", "copy or download it again");
      }
      const Element e = head(at, bytes_.length());
      if (e.group != 0xfffe || (e.element != 0xe000 && e.element != 0xe0dd) ||
        e.length == Undefined)
      {
        damaged(at);
      }
      if (e.element == 0xe0dd)
      {
        break;
      }
      layout.fragments += table ? 0 : 1;
      table = false;
      at = e.value + e.length;
    }
    layout.pixel_length = at - layout.pixel_offset;
  }

  std::string path_;
  Bytes bytes_;
  bool big_ = false;
  bool implicit_ = false;
};

}

bool looks_like_dicom(const std::string& path)
{
  std::ifstream in(path, std::ios::binary);
  char bytes[132] = {};
  return in.read(bytes, sizeof(bytes)) && std::memcmp(bytes + 128, "DICM", 4) == 0;
}

DicomLayout dicom_layout(const std::string& path)
{
  return Walker(path, file_length(path, path)).walk();
}

std::string syntax_name(const std::string& uid)
{
  static const std::map<std::string, std::string> names{ { "1.2.840.10008.1.2.5", "RLE" },
    { "1.2.840.10008.1.2.4.50", "JPEG (baseline)" }, { "1.2.840.10008.1.2.4.51", "JPEG (extended)" },
    { "1.2.840.10008.1.2.4.57", "lossless JPEG" }, { "1.2.840.10008.1.2.4.70", "lossless JPEG" },
    { "1.2.840.10008.1.2.4.80", "JPEG-LS" }, { "1.2.840.10008.1.2.4.81", "JPEG-LS" },
    { "1.2.840.10008.1.2.4.90", "JPEG 2000" }, { "1.2.840.10008.1.2.4.91", "JPEG 2000" },
    { "1.2.840.10008.1.2.4.100", "MPEG-2" }, { "1.2.840.10008.1.2.4.101", "MPEG-2" },
    { "1.2.840.10008.1.2.4.102", "MPEG-4" }, { "1.2.840.10008.1.2.4.103", "MPEG-4" },
    { "1.2.840.10008.1.2.4.201", "high-throughput JPEG 2000" },
    { "1.2.840.10008.1.2.4.202", "high-throughput JPEG 2000" },
    { "1.2.840.10008.1.2.4.203", "high-throughput JPEG 2000" } };
  const auto found = names.find(uid);
  return found == names.end() ? "transfer syntax " + uid : found->second;
}

}
