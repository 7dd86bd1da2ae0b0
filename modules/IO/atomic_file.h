// Output files that are there whole or not at all.
#pragma once

#include "vtkBrumeIOModule.h" // the export macro alone

#include <cstddef>
#include <string>

namespace brume
{

/// A file that is written beside its place and moved into it when it is complete.
///
/// The temporary file lies in the same folder (a hidden name with the same ending), so that the
/// move is one step of the file system: whoever looks sees the old file or the new one. It is
/// removed when the object goes without commit(), when the program exits, and when SIGINT, SIGTERM
/// or SIGHUP ends it (only signals that have no handler of the program's own are watched). An
/// existing file keeps its permissions; a symbolic link stays one and its target is replaced. What
/// is no regular file (/dev/stdout, a pipe) is written directly.
class VTKBRUMEIO_EXPORT AtomicFile
{
public:
  /// Makes the temporary file. Throws std::runtime_error, "PATH: what is wrong: what to do", for a
  /// folder that is missing or may not be written, and for a path that is a folder itself.
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write, for libraries that want a path: they may truncate and write that file.
  const std::string& temporary_path() const { return temporary_; }

  /// Appends bytes to the temporary file. Throws as the constructor does, for a full disk too.
  void write(const void* bytes, std::size_t count);

  /// Brings the data to the disk and the file into its place. Throws as the constructor does; the
  /// old file, if there was one, is then untouched.
  void commit();

private:
  [[noreturn]] void fail(const std::string& doing, int error) const;

  std::string path_;      // as the user wrote it
  std::string target_;    // with symbolic links followed
  std::string temporary_;
  int file_ = -1;
  int slot_ = -1; // in the list of files to remove when a signal ends the program
  bool direct_ = false;
};

/// A whole file at once. Throws as AtomicFile does.
VTKBRUMEIO_EXPORT void write_atomically(
  const std::string& path, const void* bytes, std::size_t count);
VTKBRUMEIO_EXPORT void write_atomically(const std::string& path, const std::string& text);

/// Removes every temporary file that is not yet committed. Safe in a signal handler: for programs
/// that handle SIGINT and its kin themselves.
VTKBRUMEIO_EXPORT void remove_temporary_files() noexcept;

}
