// What the window of `brume view` looks like after recorded input, against pictures that were
// looked at: tests/baselines/view. BRUME_UPDATE_BASELINES=1 writes them anew.
#include "../support/view_windows.h"

#include "command.h"

#include "scene_file.h"
#include "view/recording.h"

#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPNGReader.h"
#include "vtkPointData.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

using namespace brume::app;
using namespace view_windows;
using brume::Bitmap;

namespace
{

/// A window, and what was done to it.
struct Case
{
  std::string name;
  int width = 620;
  int height = 400;
  double scale = 1.0;
  std::vector<MapperKind> mappers{ MapperKind::RayMarch };
  bool density = false;  ///< the ball's values as an extinction, else by a preset
  std::string recording; ///< below tests/data/view; empty for none
};

std::ostream& operator<<(std::ostream& stream, const Case& one)
{
  return stream << one.name;
}

const std::vector<MapperKind> both{ MapperKind::RayMarch, MapperKind::FixedPoint };

const std::vector<Case>& cases()
{
  static const std::vector<Case> all{
    { "side-by-side", 620, 400, 1.0, both, false, "turn" },
    { "side-by-side-light", 800, 600, 2.0, both, false, "light-background" },
    { "wipe", 620, 400, 1.0, both, false, "wipe" },
    { "difference", 620, 400, 1.0, both, false, "difference" },
    { "help", 620, 400, 1.0, {}, false, "help" },
    { "help-large", 800, 600, 2.0, {}, false, "help" },
    { "crop", 620, 400, 1.0, {}, false, "crop" },
    { "light-page", 620, 400, 1.0, {}, true, "sun" },
    { "light-page-large", 800, 600, 2.0, {}, true, "sun-scrolled" },
    { "colour-picker", 620, 560, 1.0, {}, true, "colour" },
    { "matter-page", 620, 560, 1.0, {}, true, "matter" },
    { "look-page", 620, 560, 1.0, {}, false, "look" },
    { "plan-page", 620, 400, 1.0, {}, true, "plan" },
  };
  return all;
}

ordered_json scene_of(const Case& one)
{
  ordered_json scene{ { "input", ball_file(BRUME_TEST_OUTPUT "/view-window-pictures.nrrd") },
    { "quiet", true } };
  if (one.density)
  {
    scene["extinction"] = 0.002;
    scene["exposure"] = 2.5;
  }
  else
  {
    scene["preset"] = "grey";
  }
  return scene;
}

/// The window after its recording, with all pictures finished; `change` may alter the scene before.
Bitmap drawn(const Case& one,
  const std::function<void(ordered_json&, Viewer::Settings&)>& change = {})
{
  Viewer::Settings settings;
  if (!one.mappers.empty())
  {
    settings.mappers = one.mappers;
  }
  settings.window = { one.width, one.height };
  settings.scale = one.scale;
  settings.times = false; // no two pictures take the same
  settings.more_keys = ViewWindow::keys();
  ordered_json scene = scene_of(one);
  if (change)
  {
    change(scene, settings);
  }
  Viewer viewer(scene, settings);
  ViewWindow::Settings place;
  place.width = one.width;
  place.height = one.height;
  place.folder = BRUME_TEST_OUTPUT;
  place.failed = [](const std::exception& error) { ADD_FAILURE() << error.what(); };
  ViewWindow window(viewer, place);
  if (!one.recording.empty())
  {
    window.play(std::string(BRUME_TEST_DATA "/view/") + one.recording + ".log");
  }
  window.settle();
  return pixels_of(window.window());
}

Bitmap read(const std::string& path)
{
  vtkNew<vtkPNGReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  const int* size = image->GetDimensions();
  Bitmap bitmap{ size[0], size[1], {} };
  const auto* bytes = static_cast<const unsigned char*>(image->GetScalarPointer());
  bitmap.rgb.assign(bytes, bytes + std::size_t{ 3 } * size[0] * size[1]);
  return bitmap;
}

/// The largest difference of the mean of a square block of pixels, of 255, in the worst channel.
double worst_block(const Bitmap& a, const Bitmap& b, int edge)
{
  double worst = 0.0;
  for (int y = 0; y < a.height; y += edge)
  {
    for (int x = 0; x < a.width; x += edge)
    {
      double sums[3] = { 0.0, 0.0, 0.0 };
      int count = 0;
      for (int j = y; j < std::min(y + edge, a.height); ++j)
      {
        for (int i = x; i < std::min(x + edge, a.width); ++i, ++count)
        {
          for (int c = 0; c < 3; ++c)
          {
            const std::size_t at = 3 * (std::size_t(j) * a.width + i) + c;
            sums[c] += double(a.rgb[at]) - double(b.rgb[at]);
          }
        }
      }
      for (const double sum : sums)
      {
        worst = std::max(worst, std::abs(sum) / count);
      }
    }
  }
  return worst;
}

/// Lettering may stand a pixel aside with another FreeType, and lines of VTK's tools may be drawn
/// otherwise: that evens out in blocks. What moves, vanishes or changes colour does not.
struct Blocks
{
  int edge;
  double most; ///< of 255
};
constexpr Blocks blocks[] = { { 8, 40.0 }, { 32, 5.0 } };

bool same(const Bitmap& a, const Bitmap& b)
{
  return a.width == b.width && a.height == b.height &&
         std::all_of(std::begin(blocks),
           std::end(blocks),
           [&](const Blocks& block) { return worst_block(a, b, block.edge) <= block.most; });
}

std::string file_of(const Case& one)
{
  return std::string(BRUME_TEST_BASELINES "/view/") + one.name + ".png";
}

class ViewWindowPicture : public testing::TestWithParam<Case>
{
};

}

