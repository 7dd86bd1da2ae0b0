#include "private_display.h"

#include <X11/Xlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <random>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#ifdef __linux__
#include <sys/prctl.h>
#endif

namespace brume::app
{
namespace
{

constexpr const char* protocol = "MIT-MAGIC-COOKIE-1";
constexpr const char* remedy = "install Debian's packages xvfb and libgl1-mesa-dri, or set DISPLAY";

bool can_open(const std::string& name)
{
  Display* display = XOpenDisplay(name.c_str());
  if (display)
  {
    XCloseDisplay(display);
  }
  return display != nullptr;
}

/// Where PATH holds the program, or an empty string.
std::string find_program(const std::string& program)
{
  const char* variable = std::getenv("PATH");
  std::string path = variable ? variable : "/usr/local/bin:/usr/bin:/bin";
  for (std::size_t begin = 0; begin <= path.size();)
  {
    const std::size_t end = std::min(path.find(':', begin), path.size());
    const std::string file = path.substr(begin, end - begin) + "/" + program;
    if (access(file.c_str(), X_OK) == 0)
    {
      return file;
    }
    begin = end + 1;
  }
  return {};
}

/// A file of the X authority format with one key that fits every display. Removed by the destructor:
/// the server reads it at its first client and keeps the key.
class KeyFile
{
public:
  explicit KeyFile(const std::array<char, 16>& key)
  {
    const char* folder = std::getenv("TMPDIR");
    this->Path = std::string(folder && *folder ? folder : "/tmp") + "/brume-display.XXXXXX";
    const int file = mkostemp(this->Path.data(), O_CLOEXEC); // readable by this user alone
    if (file < 0)
    {
      this->Path.clear();
      return;
    }
    // Family "any" (0xffff), no address, no display number, then protocol and key, each after its
    // length in two bytes, the higher first.
    std::string text("\xff\xff\0\0\0\0", 6);
    const auto append = [&text](const char* bytes, std::size_t count) {
      text.push_back(static_cast<char>(count >> 8));
      text.push_back(static_cast<char>(count & 0xff));
      text.append(bytes, count);
    };
    append(protocol, std::strlen(protocol));
    append(key.data(), key.size());
    const bool written = write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    close(file);
    if (!written)
    {
      unlink(this->Path.c_str());
      this->Path.clear();
    }
  }
  ~KeyFile()
  {
    if (!this->Path.empty())
    {
      unlink(this->Path.c_str());
    }
  }
  const std::string& path() const { return this->Path; }

private:
  std::string Path;
};

/// In the child: becomes the server, or ends with 127. Calls nothing that is unsafe after fork().
[[noreturn]] void become(const char* program, char* const* arguments, int number_pipe, pid_t parent)
{
  setpgid(0, 0); // out of reach of the terminal's Ctrl-C
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGTERM);
#endif
  if (getppid() != parent)
  {
    _exit(127); // the parent was gone before the line above
  }
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nothing = open("/dev/null", O_RDWR);
  if (nothing < 0 || dup2(number_pipe, 3) < 0 || dup2(nothing, 0) < 0 || dup2(nothing, 1) < 0 ||
    dup2(nothing, 2) < 0)
  {
    _exit(127);
  }
  if (number_pipe == 3)
  {
    fcntl(3, F_SETFD, 0);
  }
  const long files = sysconf(_SC_OPEN_MAX);
  for (int file = 4; file < files && file < 1024; ++file)
  {
    close(file);
  }
  execv(program, arguments);
  _exit(127);
}

/// What the server writes to the pipe up to the end of the line, or nothing when the time is up or
/// the server has ended.
std::string read_line(int pipe, double seconds)
{
  using clock = std::chrono::steady_clock;
  const auto end = clock::now() + std::chrono::duration<double>(seconds);
  std::string text;
  for (;;)
  {
    const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(end - clock::now()).count();
    pollfd ready{ pipe, POLLIN, 0 };
    const int count = left > 0 ? poll(&ready, 1, static_cast<int>(left)) : 0;
    if (count < 0 && errno == EINTR)
    {
      continue;
    }
    char c = 0;
    if (count <= 0 || read(pipe, &c, 1) != 1)
    {
      return {};
    }
    if (c == '\n')
    {
      return text;
    }
    text.push_back(c);
  }
}

}

