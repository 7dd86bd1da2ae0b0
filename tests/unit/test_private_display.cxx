// The display that the program makes for itself.
#include "private_display.h"

#include <gtest/gtest.h>

#include <X11/Xlib.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <string>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

using brume::app::PrivateDisplay;

namespace
{

/// Sets a variable for one test and puts it back.
class Variable
{
public:
  Variable(const char* name, const char* value)
    : Name(name)
    , Had(std::getenv(name) != nullptr)
    , Former(this->Had ? std::getenv(name) : "")
  {
    value ? setenv(name, value, 1) : unsetenv(name);
  }
  ~Variable() { this->Had ? setenv(this->Name, this->Former.c_str(), 1) : unsetenv(this->Name); }

private:
  const char* Name;
  bool Had;
  std::string Former;
};

bool opens(const std::string& name)
{
  Display* display = XOpenDisplay(name.c_str());
  if (display)
  {
    XCloseDisplay(display);
  }
  return display != nullptr;
}

}

#define NEED_SERVER(display)                                                                       \
  if (!(display).available())                                                                      \
  {                                                                                                \
    GTEST_SKIP() << (display).reason();                                                            \
  }

TEST(PrivateDisplay, StartsAServerAndEndsIt)
{
  Variable none("DISPLAY", nullptr);
  std::string name;
  {
    PrivateDisplay display;
    NEED_SERVER(display);
    EXPECT_TRUE(display.is_private());
    EXPECT_TRUE(display.reason().empty());
    name = display.name();
    EXPECT_EQ(name, std::getenv("DISPLAY"));
    for (int i = 0; i < 3; ++i) // the server outlives its clients
    {
      EXPECT_TRUE(opens(name));
    }
  }
  EXPECT_EQ(nullptr, std::getenv("DISPLAY"));
  EXPECT_FALSE(opens(name));
  errno = 0;
  EXPECT_EQ(-1, waitpid(-1, nullptr, WNOHANG));
  EXPECT_EQ(ECHILD, errno) << "a process is left over";
}

TEST(PrivateDisplay, TakesADisplayThatAnswers)
{
  Variable none("DISPLAY", nullptr);
  PrivateDisplay first;
  NEED_SERVER(first);
  PrivateDisplay second;
  EXPECT_TRUE(second.available());
  EXPECT_FALSE(second.is_private());
  EXPECT_EQ(first.name(), second.name());
}

TEST(PrivateDisplay, PassesOverADisplayThatDoesNotAnswer)
{
  Variable dead("DISPLAY", ":9999");
  {
    PrivateDisplay display;
    NEED_SERVER(display);
    EXPECT_TRUE(display.is_private());
    EXPECT_NE(":9999", display.name());
  }
  EXPECT_STREQ(":9999", std::getenv("DISPLAY"));
}

TEST(PrivateDisplay, LetsNobodyInWithoutTheKey)
{
  Variable none("DISPLAY", nullptr);
  PrivateDisplay display;
  NEED_SERVER(display);
  // A fresh process has no key: it starts over as this program with the probe alone.
  const pid_t child = fork();
  if (child == 0)
  {
    setenv("BRUME_PROBE_DISPLAY", display.name().c_str(), 1);
    execl("/proc/self/exe", "probe", "--gtest_also_run_disabled_tests",
      "--gtest_filter=PrivateDisplay.DISABLED_Probe", static_cast<char*>(nullptr));
    _exit(99);
  }
  int status = 0;
  ASSERT_EQ(child, waitpid(child, &status, 0));
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(0, WEXITSTATUS(status)) << "a stranger could open the display";
  EXPECT_TRUE(opens(display.name()));
}

// Run by the test above in a process of its own: passes when the display cannot be opened.
TEST(PrivateDisplay, DISABLED_Probe)
{
  const char* name = std::getenv("BRUME_PROBE_DISPLAY");
  ASSERT_NE(nullptr, name);
  EXPECT_FALSE(opens(name));
}

/// The process that answers for a display; 0: none does.
pid_t server_of(const std::string& display)
{
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = "/tmp/.X11-unix/X" + display.substr(1);
  std::copy_n(path.c_str(), std::min(path.size() + 1, sizeof address.sun_path), address.sun_path);
  const int end = socket(AF_UNIX, SOCK_STREAM, 0);
  ucred server{};
  socklen_t size = sizeof server;
  const bool answers =
    connect(end, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
    getsockopt(end, SOL_SOCKET, SO_PEERCRED, &server, &size) == 0;
  close(end);
  return answers ? server.pid : 0;
}

TEST(PrivateDisplay, EndsWithAProcessThatIsKilled)
{
  Variable none("DISPLAY", nullptr);
  int ends[2];
  ASSERT_EQ(0, pipe(ends));
  const pid_t child = fork();
  if (child == 0)
  {
    PrivateDisplay display;
    const std::string name = display.available() ? display.name() : "none";
    if (write(ends[1], name.c_str(), name.size() + 1) < 0)
    {
      _exit(1);
    }
    pause();
    _exit(0);
  }
  close(ends[1]);
  char name[64] = "";
  ASSERT_GT(read(ends[0], name, sizeof name - 1), 0);
  close(ends[0]);
  const pid_t server = server_of(name);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  if (std::string(name) == "none")
  {
    GTEST_SKIP() << "no virtual display can be had here";
  }
  ASSERT_GT(server, 0);
  bool gone = false;
  for (int i = 0; i < 3000 && !gone; ++i)
  {
    usleep(10000);
    gone = server_of(name) != server; // another one may have taken its number
  }
  EXPECT_TRUE(gone) << name << " is still there";
}

TEST(PrivateDisplay, SaysWhatToInstall)
{
  Variable none("DISPLAY", nullptr);
  Variable path("PATH", "/nonexistent");
  PrivateDisplay display;
  EXPECT_FALSE(display.available());
  EXPECT_FALSE(display.is_private());
  EXPECT_NE(std::string::npos, display.reason().find("xvfb")) << display.reason();
  EXPECT_EQ(nullptr, std::getenv("DISPLAY"));
}

TEST(PrivateDisplay, GivesUpOnAServerThatDoesNotStart)
{
  Variable none("DISPLAY", nullptr);
  // A server that never says its number: sleep, under the name of Xvfb.
  const std::string folder = std::string(BRUME_TEST_OUTPUT) + "/mute-server";
  ASSERT_EQ(0, std::system(("mkdir -p '" + folder + "' && printf '#!/bin/sh\\nexec sleep 60\\n' > '" +
    folder + "/Xvfb' && chmod +x '" + folder + "/Xvfb'").c_str()));
  const std::string with_mute = folder + ":" + std::getenv("PATH");
  Variable path("PATH", with_mute.c_str());
  PrivateDisplay display(0.3);
  EXPECT_FALSE(display.available());
  EXPECT_NE(std::string::npos, display.reason().find("did not start")) << display.reason();
  errno = 0;
  EXPECT_EQ(-1, waitpid(-1, nullptr, WNOHANG));
}
