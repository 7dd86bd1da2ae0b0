#include "picture_stack.h"

#include "file_access.h"
#include "guarded_process.h"
#include "header_text.h"
#include "picture_threads.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>

namespace brume::io
{

namespace fs = std::filesystem;

namespace
{

const char* const Remedy = "check that the files are whole, or save them again";

/// What all pictures of a stack have in common, in shared memory.
struct Common
{
  int width, height, channels, type, pages;
  double pixel[2]; ///< pixels per `unit`, 0: not told
  char unit[8];    ///< "in", "cm", or none
  char description[2048];
  int bad; ///< of the files that were opened, the first that is not like them; −1: none
  char problem[256];
  double done;
};

std::unique_ptr<OIIO::ImageInput> open_picture(const std::string& path)
{
  keep_picture_threads_out();
  OIIO::ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1; // numbers as they are stored
  return OIIO::ImageInput::open(path, &config);
}

/// The type that a format is read as; UNKNOWN for one that is not.
OIIO::TypeDesc::BASETYPE read_type(const OIIO::ImageSpec& spec)
{
  switch (spec.format.basetype)
  {
    case OIIO::TypeDesc::UINT8:
    case OIIO::TypeDesc::INT8:
    case OIIO::TypeDesc::UINT16:
    case OIIO::TypeDesc::INT16:
    case OIIO::TypeDesc::UINT32:
    case OIIO::TypeDesc::INT32:
    case OIIO::TypeDesc::FLOAT:
    case OIIO::TypeDesc::DOUBLE:
      return static_cast<OIIO::TypeDesc::BASETYPE>(spec.format.basetype);
    case OIIO::TypeDesc::HALF:
      return OIIO::TypeDesc::FLOAT;
    default:
      return OIIO::TypeDesc::UNKNOWN;
  }
}

Scalar scalar_of(const std::string& path, int type)
{
  switch (type)
  {
    case OIIO::TypeDesc::UINT8:
      return Scalar::UInt8;
    case OIIO::TypeDesc::INT8:
      return Scalar::Int8;
    case OIIO::TypeDesc::UINT16:
      return Scalar::UInt16;
    case OIIO::TypeDesc::INT16:
      return Scalar::Int16;
    case OIIO::TypeDesc::UINT32:
      return Scalar::UInt32;
    case OIIO::TypeDesc::INT32:
      return Scalar::Int32;
    case OIIO::TypeDesc::FLOAT:
      return Scalar::Float32;
    case OIIO::TypeDesc::DOUBLE:
      return Scalar::Float64;
    default:
      fail(path, "its pixels are of a type that Brume does not read",
        "save it in integers of 8, 16 or 32 bits, or in floats");
  }
}

template <std::size_t Size>
void put(char (&to)[Size], const std::string& text)
{
  const std::size_t length = std::min(text.size(), Size - 1); // the rest is 0
  std::copy_n(text.begin(), length, to);
}

void put_problem(Common& common, int index, const std::string& problem)
{
  common.bad = index;
  put(common.problem, problem);
}

/// What the process of its own does: opens every file, and counts the pages of the first.
int look(const std::vector<std::string>& paths, Common& common)
{
  common.bad = -1;
  for (std::size_t i = 0; i < paths.size(); ++i)
  {
    const auto input = open_picture(paths[i]);
    if (!input)
    {
      put_problem(common, static_cast<int>(i), "cannot be opened as a picture");
      return 0;
    }
    const OIIO::ImageSpec spec = input->spec();
    const int type = read_type(spec);
    if (i == 0)
    {
      common.width = spec.width;
      common.height = spec.height;
      common.channels = spec.nchannels;
      common.type = type;
      common.pixel[0] = spec.get_float_attribute("XResolution");
      common.pixel[1] = spec.get_float_attribute("YResolution");
      put(common.unit, spec.get_string_attribute("ResolutionUnit").substr(0, 7));
      put(common.description, spec.get_string_attribute("ImageDescription"));
    }
    int pages = 1;
    while (pages < 1000000 && input->seek_subimage(pages, 0))
    {
      const OIIO::ImageSpec page = input->spec();
      if (page.width != spec.width || page.height != spec.height ||
        page.nchannels != spec.nchannels || page.format != spec.format)
      {
        put_problem(common, static_cast<int>(i),
          "its page " + std::to_string(pages + 1) + " is of another size or type than its first");
        return 0;
      }
      ++pages;
    }
    common.pages = i == 0 ? pages : common.pages;
    if (spec.depth > 1 || spec.width != common.width || spec.height != common.height ||
      spec.nchannels != common.channels || type != common.type || (i > 0 && pages != 1))
    {
      put_problem(common, static_cast<int>(i), "is of another size or type than the first");
      return 0;
    }
    common.done = static_cast<double>(i) / static_cast<double>(paths.size());
  }
  return 0;
}

double bytes_of(const std::vector<std::string>& paths)
{
  double bytes = 0;
  for (const std::string& path : paths)
  {
    bytes += static_cast<double>(file_length(path, path));
  }
  return bytes;
}

Common look_guarded(const std::string& owner, const std::vector<std::string>& paths)
{
  const SharedMemory shared(sizeof(Common));
  Common& common = *new (shared.data()) Common();
  const GuardResult result = run_guarded([&] { return look(paths, common); },
    1 + static_cast<double>(paths.size()) / 100 + bytes_of(paths) / 2e7, 256 << 20);
  if (result.end != GuardEnd::Finished || result.status != 0)
  {
    fail(owner, spoken_end(result.end), Remedy);
  }
  if (common.bad >= 0)
  {
    const std::string& path = paths[static_cast<std::size_t>(common.bad)];
    fail(path == owner ? owner : owner + ": " + path, common.problem, Remedy);
  }
  return common;
}

/// ImageJ's "spacing=2.5" in a TIFF's description; empty where it is not there.
std::string imagej(const std::string& description, const std::string& key)
{
  if (description.compare(0, 7, "ImageJ=") != 0)
  {
    return {};
  }
  const std::size_t at = description.find("\n" + key + "=");
  if (at == std::string::npos)
  {
    return {};
  }
  const std::size_t begin = at + key.size() + 2;
  return trimmed(description.substr(begin, description.find('\n', begin) - begin));
}

double number(const std::string& text, double otherwise)
{
  std::vector<double> numbers;
  return !text.empty() && parse_numbers(text, numbers) && numbers.size() == 1 &&
      std::isfinite(numbers[0]) && numbers[0] > 0
    ? numbers[0]
    : otherwise;
}

void place(ScanHeader& h, const Common& common)
{
  const std::string text = common.description;
  std::string unit = imagej(text, "unit");
  const bool by_imagej = !unit.empty();
  unit = unit == "micron" || unit == "\\u00B5m" ? "um"
    : unit == "pixel" || unit == "pixels"        ? ""
                                                 : shortened(unit);
  const std::string told = common.unit;
  const double per = by_imagej ? 1 : told == "cm" ? 10 : told == "in" || told == "inch" ? 25.4 : 0;
  double pixel[2] = { 1, 1 };
  bool known = per > 0;
  for (int axis = 0; axis < 2; ++axis)
  {
    known = known && std::isfinite(common.pixel[axis]) && common.pixel[axis] > 1e-6;
  }
  // Pixels of the screen (72, 96 an inch) are what programs write that know nothing of the size.
  const bool screen = !by_imagej && told != "cm" && common.pixel[0] <= 96;
  if (known && !screen)
  {
    pixel[0] = per / common.pixel[0];
    pixel[1] = per / common.pixel[1];
    h.length_unit = by_imagej ? unit : "mm";
  }
  // What Brume writes of pixels that need not be squares (tiff_writer.cxx).
  const double size[2] = { number(imagej(text, "pixel_width"), 0), number(imagej(text, "pixel_height"), 0) };
  for (int axis = 0; axis < 2 && size[0] > 0 && size[1] > 0; ++axis)
  {
    pixel[axis] = size[axis];
  }
  // A hyperstack: channels go fastest, then slices, then frames. Channels become components.
  const std::int64_t channels = whole_number(number(imagej(text, "channels"), 1));
  if (channels > 1 && h.components == 1)
  {
    if (h.dimensions[2] % channels == 0 && channels <= 64)
    {
      h.components = channels;
      h.part_planar = true;
      h.dimensions[2] /= channels;
    }
    else
    {
      h.messages.push_back("its description tells of " + std::to_string(channels) +
        " channels, which its " + std::to_string(h.dimensions[2]) +
        " pages cannot be; each is taken for a slice");
    }
  }
  const double between = number(imagej(text, "spacing"), 0);
  h.affine = { { pixel[0], 0, 0, 0, 0, pixel[1], 0, 0, 0, 0, between > 0 ? between : pixel[0], 0 } };
  if (!known || screen)
  {
    h.messages.push_back("the pictures do not tell the size of a pixel; it is taken for 1");
  }
  if (between <= 0 && h.dimensions[2] > 1)
  {
    h.messages.push_back("the pictures do not tell how far apart they are; as far as pixels is assumed");
  }
  const double frames = number(imagej(text, "frames"), 1);
  const std::int64_t count = whole_number(frames);
  if (count > 1 && h.dimensions[2] % count == 0)
  {
    h.dimensions[2] /= count;
    set_series(h, count, 0, number(imagej(text, "finterval"), 0), "s");
  }
}

}

int count_pages(const std::string& path)
{
  return look_guarded(path, { path }).pages;
}

ScanHeader read_picture_header(const std::string& path, const std::vector<NumberedFile>& files)
{
  std::vector<std::string> paths;
  for (const NumberedFile& file : files)
  {
    paths.push_back(file.path);
  }
  if (paths.empty())
  {
    paths.push_back(path);
  }
  const Common common = look_guarded(path, paths);
  ScanHeader h;
  h.path = path;
  h.encoding = Encoding::Pictures;
  h.dimensions = { { common.width, common.height, 0 } };
  h.components = common.channels;
  h.scalar = scalar_of(path, common.type);
  h.format = lowered(paths[0]).find(".png") != std::string::npos ? "PNG" : "TIFF";
  h.format += paths.size() > 1 ? " stack" : "";
  if (paths.size() > 1 && common.pages > 1)
  {
    fail(path, "its files have several pages each", "name one of them");
  }
  for (const std::string& file : paths)
  {
    for (int page = 0; page < common.pages; ++page)
    {
      DataPart part;
      part.path = file;
      part.frame = static_cast<std::uint64_t>(page);
      h.parts.push_back(part);
    }
  }
  h.dimensions[2] = static_cast<std::int64_t>(h.parts.size());
  place(h, common);
  if (h.parts.size() == 1)
  {
    h.messages.push_back("is one picture; name the folder, or NAME%03d.tif, for a stack of them");
  }
  return h;
}

namespace
{

/// ".tiff" or ".png"; empty for another.
std::string picture_ending(const fs::path& path)
{
  const std::string ending = lowered(path.extension().string());
  return ending == ".tif" || ending == ".tiff" ? ".tiff" : ending == ".png" ? ending : "";
}

}

std::size_t count_pictures(const std::string& folder)
{
  std::size_t count = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
       entry.increment(error))
  {
    count += !picture_ending(entry->path()).empty();
  }
  return count;
}

