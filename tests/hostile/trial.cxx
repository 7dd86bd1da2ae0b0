#include "trial.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#if defined(__SANITIZE_ADDRESS__)
// GCC brings the functions, and not their headers.
extern "C" int __sanitizer_install_malloc_and_free_hooks(
  void (*)(const volatile void*, std::size_t), void (*)(const volatile void*));
extern "C" void __sanitizer_set_report_fd(void*);
extern "C" void __sanitizer_print_stack_trace();

// The runtime's own habits: it must tell a request that is too large by failing, as malloc does, and
// keep little of what was freed.
extern "C" __attribute__((visibility("default"))) const char* __asan_default_options()
{
  return "allocator_may_return_null=1:quarantine_size_mb=16:detect_leaks=1";
}
#endif

namespace hostile
{

namespace fs = std::filesystem;

namespace
{

std::atomic<std::size_t> largest{ 0 };

#if defined(__SANITIZE_ADDRESS__)
// Standard streams, tables and headers are small things.
constexpr std::size_t largest_allowed = std::size_t(memory_limit) + (1u << 20);

void on_malloc(const volatile void*, std::size_t size)
{
  std::size_t before = largest.load();
  while (size > before && !largest.compare_exchange_weak(before, size))
  {
  }
  if (size > before && size >= largest_allowed)
  {
    __sanitizer_print_stack_trace(); // by whom
  }
}
void on_free(const volatile void*) {}
#endif

char where[512]; // the case at work, for the handler

void too_late(int)
{
  const char text[] = "a hostile file takes more than 10 s: ";
  (void)!write(3, text, sizeof(text) - 1);
  (void)!write(3, where, std::strlen(where));
  (void)!write(3, "\n", 1);
  _exit(3);
}

/// Ends the process after so many seconds of processor time, which a busy machine does not stretch.
void watch(int seconds)
{
  const itimerval limit{ { 0, 0 }, { seconds, 0 } };
  setitimer(ITIMER_PROF, &limit, nullptr);
}

std::string folder_of_test()
{
  const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::string path = std::string(BRUME_TEST_OUTPUT) + "/" + test->test_suite_name() + "-" + test->name();
  fs::remove_all(path);
  fs::create_directories(path + "/files");
  return path;
}

void save(const std::string& folder, const Files& files)
{
  for (const auto& [name, bytes] : files)
  {
    std::ofstream(folder + "/" + name, std::ios::binary) << bytes;
  }
}

/// Standard error into a file while it lives; fd 3 is what it was.
class Silence
{
public:
  explicit Silence(const std::string& path)
    : path_(path)
  {
    std::fflush(stderr);
    dup2(2, 3);
    const int file = open(path.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0644);
    dup2(file, 2);
    close(file);
#if defined(__SANITIZE_ADDRESS__)
    __sanitizer_set_report_fd(reinterpret_cast<void*>(3));
#endif
  }
  ~Silence()
  {
    std::fflush(stderr);
    dup2(3, 2);
#if defined(__SANITIZE_ADDRESS__)
    __sanitizer_set_report_fd(reinterpret_cast<void*>(2));
#endif
  }
  std::string heard() const
  {
    std::fflush(stderr);
    std::ifstream file(path_);
    return { std::istreambuf_iterator<char>(file), {} };
  }

private:
  std::string path_;
};

/// Megabytes of this process's memory: "VmRSS:" now, "VmHWM:" at the most since forget_peak().
double megabytes(const std::string& which)
{
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
  {
    if (line.compare(0, which.size(), which) == 0)
    {
      return std::atof(line.c_str() + which.size()) / 1024;
    }
  }
  return 0;
}

void forget_peak()
{
  std::ofstream("/proc/self/clear_refs") << "5";
}

bool is_clear(const std::string& error, const std::string& folder)
{
  const std::size_t place = error.find(": ");
  return error.compare(0, folder.size(), folder) == 0 && error.find('\n') == std::string::npos &&
    place != std::string::npos && error.find(": ", place + 2) != std::string::npos &&
    error.size() < 1000 + folder.size() * 3;
}

}

int files_of_each_reader(int usual)
{
  const char* text = std::getenv("BRUME_HOSTILE_FILES");
#ifdef __SANITIZE_ADDRESS__
  usual = (usual + 3) / 4; // each takes many times as long
#endif
  return text ? std::atoi(text) : usual;
}

void try_reader(const std::vector<Example>& examples, const Read& read, int usual)
{
  const std::string folder = folder_of_test();
  const std::string files = folder + "/files";
  const char* first_text = std::getenv("BRUME_HOSTILE_FIRST");
  const int first = first_text ? std::atoi(first_text) : 0;
  const Silence silence(folder + "/standard-error");
  for (const Example& example : examples)
  {
    save(files, example.files);
    ASSERT_EQ(read(files + "/" + example.name), "") << example.name;
    fs::remove_all(files);
    fs::create_directories(files);
  }
#if defined(__SANITIZE_ADDRESS__)
  static const int hooked = __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free);
  ASSERT_NE(hooked, 0);
#endif
  std::signal(SIGPROF, too_late);
  std::signal(SIGALRM, too_late);
  largest = 0;
  double most_held = 0;
  const int count = files_of_each_reader(usual);
  int whole = 0;
  double slowest = 0;
  int slowest_number = 0;
  for (int number = first; number < first + count; ++number)
  {
    const Example& example = examples[static_cast<std::size_t>(number) % examples.size()];
    const Example damaged = mutated(example, examples, static_cast<std::uint64_t>(number));
    save(files, damaged.files);
    const std::string path = damaged.name == "." ? files : files + "/" + damaged.name;
    std::snprintf(where, sizeof(where), "%s, number %d", path.c_str(), number);
    std::ofstream(folder + "/number") << number << '\n';
    const auto start = std::chrono::steady_clock::now();
    forget_peak();
    const double held_before = megabytes("VmRSS:");
    watch(10);
    alarm(300);
    const std::string error = read(path);
    watch(0);
    alarm(0);
    most_held = std::max(most_held, megabytes("VmHWM:") - held_before);
    const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (seconds > slowest)
    {
      slowest = seconds;
      slowest_number = number;
    }
    whole += error.empty();
    ASSERT_TRUE(error.empty() || is_clear(error, files)) << "number " << number << ": " << error;
    ASSERT_EQ(error.find("not memory enough"), std::string::npos)
      << "number " << number << ": " << error;
#if defined(__SANITIZE_ADDRESS__)
    ASSERT_LT(largest.load(), largest_allowed) << "number " << number;
#endif
    for (const auto& entry : fs::directory_iterator(files))
    {
      fs::remove(entry.path());
    }
  }
  std::printf("%d files: %d read, %d refused; slowest %.3f s (number %d); largest allocation %.1f MB; "
              "%.0f MB at the most for one\n",
    count, whole, count - whole, slowest, slowest_number, static_cast<double>(largest.load()) / 1e6,
    most_held);
  EXPECT_LT(most_held, 4.0 * memory_limit / (1 << 20) + 64) << "what was held at once";
  EXPECT_EQ(silence.heard(), "");
}

}