PrivateDisplay::PrivateDisplay(double seconds)
{
  if (const char* given = std::getenv("DISPLAY"))
  {
    this->HadDisplay = true;
    this->FormerDisplay = given;
    if (*given && can_open(given))
    {
      this->Available = true;
      this->Name = given;
      return;
    }
  }
  this->start(seconds);
  if (!this->Available)
  {
    this->stop();
    if (this->HadDisplay && !this->FormerDisplay.empty())
    {
      this->Reason =
        "the display " + this->FormerDisplay + " cannot be opened, and " + this->Reason;
    }
  }
}

PrivateDisplay::~PrivateDisplay()
{
  this->stop();
}

void PrivateDisplay::start(double seconds)
{
  const std::string program = find_program("Xvfb");
  if (program.empty())
  {
    this->Reason = std::string("no virtual display server (Xvfb) is installed: ") + remedy;
    return;
  }
  std::array<char, 16> key;
  std::random_device random;
  for (char& c : key)
  {
    c = static_cast<char>(random());
  }
  const KeyFile file(key);
  int ends[2];
  if (file.path().empty() || pipe2(ends, O_CLOEXEC) != 0)
  {
    this->Reason = std::string("the virtual display server could not be prepared (") +
      std::strerror(errno) + "): make room in the temporary folder";
    return;
  }

  // The server chooses a free number by itself and writes it to file 3.
  std::vector<std::string> words = { program, "-displayfd", "3", "-screen", "0", "1280x1024x24",
    "-nolisten", "tcp", "-noreset", "-auth", file.path() };
  std::vector<char*> arguments;
  for (std::string& word : words)
  {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);

  const pid_t self = getpid();
  const pid_t child = fork();
  if (child == 0)
  {
    become(program.c_str(), arguments.data(), ends[1], self);
  }
  const int fork_error = errno;
  close(ends[1]);
  if (child < 0)
  {
    close(ends[0]);
    this->Reason = std::string("the virtual display server could not be started (") +
      std::strerror(fork_error) + "): close other programs";
    return;
  }
  this->Server = child;
  const std::string number = read_line(ends[0], seconds);
  close(ends[0]);
  if (number.empty())
  {
    this->Reason = std::string("the virtual display server did not start: ") + remedy;
    return;
  }

  this->Name = ":" + number;
  XSetAuthorization(const_cast<char*>(protocol), static_cast<int>(std::strlen(protocol)),
    key.data(), static_cast<int>(key.size()));
  if (!can_open(this->Name)) // the first client: the server reads the key
  {
    this->Reason = "the virtual display server " + this->Name + " does not answer: " + remedy;
    return;
  }
  setenv("DISPLAY", this->Name.c_str(), 1);
  this->Available = true;
}

void PrivateDisplay::stop()
{
  if (this->Server <= 0)
  {
    return;
  }
  kill(this->Server, SIGTERM);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  while (waitpid(this->Server, nullptr, WNOHANG) == 0)
  {
    if (std::chrono::steady_clock::now() > end)
    {
      kill(this->Server, SIGKILL);
      waitpid(this->Server, nullptr, 0);
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  this->Server = -1;
  this->Name.clear();
  this->Available = false;
  XSetAuthorization(nullptr, 0, nullptr, 0);
  if (this->HadDisplay)
  {
    setenv("DISPLAY", this->FormerDisplay.c_str(), 1);
  }
  else
  {
    unsetenv("DISPLAY");
  }
}

}
