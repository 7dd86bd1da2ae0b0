#include "../support/files.h"
#include "scan_files.h"

#include "atomic_file.h"

#include <csignal>
#include <stdexcept>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace brume;
using scan_files::folder;
using scan_files::load;
using scan_files::save;

TEST(AtomicFile, CommitReplacesAndKeepsPermissions)
{
  const std::string here = folder();
  const std::string path = save(here + "a.json", "old");
  chmod(path.c_str(), 0640);
  {
    AtomicFile file(path);
    file.write("new", 3);
    EXPECT_EQ(load(path), "old");
    EXPECT_EQ(std::filesystem::path(file.temporary_path()).parent_path().string() + "/", here);
    EXPECT_EQ(std::filesystem::path(file.temporary_path()).extension(), ".json");
    file.commit();
  }
  EXPECT_EQ(load(path), "new");
  struct stat now;
  ASSERT_EQ(stat(path.c_str(), &now), 0);
  EXPECT_EQ(now.st_mode & 0777, 0640u);
  EXPECT_EQ(files_in(here), 1u);
}

TEST(AtomicFile, WithoutCommitNothingChanges)
{
  const std::string here = folder();
  const std::string path = save(here + "a.json", "old");
  EXPECT_THROW(
    {
      AtomicFile file(path);
      file.write("new", 3);
      throw std::logic_error("the work failed");
    },
    std::logic_error);
  EXPECT_EQ(load(path), "old");
  EXPECT_EQ(files_in(here), 1u);
}

TEST(AtomicFile, SignalsLeaveNoDebris)
{
  const std::string here = folder();
  const std::string path = save(here + "a.json", "old");
  for (int signal : { SIGINT, SIGTERM, SIGHUP })
  {
    const pid_t child = fork();
    if (child == 0)
    {
      AtomicFile file(path);
      file.write("new", 3);
      raise(signal);
      _exit(0);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal);
    EXPECT_EQ(load(path), "old");
    EXPECT_EQ(files_in(here), 1u);
  }
}

TEST(AtomicFile, ExitLeavesNoDebris)
{
  // In a process of its own: libraries below have threads, which a fork does not take along, and
  // wait for them as the program exits.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::string here = folder();
  const std::string path = save(here + "a.json", "old");
  EXPECT_EXIT(
    {
      AtomicFile file(path);
      file.write("new", 3);
      std::exit(0); // no destructors of this block
    },
    ::testing::ExitedWithCode(0), "");
  EXPECT_EQ(load(path), "old");
  EXPECT_EQ(files_in(here), 1u);
}

TEST(AtomicFile, LinksAndDevices)
{
  const std::string here = folder();
  const std::string path = save(here + "a.json", "old");
  std::filesystem::create_symlink("a.json", here + "link.json");
  write_atomically(here + "link.json", "new");
  EXPECT_EQ(load(path), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(here + "link.json"));
  write_atomically("/dev/null", "gone");
  EXPECT_FALSE(std::filesystem::is_regular_file("/dev/null"));
  EXPECT_NE(error_of([] { write_atomically("/dev/full", "x"); }).find("free some space"),
    std::string::npos);
}
