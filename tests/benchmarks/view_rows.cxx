// The window of `brume view`: how soon it shows something, and how soon it answers.
#include "rows.h"

#include "../support/view_windows.h"

#include "scene_file.h"
#include "view/view_window.h"

#include <algorithm>
#include <chrono>
#include <memory>

namespace benchmarks
{

namespace
{

using Clock = std::chrono::steady_clock;
using brume::app::MapperKind;
using nlohmann::ordered_json;

double seconds_since(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A scene and the mappers that show it.
struct Look
{
  std::string name;
  std::string words;
  std::function<ordered_json()> scene; ///< throws Skipped
  std::vector<MapperKind> mappers;
};

/// What one window took from its opening to its last picture.
struct Turn
{
  double first_picture = 0.0;
  double median = 0.0;        ///< from an event to its picture on the window
  double percentile_95 = 0.0; ///< the same
  double frames_a_second = 0.0;
  double deaf = 0.0;  ///< longest time in which a refinement did not look for input
  double whole = 0.0; ///< until all pictures were finished, after the turn
};

/// Opens a window, plays a turn of 60 moves of the mouse, each of which is answered before the
/// next, and refines the last picture.
Turn turn(const Options& options, const Look& look)
{
  // 640² a viewport, with the panel and captions
  const int edge = options.quick ? 320 : 640;
  const int columns = static_cast<int>(look.mappers.size());
  const int panel = options.quick ? 0 : 260;
  const int caption = 24;
  ordered_json scene = look.scene();
  scene["quiet"] = true;
  scene["threads"] = options.threads;
  const auto start = Clock::now();
  brume::app::Viewer::Settings settings;
  settings.mappers = look.mappers;
  settings.window = { columns * edge + panel, edge + caption };
  settings.panel = panel > 0;
  brume::app::Viewer viewer(scene, settings);
  brume::app::ViewWindow::Settings place;
  place.width = settings.window[0];
  place.height = settings.window[1];
  place.start = start;
  brume::app::ViewWindow window(viewer, place);
  const std::size_t before = window.times().responses.size();
  const auto played = Clock::now();
  window.play(BRUME_TEST_DATA "/view/turn-60.log");
  const double seconds = seconds_since(played);
  const auto settling = Clock::now();
  window.settle();
  const brume::app::ViewTimes& times = window.times();
  std::vector<double> responses(
    times.responses.begin() + static_cast<std::ptrdiff_t>(before), times.responses.end());
  if (responses.size() < 30)
  {
    throw std::runtime_error("the recording did not turn the camera");
  }
  std::sort(responses.begin(), responses.end());
  Turn turn;
  turn.first_picture = times.first_picture;
  turn.median = median(responses);
  turn.percentile_95 = responses[responses.size() * 95 / 100];
  turn.frames_a_second = static_cast<double>(responses.size()) / seconds;
  turn.deaf = *std::max_element(times.longest_deaf.begin(), times.longest_deaf.end());
  turn.whole = seconds_since(settling);
  return turn;
}

struct Asked
{
  const char* name;
  const char* words;
  const char* unit;
  double target;
  bool at_least;
  double Turn::*value;
  double scale;
};

constexpr Asked asked[] = {
  { "first", "first picture", "s", 1.5, false, &Turn::first_picture, 1.0 },
  { "median", "an event to its picture, median", "ms", 100.0, false, &Turn::median, 1e3 },
  { "late", "an event to its picture, 95 %", "ms", 100.0, false, &Turn::percentile_95, 1e3 },
  { "frames", "pictures a second while it turns", "", 15.0, true, &Turn::frames_a_second, 1.0 },
  { "deaf", "longest time without a look at input", "ms", 50.0, false, &Turn::deaf, 1e3 },
};

}

void add_view_rows(Scenes& scenes, std::vector<Row>& rows)
{
  const Options& options = scenes.options();
  const auto ball = [] { return view_windows::ball_file(BRUME_TEST_OUTPUT "/view-rows.nrrd"); };
  const auto brain = [&options, ball]() -> ordered_json
  {
    if (options.quick)
    {
      return { { "input", ball() }, { "preset", "grey" }, { "tolerance", 0.05 } };
    }
    if (options.brain.empty())
    {
      throw Skipped("there is no brain scan: scripts/fetch-brain");
    }
    return { { "input", options.brain }, { "preset", "mr-brain" } };
  };
  const auto cloud = [&options, ball]() -> ordered_json
  {
    ordered_json scene{ { "input", options.quick ? ball() : "sample:cloud" },
      { "extinction", 0.05 },
      { "sun-direction", { -1.0, -0.4, 0.6 } } };
    if (options.quick)
    {
      scene["extinction"] = 0.002;
      scene["tolerance"] = 0.05;
    }
    return scene;
  };
  const auto paths = [cloud]
  {
    ordered_json scene = cloud();
    scene["samples-per-pixel"] = 16; // paths begin and go on once
    return scene;
  };
  const std::vector<Look> looks{
    { "brain", "brain scan", brain, { MapperKind::RayMarch } },
    { "beside",
      "brain scan beside VTK's CPU mapper",
      brain,
      { MapperKind::RayMarch, MapperKind::FixedPoint } },
    { "cloud", "cloud in the sun", cloud, { MapperKind::RayMarch } },
    { "paths", "cloud in the sun, paths", paths, { MapperKind::PathTrace } },
  };
  for (const Look& look : looks)
  {
    // One window's times are the figures of all its rows.
    const auto turns = std::make_shared<std::vector<Turn>>();
    for (const Asked& one : asked)
    {
      Row row;
      row.number = 16;
      row.name = "window-" + look.name + "-" + one.name;
      row.what = "window, " + look.words + ", 640²: " + one.words;
      row.unit = one.unit;
      row.target = one.target;
      row.at_least = one.at_least;
      row.repetitions = options.quick ? 1 : 3;
      const auto next = std::make_shared<std::size_t>(0);
      row.prepare = [&options](Row&)
      {
        if (!options.no_display.empty())
        {
          throw Skipped(options.no_display);
        }
      };
      row.repeat = [&options, look, turns, one, next]
      {
        if (*next == turns->size())
        {
          turns->push_back(turn(options, look));
        }
        const Turn& measured = (*turns)[(*next)++];
        Repetition repetition;
        repetition.figure = one.scale * (measured.*one.value);
        if (one.value == &Turn::deaf)
        {
          repetition.seconds = measured.whole;
        }
        return repetition;
      };
      rows.push_back(row);
    }
  }
}

}