TEST_P(ViewWindowPicture, IsTheOneThatWasLookedAt)
{
  const Case& one = GetParam();
  const Complaints complaints;
  const Bitmap now = drawn(one);
  EXPECT_EQ(complaints.text(), "");
  if (std::getenv("BRUME_UPDATE_BASELINES"))
  {
    save_png(now, file_of(one));
    return;
  }
  ASSERT_TRUE(std::filesystem::exists(file_of(one)));
  const Bitmap before = read(file_of(one));
  ASSERT_EQ(before.width, now.width);
  ASSERT_EQ(before.height, now.height);
  for (const Blocks& block : blocks)
  {
    const double worst = worst_block(before, now, block.edge);
    std::cout << "blocks of " << block.edge << "²: worst " << worst << " of " << block.most << '\n';
    EXPECT_LE(worst, block.most);
  }
  if (HasFailure())
  {
    const std::string path = std::string(BRUME_TEST_OUTPUT "/view-") + one.name + ".png";
    save_png(now, path);
    std::cout << "what is shown now: " << path << '\n';
  }
}

// VTK's renderers take over from what was in their memory before them whether their aspect is
// known.
TEST(ViewWindowStock, PicturesAreNotStretchedByThoseBefore)
{
  ordered_json scene = scene_of({});
  scene["resolution"] = { 200, 120 };
  const ParsedScene parsed(scene);
  const VolumeScene volume = make_volume_scene(parsed.options());
  const KeepGoing go = [](double) { return true; };
  std::vector<float> first;
  for (int i = 0; i < 40; ++i)
  {
    const std::unique_ptr<Painter> painter = make_painter(MapperKind::FixedPoint);
    painter->set_scene(volume);
    painter->draft(200, 120, 0.04, go);
    ASSERT_TRUE(painter->refine(200, 120, go));
    const std::vector<float>& now = painter->shot().picture.rgb;
    first = first.empty() ? now : first;
    ASSERT_EQ(now, first) << "picture " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Pictures,
  ViewWindowPicture,
  testing::ValuesIn(cases()),
  [](const testing::TestParamInfo<Case>& info)
  {
    std::string name = info.param.name;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
  });

// The blocks can fail.
class ViewWindowFault : public testing::Test
{
protected:
  const Case& one = cases().front();
  const Bitmap right = drawn(this->one);
};

TEST_F(ViewWindowFault, AMirroredPictureIsSeen)
{
  Bitmap mirrored = this->right;
  const int width = (this->one.width - 260) / 2; // the first viewport
  for (int y = 0; y < mirrored.height; ++y)
  {
    for (int x = 0; x < width / 2; ++x)
    {
      for (int c = 0; c < 3; ++c)
      {
        std::swap(mirrored.rgb[3 * (std::size_t(y) * mirrored.width + x) + c],
          mirrored.rgb[3 * (std::size_t(y) * mirrored.width + width - 1 - x) + c]);
      }
    }
  }
  EXPECT_TRUE(same(this->right, this->right));
  EXPECT_FALSE(same(mirrored, this->right));
}

// And they let pass what other versions of libraries do.
TEST_F(ViewWindowFault, LetteringAPixelAsideIsNoFault)
{
  Bitmap aside = this->right;
  const int panel = 361; // right of its frame
  for (int y = 0; y < aside.height; ++y)
  {
    unsigned char* row = &aside.rgb[std::size_t{ 3 } * y * aside.width];
    std::copy_backward(row + 3 * panel, row + 3 * (aside.width - 1), row + 3 * aside.width);
  }
  for (const Blocks& block : blocks)
  {
    EXPECT_LE(worst_block(aside, this->right, block.edge), block.most) << block.edge;
  }
}

TEST_F(ViewWindowFault, AMissingPanelIsSeen)
{
  EXPECT_FALSE(same(
    drawn(this->one, [](ordered_json&, Viewer::Settings& settings) { settings.panel = false; }),
    this->right));
}

TEST_F(ViewWindowFault, AnotherBackgroundIsSeen)
{
  EXPECT_FALSE(same(drawn(this->one,
                      [](ordered_json& scene, Viewer::Settings&) {
                        scene["background"] = { 0.1, 0.1, 0.1 };
                      }),
    this->right));
}

TEST_F(ViewWindowFault, AThinnerVolumeIsSeen)
{
  EXPECT_FALSE(
    same(drawn(this->one,
           [](ordered_json& scene, Viewer::Settings&) { scene["opacity-unit-distance"] = 10.0; }),
      this->right));
}

TEST_F(ViewWindowFault, ACaptionThatIsMissingIsSeen)
{
  Bitmap without = this->right;
  const int height = 24; // below the pictures
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < 180; ++x)
    {
      std::copy_n(&without.rgb[3 * (std::size_t(y) * without.width)],
        3,
        &without.rgb[3 * (std::size_t(y) * without.width + x)]);
    }
  }
  EXPECT_FALSE(same(without, this->right));
}
