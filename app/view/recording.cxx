#include "recording.h"

#include "atomic_file.h"
#include "command.h"

#include "vtkCamera.h"
#include "vtkNew.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <spawn.h>
#include <sys/wait.h>

extern char** environ;

namespace brume::app
{

namespace
{

std::string numbered(const std::string& name, int number, const char* format)
{
  char digits[16];
  std::snprintf(digits, sizeof digits, format, number);
  return name + digits;
}

/// Runs a program of the PATH without input or output; whether it went well.
bool run_quietly(std::vector<std::string> words)
{
  std::vector<char*> arguments;
  for (std::string& word : words)
  {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", 0, 0);       // O_RDONLY
  posix_spawn_file_actions_addopen(&files, 1, "/dev/null", 1, 0);       // O_WRONLY
  posix_spawn_file_actions_addopen(&files, 2, "/dev/null", 1, 0);
  pid_t child = -1;
  const int failed =
    posix_spawnp(&child, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  int status = 1;
  return failed == 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) &&
    WEXITSTATUS(status) == 0;
}

}

std::string free_name(
  const std::string& folder, const std::string& name, const std::string& ending)
{
  for (int number = 1;; ++number)
  {
    const std::filesystem::path path =
      std::filesystem::path(folder) / (numbered(name + "-", number, "%03d") + ending);
    if (!std::filesystem::exists(path))
    {
      return path.lexically_normal().string();
    }
  }
}

void save_png(const Bitmap& bitmap, const std::string& path)
{
  const std::vector<unsigned char> bytes = encode_png(bitmap);
  write_atomically(path, bytes.data(), bytes.size());
}

Bitmap joined(const std::vector<Tile>& tiles)
{
  Box all;
  for (const Tile& tile : tiles)
  {
    all.width = std::max(all.width, tile.box.x + tile.box.width);
    all.height = std::max(all.height, tile.box.y + tile.box.height);
  }
  Bitmap sheet{ all.width, all.height, {} };
  sheet.rgb.resize(std::size_t{ 3 } * all.width * all.height);
  for (const Tile& tile : tiles)
  {
    const Box& box = tile.box;
    for (int y = 0; y < box.height; ++y) // from below
    {
      const int row = y * tile.bitmap.height / box.height;
      for (int x = 0; x < box.width; ++x)
      {
        const int column = x * tile.bitmap.width / box.width;
        const unsigned char* in =
          &tile.bitmap.rgb[3 * (std::size_t(row) * tile.bitmap.width + column)];
        std::copy(in, in + 3,
          &sheet.rgb[3 *
            (std::size_t(all.height - box.y - box.height + y) * all.width + box.x + x)]);
      }
    }
  }
  return sheet;
}

Recording::Recording(const std::string& folder, const std::string& name)
  : Folder(free_name(folder, name, ""))
{
  std::error_code error;
  if (!std::filesystem::create_directories(this->Folder, error))
  {
    throw Failure(this->Folder, "the folder cannot be made (" + error.message() + ")",
      "start brume view in a folder that you may write to");
  }
}

void Recording::add(const Bitmap& picture)
{
  save_png(picture,
    (std::filesystem::path(this->Folder) / (numbered("", this->Count++, "%04d") + ".png")).string());
}

std::string Recording::finish()
{
  const std::filesystem::path folder = this->Folder;
  // Video wants even sizes.
  run_quietly({ "ffmpeg", "-n", "-framerate", "25", "-i", (folder / "%04d.png").string(), "-vf",
    "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", this->Folder + ".mp4" });
  return this->Folder;
}

KeptTimeStep::KeptTimeStep(Viewer& viewer)
  : View(viewer)
  , Step(viewer.volume_scene().input.time_step)
{
}

void KeptTimeStep::go_back()
{
  this->Back = true; // or it was tried
  this->View.go_to_time(this->Step);
}

KeptTimeStep::~KeptTimeStep()
{
  try
  {
    if (!this->Back)
    {
      this->go_back();
    }
  }
  catch (const std::exception& failure)
  {
    this->View.say(failure.what());
  }
}

NoPause::NoPause(Viewer& viewer)
  : View(viewer)
  , Paused(viewer.paused())
{
  if (this->Paused)
  {
    this->View.pause(false);
  }
}

NoPause::~NoPause()
{
  if (this->Paused)
  {
    this->View.pause(true);
  }
}

struct KeptCamera::Internals
{
  vtkCamera* Camera = nullptr;
  vtkNew<vtkCamera> Copy;
};

KeptCamera::KeptCamera(vtkCamera* camera)
  : Internal(new Internals)
{
  this->Internal->Camera = camera;
  this->Internal->Copy->DeepCopy(camera);
}

KeptCamera::~KeptCamera()
{
  this->Internal->Camera->DeepCopy(this->Internal->Copy);
  delete this->Internal;
}

}
