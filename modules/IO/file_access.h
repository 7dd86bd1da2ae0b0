// Bytes of files, plain or deflated, with errors that say what is wrong. Private to this module.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

namespace brume::io
{

/// The length of a regular file in bytes. Throws "OWNER: …" (see fail() in scan_header.h) when
/// `path` is missing, is a folder or no regular file, or may not be read. OWNER is the file that
/// the user named; `path` is that file, or a data file that it refers to.
std::uint64_t file_length(const std::string& owner, const std::string& path);

/// The folder of `path` with `name` in it; `name` itself when it is absolute.
std::string beside(const std::string& path, const std::string& name);

/// Reads a file from a place in it on, inflating as it goes when asked to.
class ByteStream
{
public:
  enum Mode
  {
    Plain,   ///< the bytes as they are
    Inflate, ///< a gzip (also of several members) or zlib stream
    Guess    ///< Inflate where the bytes begin as gzip does, else Plain
  };
  /// Throws as file_length() does.
  ByteStream(const std::string& owner, const std::string& path, std::uint64_t offset, Mode mode);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// Up to `count` bytes; fewer only where the stream ends properly. Throws "… is cut short: …" for
  /// a deflated stream that stops early and "… is damaged: …" for one that is no stream or whose
  /// checksum fails.
  std::size_t read(void* bytes, std::size_t count);
  /// Reads and forgets; false when the stream ends before.
  bool skip(std::uint64_t count);
  /// Whether the bytes are being inflated.
  bool deflated() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}
