// Pictures of the window to files.
#pragma once

#include "viewer.h"

#include "Analysis/picture.h"

#include <string>
#include <vector>

class vtkCamera;

namespace brume::app
{

/// FOLDER/NAME-001ENDING, or the next number that is not taken.
std::string free_name(
  const std::string& folder, const std::string& name, const std::string& ending);

/// Writes a bitmap as PNG, whole or not at all. Throws std::runtime_error.
void save_png(const Bitmap& bitmap, const std::string& path);

/// Tiles as they stand in the window, on the smallest sheet that holds them.
Bitmap joined(const std::vector<Tile>& tiles);

/// Numbered pictures in a folder of their own, and a video of them where the program ffmpeg is there.
class Recording
{
public:
  /// Makes FOLDER/NAME-001, or the next number that is not taken. Throws Failure.
  Recording(const std::string& folder, const std::string& name);

  void add(const Bitmap& picture);
  /// Makes the video, 25 pictures a second; returns the folder.
  std::string finish();

private:
  std::string Folder;
  int Count = 0;
};

/// Goes back to the time step that was shown, in the end at the latest, where the viewer says so if it
/// cannot be.
class KeptTimeStep
{
public:
  explicit KeptTimeStep(Viewer& viewer);
  ~KeptTimeStep();
  /// Throws what Viewer::go_to_time() does.
  void go_back();
  KeptTimeStep(const KeptTimeStep&) = delete;
  KeptTimeStep& operator=(const KeptTimeStep&) = delete;

private:
  Viewer& View;
  int Step;
  bool Back = false;
};

/// No pause of refinement while it lives; what was paused is paused again.
class NoPause
{
public:
  explicit NoPause(Viewer& viewer);
  ~NoPause();
  NoPause(const NoPause&) = delete;
  NoPause& operator=(const NoPause&) = delete;

private:
  Viewer& View;
  bool Paused;
};

/// Puts a camera back as it was.
class KeptCamera
{
public:
  explicit KeptCamera(vtkCamera* camera);
  ~KeptCamera();
  KeptCamera(const KeptCamera&) = delete;
  KeptCamera& operator=(const KeptCamera&) = delete;

private:
  struct Internals;
  Internals* Internal;
};

}
