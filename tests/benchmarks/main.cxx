// The benchmarks as one program: Google Benchmark registers, filters and repeats the rows, and can
// write its own JSON (--benchmark_out=FILE); the table is made of what it reports.
#include "rows.h"

#include "command.h"
#include "machine.h"
#include "private_display.h"

#include <CLI/CLI.hpp>
#include <benchmark/benchmark.h>

#include "vtkObject.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <thread>

namespace
{

using benchmarks::Repetition;
using benchmarks::Row;

/// Processes that wanted to run, on average over the last minute: times count only where they are
/// few.
double load_average()
{
  double load = 0.0;
  return getloadavg(&load, 1) == 1 ? load : -1.0;
}

/// One repetition of a row, in Google Benchmark's words.
void run(benchmark::State& state, Row& row, bool& prepared)
{
  try
  {
    if (!prepared)
    {
      prepared = true;
      std::cerr << "== " << row.number << ": " << row.what << std::endl;
      row.prepare(row);
    }
    if (!row.skipped.empty())
    {
      state.SkipWithError(row.skipped.c_str());
      return;
    }
    for (auto _ : state)
    {
      if (row.repeat)
      {
        row.measured.push_back(row.repeat());
      }
      state.SetIterationTime(row.measured.back().seconds);
    }
    state.counters["figure"] = row.measured.back().figure;
    state.counters["other_seconds"] = row.measured.back().other;
    return;
  }
  catch (const benchmarks::Skipped& reason)
  {
    row.skipped = reason.what();
  }
  catch (const std::exception& error)
  {
    row.skipped = error.what();
    row.failed = true;
  }
  state.SkipWithError(row.skipped.c_str());
}

/// Lets go of a row's volumes once it is through, and tells its figure alone: the table comes last.
class Quiet : public benchmark::BenchmarkReporter
{
public:
  explicit Quiet(std::vector<Row>& rows)
    : Rows(rows)
  {
  }
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override
  {
    for (Row& row : this->Rows)
    {
      if (row.name == runs.front().run_name.function_name)
      {
        if (row.has_figure())
        {
          std::cerr << "   " << row.figure() << ' ' << row.unit << std::endl;
        }
        row.prepare = nullptr;
        row.repeat = nullptr;
      }
    }
  }

private:
  std::vector<Row>& Rows;
};

}

int main(int argc, char** argv)
{
  benchmarks::Options options;
  std::string json;
  std::string filter = ".";
  bool list = false;
  CLI::App program{ "Brume's benchmarks: one table of figures, each beside its target." };
  program.name("brume-benchmarks");
  program.add_option("--json", json, "Write the table to this file, too");
  program.add_option("--filter", filter, "Only rows whose name matches this regular expression");
  program.add_flag("--list", list, "Print the rows' names and end");
  program.add_flag("--quick", options.quick, "Small and once: does it run at all");
  program.add_option("--repetitions", options.repetitions, "Pairs of renders a row; odd is best")
    ->check(CLI::Range(1, 1000))
    ->capture_default_str();
  program.add_option("--threads", options.threads, "Threads of either mapper")
    ->check(CLI::Range(1, 1024))
    ->capture_default_str();
  program.add_option("--brain", options.brain, "The brain scan (scripts/fetch-brain)");
  std::vector<char*> own; // what is not Google Benchmark's
  std::vector<char*> others{ argv[0] };
  for (int i = 0; i < argc; ++i)
  {
    const bool googles = std::string(argv[i]).rfind("--benchmark_", 0) == 0;
    (googles ? others : own).push_back(argv[i]);
  }
  CLI11_PARSE(program, static_cast<int>(own.size()), own.data());
  if (options.quick)
  {
    options.resolution = 64;
    options.repetitions = 1;
  }
  int other_count = static_cast<int>(others.size());
  benchmark::Initialize(&other_count, others.data());

  const brume::app::PrivateDisplay display;
  options.no_display = display.available() ? "" : display.reason();
  benchmarks::Scenes scenes(options);
  std::vector<Row> rows;
  benchmarks::add_render_rows(scenes, rows);
  benchmarks::add_machine_rows(scenes, rows);
  benchmarks::add_memory_rows(scenes, rows);
  benchmarks::add_light_rows(scenes, rows);
  benchmarks::add_effect_rows(scenes, rows);
  benchmarks::add_generator_rows(scenes, rows);
  benchmarks::add_view_rows(scenes, rows);
  if (list)
  {
    for (const Row& row : rows)
    {
      std::cout << row.name << '\n';
    }
    return 0;
  }
  std::vector<char> prepared(rows.size(), 0);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    benchmark::RegisterBenchmark(rows[i].name.c_str(),
      [&, i](benchmark::State& state)
      {
        bool done = prepared[i];
        prepared[i] = 1;
        run(state, rows[i], done);
      })
      ->UseManualTime()
      ->Iterations(1)
      ->Repetitions(rows[i].repetitions)
      ->Unit(benchmark::kMillisecond);
  }
  const double load_before = load_average();
  Quiet quiet(rows);
  const std::size_t ran = benchmark::RunSpecifiedBenchmarks(&quiet, filter);
  benchmark::Shutdown();
  if (ran == 0)
  {
    std::cerr << "brume-benchmarks: --filter: no row matches " << filter << ": see --list\n";
    return 2;
  }

  std::vector<Row> told;
  bool failed = false;
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    if (prepared[i])
    {
      told.push_back(rows[i]);
      failed = failed || rows[i].failed;
      if (options.quick && !rows[i].skipped.empty() && !rows[i].failed)
      {
        std::cout << "skipped: " << rows[i].name << ": " << rows[i].skipped << '\n';
      }
    }
  }
  const brume::Machine machine = brume::app::this_machine(options.threads, {});
  const double load_after = load_average();
  char loads[80];
  std::snprintf(loads, sizeof(loads), "%.2g before and %.2g after", load_before, load_after);
  std::cout << machine.cpu << ", " << std::thread::hardware_concurrency() << " processors, "
            << options.threads << " threads, " << options.resolution << "² pixels, "
            << machine.vtk_version << "; load average " << loads << ".\n\n"
            << benchmarks::to_text(told) << std::flush;
  if (!json.empty())
  {
    nlohmann::json all{ { "date", brume::app::utc_now() },
      { "quick", options.quick },
      { "threads", options.threads },
      { "resolution", options.resolution },
      { "processor", machine.cpu },
      { "vtk", machine.vtk_version },
      { "processors", std::thread::hardware_concurrency() },
      { "load_average", { { "before", load_before }, { "after", load_after } } },
      { "rows", benchmarks::to_json(told) } };
    std::ofstream file(json);
    file << all.dump(2) << '\n';
    if (!file.flush())
    {
      std::cerr << "brume-benchmarks: " << json << ": it cannot be written: name another file\n";
      return 1;
    }
  }
  return failed ? 1 : 0;
}
