// The folder that a subcommand fills.
#pragma once

#include <filesystem>
#include <string>

namespace brume::app
{

/// The folder is made before the work, so that a place that cannot be written is told at once.
/// Folders that were made here go again when the work fails.
class OutputFolder
{
public:
  /// `probe` is the name of a file that will be written there: it is tried, and taken back. Throws
  /// Failure for a folder that cannot be made or written.
  OutputFolder(const std::string& path, const std::string& probe);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// The work is done: the folder stays.
  void keep() { this->Kept = true; }
  /// The path of a file in it.
  std::string file(const std::string& name) const;

private:
  void remove();

  std::string Path;
  std::filesystem::path Made; ///< the topmost folder that was not there before; empty when all were
  bool Kept = false;
};

}
