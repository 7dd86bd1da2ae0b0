#include "atomic_file.h"

#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace brume
{

namespace fs = std::filesystem;

namespace
{

// A signal handler may neither allocate nor lock: names live in fixed slots, and a slot counts
// only while its state says Used.
enum SlotState
{
  Free,
  Filling,
  Used
};
struct Slot
{
  std::atomic<int> state{ Free };
  char name[PATH_MAX];
};
constexpr int Slots = 32;
Slot slots[Slots];
static_assert(std::atomic<int>::is_always_lock_free, "the signal handler needs it");

extern "C" void remove_and_end(int signal)
{
  remove_temporary_files();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void watch_signals()
{
  static std::once_flag once;
  std::call_once(once,
    []
    {
      std::atexit([] { remove_temporary_files(); });
      for (int signal : { SIGINT, SIGTERM, SIGHUP })
      {
        struct sigaction now;
        if (sigaction(signal, nullptr, &now) == 0 && !(now.sa_flags & SA_SIGINFO) &&
          now.sa_handler == SIG_DFL)
        {
          std::signal(signal, remove_and_end);
        }
      }
    });
}

int take_slot(const std::string& name)
{
  if (name.size() + 1 > PATH_MAX)
  {
    return -1;
  }
  for (int i = 0; i < Slots; ++i)
  {
    int expected = Free;
    if (slots[i].state.compare_exchange_strong(expected, Filling))
    {
      std::memcpy(slots[i].name, name.c_str(), name.size() + 1);
      slots[i].state.store(Used);
      return i;
    }
  }
  return -1; // more files at once than slots: those go without the watch
}

std::string remedy_for(int error)
{
  switch (error)
  {
    case ENOSPC:
    case EDQUOT:
      return "free some space, or write to another disk";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a folder that you may write";
    case ENOENT:
      return "make the folder first";
    case ENAMETOOLONG:
      return "choose a shorter name";
    default:
      return "choose another place";
  }
}

}

void remove_temporary_files() noexcept
{
  for (Slot& slot : slots)
  {
    if (slot.state.load() == Used)
    {
      unlink(slot.name);
    }
  }
}

void AtomicFile::fail(const std::string& doing, int error) const
{
  throw std::runtime_error(path_ + ": " + doing + ": " +
    (error ? std::strerror(error) + std::string(": ") : "") + remedy_for(error));
}

AtomicFile::AtomicFile(const std::string& path)
  : path_(path)
{
  std::error_code error;
  if (path.empty())
  {
    throw std::runtime_error("the output file has no name: name one");
  }
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status) || path.back() == '/')
  {
    throw std::runtime_error(path + ": is a folder: name a file in it");
  }
  if (fs::exists(status) && !fs::is_regular_file(status))
  {
    direct_ = true;
    temporary_ = target_ = path;
    file_ = open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (file_ < 0)
    {
      fail("cannot be written", errno);
    }
    return;
  }
  target_ = fs::is_symlink(fs::symlink_status(path, error))
    ? fs::weakly_canonical(path, error).string()
    : path;
  if (target_.empty())
  {
    target_ = path;
  }
  const fs::path place(target_);
  const fs::path folder = place.has_parent_path() ? place.parent_path() : fs::path(".");
  if (!fs::exists(folder, error))
  {
    throw std::runtime_error(
      path_ + ": the folder " + folder.string() + " does not exist: make the folder first");
  }
  if (fs::exists(status) && access(target_.c_str(), W_OK) != 0)
  {
    fail("may not be replaced", errno);
  }
  watch_signals();
  static std::atomic<unsigned> counter{ 0 };
  for (int attempt = 0; attempt < 100 && file_ < 0; ++attempt)
  {
    // The stem is cut so that a name of full length still has a temporary one.
    const std::string name = "." + place.stem().string().substr(0, 100) + ".part-" +
      std::to_string(getpid()) + "-" + std::to_string(counter++) + place.extension().string();
    temporary_ = (folder / name).string();
    slot_ = take_slot(temporary_);
    file_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file_ < 0)
    {
      const int reason = errno;
      if (slot_ >= 0)
      {
        slots[slot_].state.store(Free);
        slot_ = -1;
      }
      if (reason != EEXIST)
      {
        fail("cannot be written", reason);
      }
    }
  }
  if (file_ < 0)
  {
    fail("cannot be written", EEXIST);
  }
  struct stat old;
  if (stat(target_.c_str(), &old) == 0)
  {
    (void)!fchmod(file_, old.st_mode & 07777);
  }
}

AtomicFile::~AtomicFile()
{
  if (file_ >= 0)
  {
    close(file_);
  }
  if (!direct_ && !temporary_.empty())
  {
    unlink(temporary_.c_str());
  }
  if (slot_ >= 0)
  {
    slots[slot_].state.store(Free);
  }
}

void AtomicFile::write(const void* bytes, std::size_t count)
{
  const char* at = static_cast<const char*>(bytes);
  while (count > 0)
  {
    const ssize_t written = ::write(file_, at, count);
    if (written < 0)
    {
      if (errno == EINTR)
      {
        continue;
      }
      fail("writing failed", errno);
    }
    at += written;
    count -= static_cast<std::size_t>(written);
  }
}

void AtomicFile::commit()
{
  if (direct_)
  {
    const int closed = close(file_);
    file_ = -1;
    if (closed != 0)
    {
      fail("writing failed", errno);
    }
    return;
  }
  // Full disks show at the latest here, before the old file is given up.
  if (fsync(file_) != 0 && errno != EINVAL)
  {
    fail("writing failed", errno);
  }
  const int closed = close(file_);
  file_ = -1;
  if (closed != 0)
  {
    fail("writing failed", errno);
  }
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0)
  {
    fail("cannot be put into its place", errno);
  }
  if (slot_ >= 0)
  {
    slots[slot_].state.store(Free);
    slot_ = -1;
  }
  temporary_.clear();
}

void write_atomically(const std::string& path, const void* bytes, std::size_t count)
{
  AtomicFile file(path);
  file.write(bytes, count);
  file.commit();
}

void write_atomically(const std::string& path, const std::string& text)
{
  write_atomically(path, text.data(), text.size());
}

}
