#include "file_access.h"

#include "scan_header.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

namespace brume::io
{

namespace fs = std::filesystem;

namespace
{
std::string place(const std::string& owner, const std::string& path)
{
  return owner == path ? owner : owner + ": " + path;
}
}

std::uint64_t file_length(const std::string& owner, const std::string& path)
{
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
  {
    if (status.type() == fs::file_type::none) // cannot even be asked
    {
      fail(place(owner, path), error.message(), "check the path and its permissions");
    }
    fail(place(owner, path), owner == path ? "no such file" : "the data file is not there",
      owner == path ? "check the path" : "keep it beside its header");
  }
  if (fs::is_directory(status))
  {
    fail(place(owner, path), "is a folder", "name a file in it");
  }
  if (!fs::is_regular_file(status))
  {
    fail(place(owner, path), "is not a regular file", "copy its content to a file first");
  }
  const std::uintmax_t length = fs::file_size(path, error);
  if (error)
  {
    fail(place(owner, path), error.message(), "check the path and its permissions");
  }
  return length;
}

std::string beside(const std::string& path, const std::string& name)
{
  return (fs::path(path).parent_path() / name).string();
}

struct ByteStream::Impl
{
  std::string name;
  std::FILE* file = nullptr;
  bool inflating = false;
  bool finished = false; // the stream's end has been reached
  z_stream z{};
  std::vector<unsigned char> input = std::vector<unsigned char>(1 << 18);

  ~Impl()
  {
    if (inflating)
    {
      inflateEnd(&z);
    }
    if (file)
    {
      std::fclose(file);
    }
  }

  std::size_t fill(void* bytes, std::size_t count)
  {
    const std::size_t n = std::fread(bytes, 1, count, file);
    if (n < count && std::ferror(file))
    {
      fail(name, std::string("reading failed: ") + std::strerror(errno), "check the disk");
    }
    return n;
  }

  /// More input for zlib; false at the file's end.
  bool refill()
  {
    z.next_in = input.data();
    z.avail_in = static_cast<uInt>(fill(input.data(), input.size()));
    return z.avail_in > 0;
  }
};

ByteStream::ByteStream(
  const std::string& owner, const std::string& path, std::uint64_t offset, Mode mode)
  : impl_(new Impl)
{
  impl_->name = place(owner, path);
  file_length(owner, path);
  impl_->file = std::fopen(path.c_str(), "rb");
  if (!impl_->file)
  {
    fail(impl_->name, std::string("cannot be opened: ") + std::strerror(errno),
      "check its permissions");
  }
  if (offset > static_cast<std::uint64_t>(INT64_MAX) ||
    fseeko(impl_->file, static_cast<off_t>(offset), SEEK_SET) != 0)
  {
    fail(impl_->name, "the data would begin beyond the file's end", "check that the file is whole");
  }
  if (mode == Guess)
  {
    unsigned char magic[2] = { 0, 0 };
    const std::size_t n = impl_->fill(magic, 2);
    mode = n == 2 && magic[0] == 0x1f && magic[1] == 0x8b ? Inflate : Plain;
    fseeko(impl_->file, static_cast<off_t>(offset), SEEK_SET);
  }
  if (mode == Inflate)
  {
    // 15 bits of window; + 32: zlib finds out whether the stream is gzip or zlib.
    if (inflateInit2(&impl_->z, 15 + 32) != Z_OK)
    {
      throw std::bad_alloc();
    }
    impl_->inflating = true;
  }
}

ByteStream::~ByteStream() = default;

bool ByteStream::deflated() const
{
  return impl_->inflating;
}

std::size_t ByteStream::read(void* bytes, std::size_t count)
{
  Impl& self = *impl_;
  if (!self.inflating)
  {
    return self.fill(bytes, count);
  }
  unsigned char* out = static_cast<unsigned char*>(bytes);
  std::size_t done = 0;
  while (done < count && !self.finished)
  {
    if (self.z.avail_in == 0 && !self.refill())
    {
      fail(self.name, "the compressed data is cut short", "copy or download the file again");
    }
    const uInt piece = static_cast<uInt>(std::min<std::size_t>(count - done, 1u << 30));
    self.z.next_out = out + done;
    self.z.avail_out = piece;
    const int state = inflate(&self.z, Z_NO_FLUSH);
    done += piece - self.z.avail_out;
    if (state == Z_STREAM_END)
    {
      // Another gzip member may follow; anything else after the end is padding.
      if (self.z.avail_in == 0)
      {
        self.refill();
      }
      if (self.z.avail_in >= 1 && self.z.next_in[0] == 0x1f)
      {
        inflateReset(&self.z);
      }
      else
      {
        self.finished = true;
      }
    }
    else if (state != Z_OK && state != Z_BUF_ERROR)
    {
      fail(self.name,
        std::string("the compressed data is damaged (") + (self.z.msg ? self.z.msg : "no reason") +
          ")",
        "copy or download the file again");
    }
  }
  return done;
}

bool ByteStream::skip(std::uint64_t count)
{
  std::vector<unsigned char> scratch(1 << 16);
  while (count > 0)
  {
    const std::size_t piece =
      static_cast<std::size_t>(std::min<std::uint64_t>(count, scratch.size()));
    if (read(scratch.data(), piece) != piece)
    {
      return false;
    }
    count -= piece;
  }
  return true;
}

}