std::vector<NumberedFile> pictures_in(const std::string& folder)
{
  std::vector<NumberedFile> files;
  std::string kind;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
       entry.increment(error))
  {
    const std::string ending = picture_ending(entry->path());
    if (ending.empty())
    {
      continue;
    }
    if (!kind.empty() && kind != ending)
    {
      fail(folder, "holds both TIFF and PNG files", "name one kind with a pattern, NAME%03d.tif");
    }
    kind = ending;
    const std::string stem = entry->path().stem().string();
    std::size_t end = stem.find_last_of("0123456789");
    end = end == std::string::npos ? 0 : end + 1;
    std::size_t begin = end;
    while (begin > 0 && std::isdigit(static_cast<unsigned char>(stem[begin - 1])) && end - begin < 15)
    {
      --begin;
    }
    files.push_back({ begin < end ? std::stoll(stem.substr(begin, end - begin)) : 0,
      entry->path().string() });
  }
  std::sort(files.begin(), files.end(),
    [](const NumberedFile& a, const NumberedFile& b)
    { return a.number != b.number ? a.number < b.number : a.path < b.path; });
  return files;
}

void read_pictures(const ScanHeader& header, unsigned char* out, const Progress& progress)
{
  static const OIIO::TypeDesc::BASETYPE types[] = { OIIO::TypeDesc::INT8, OIIO::TypeDesc::UINT8,
    OIIO::TypeDesc::INT16, OIIO::TypeDesc::UINT16, OIIO::TypeDesc::INT32, OIIO::TypeDesc::UINT32,
    OIIO::TypeDesc::INT64, OIIO::TypeDesc::UINT64, OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::DOUBLE };
  const OIIO::TypeDesc type(types[static_cast<int>(header.scalar)]);
  // Channels lie within a page, or, of a hyperstack, in pages of their own.
  const auto channels = static_cast<int>(header.part_planar ? 1 : header.components);
  const std::size_t each = header.bytes() / header.parts.size();
  const SharedMemory pixels(header.bytes());
  const SharedMemory page(sizeof(double));
  auto* const done = static_cast<double*>(page.data());
  const auto work = [&]() -> int
  {
    std::unique_ptr<OIIO::ImageInput> input;
    std::string path;
    for (std::size_t i = 0; i < header.parts.size(); ++i)
    {
      const DataPart& part = header.parts[i];
      if (part.path != path)
      {
        path = part.path;
        input = open_picture(path);
      }
      const int subimage = static_cast<int>(part.frame);
      if (!input || !input->seek_subimage(subimage, 0) ||
        input->spec().width != header.dimensions[0] ||
        input->spec().height != header.dimensions[1] ||
        input->spec().nchannels != channels ||
        !input->read_image(subimage, 0, 0, channels, type,
          static_cast<unsigned char*>(pixels.data()) + i * each))
      {
        return 1;
      }
      *done = static_cast<double>(i + 1) / static_cast<double>(header.parts.size());
    }
    return 0;
  };
  const GuardResult result = run_guarded(work, 1 + static_cast<double>(header.bytes()) / 4e6,
    static_cast<double>(each) * 4 + (128 << 20), progress, done);
  if (result.end != GuardEnd::Finished || result.status != 0)
  {
    const auto bad = std::min(static_cast<std::size_t>(*done * static_cast<double>(header.parts.size()) + 0.5),
      header.parts.size() - 1);
    const std::string& path = header.parts[bad].path;
    fail(path == header.path ? path : header.path + ": " + path,
      result.end == GuardEnd::Finished ? "its pixels are cut short or damaged" : spoken_end(result.end),
      result.end == GuardEnd::Stopped ? "run it again" : Remedy);
  }
  std::memcpy(out, pixels.data(), header.bytes());
}

}
