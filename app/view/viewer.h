// What `brume view` is without its window: a scene, its viewports and their pictures, and what keys and
// the mouse do to them. Needs no display for Brume's own mappers.
#pragma once

#include "compose.h"
#include "controls.h"
#include "layout.h"
#include "painter.h"
#include "scene_file.h"
#include "side_panel.h"
#include "transfer_editor.h"

#include "Analysis/picture.h"

#include <nlohmann/json.hpp>

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

class vtkCamera;

namespace brume::app
{

/// How two pictures are compared.
enum class Arrangement
{
  SideBySide, ///< a viewport for each mapper
  Wipe,       ///< the first to the left of a line that is dragged, the second to its right
  Flicker,    ///< one after the other, twice a second
  Difference, ///< where they differ, amplified
};

/// A rectangle of the window, and what it shows.
struct Tile
{
  Box box;
  Bitmap bitmap;          ///< stretched over the box
  bool picture = false;   ///< of the scene: what the camera's keys and the mouse turn
  unsigned version = 0;   ///< another whenever the bitmap is
};

class Viewer
{
public:
  struct Settings
  {
    std::vector<MapperKind> mappers{ MapperKind::RayMarch }; ///< one a viewport, 1 to 4
    Arrangement arrangement = Arrangement::SideBySide;
    std::array<int, 2> window{ 1280, 760 }; ///< pixels; what the camera is first fitted to
    double scale = 1.0;          ///< of lettering and panel
    bool panel = true;
    bool times = true; ///< whether captions and the plan tell how long pictures took
    /// Keys of who shows it, for the page of help.
    std::vector<std::pair<std::string, std::string>> more_keys;
    double draft_seconds = 0.04; ///< that pictures of all viewports take together while something moves
  };

  /// `scene`: a scene file's object with absolute names of files (scene_of, read_scene). Reads the input.
  /// Throws Failure for what cannot be opened.
  Viewer(const nlohmann::ordered_json& scene, const Settings& settings);
  ~Viewer();

  /// The window's size in pixels.
  void resize(int width, int height);

  /// The scene as it is seen now, as a scene file: with the camera's place and the size of a viewport.
  nlohmann::ordered_json scene() const;
  const VolumeScene& volume_scene() const { return this->Volume; }
  vtkCamera* camera() const;
  const Settings& settings() const { return this->Set; }

  /// Another scene in place of this one; the camera stays if `keep_camera` and the file names none.
  /// Throws Failure, and stays as it was.
  void open(const nlohmann::ordered_json& scene);
  /// Reads the input again. What was set stays, and so does what it was at first. Throws Failure, and
  /// stays as it was.
  void reload();
  /// Another time step of a series, from 0 on. Throws as reload().
  void go_to_time(int step);

  // Events, in pixels from the window's upper left corner.
  /// Whether the panel or a divider takes the mouse there; else it is the camera's.
  bool press(int x, int y, bool right_button, bool twice);
  bool drag(int x, int y); ///< also moves without a button: what is under the mouse is told
  bool release();
  /// So many steps of the wheel, away from the hand above 0.
  bool wheel(int x, int y, int steps);
  /// By the name that X has for the key ("Left", "question"). Whether it means something.
  bool key(const std::string& symbol);
  /// All keys that key() knows, for people, and what they do.
  static std::vector<std::pair<std::string, std::string>> keys();
  /// Sets a key of the scene, as a scene file has it; null takes it out. What does not fit is told in the
  /// panel, and the scene stays.
  void set_key(const std::string& key, const nlohmann::ordered_json& value);
  /// What the scene has of a key; null where it says nothing.
  nlohmann::ordered_json key_of_scene(const std::string& key) const;
  /// The camera as it was at first.
  void reset_camera();
  /// The camera was moved by who has it.
  void camera_moved();
  /// The time has come to show the other picture (Arrangement::Flicker).
  void flick();

  // Pictures.
  /// Whether something changed since the last draft.
  bool stale() const { return this->Stale; }
  /// Quick pictures of all viewports, one after another; `drawn`, if there is one, is called after the
  /// first of them where it is the first of all. Where `go` ends it the pictures before stay.
  void draft(const KeepGoing& go, const std::function<void()>& drawn = {});
  /// Whether any viewport has a picture.
  bool has_pictures() const;
  /// One better picture of one viewport; false where all are as good as was asked for, or `go` ended it.
  bool refine(const KeepGoing& go);
  bool finished() const;
  /// Of the viewport, in the order of Settings::mappers.
  const Shot& shot(int viewport) const;
  /// Why that viewport has no picture; empty where it has one, or none yet.
  const std::string& failure(int viewport) const;

  /// All rectangles of the window; they do not overlap.
  const std::vector<Tile>& tiles();
  /// The panel among them, with what can be pressed.
  const DrawnPanel& panel() const { return this->Panel; }
  /// One line: what was done, or went wrong. Stays until the next change of the scene.
  void say(const std::string& hint);
  /// What is under way, in place of that line while it is not empty.
  void tell_progress(const std::string& progress);
  /// Whether refinement waits, as after its key.
  ///@{
  bool paused() const { return this->Paused; }
  void pause(bool paused);
  ///@}

private:
  struct Pane
  {
    MapperKind kind = MapperKind::RayMarch;
    std::unique_ptr<Painter> painter;
    std::string failure; ///< of the last picture
  };
  struct Action;
  static const std::vector<Action>& actions();

  bool set(nlohmann::ordered_json scene); ///< false where it is refused, which is said
  void take(const nlohmann::ordered_json& scene);
  void read_function();
  void open_keeping(const nlohmann::ordered_json& scene);
  std::string line() const;
  void make_panes();
  void give_scene();
  void changed();
  ControlScene control_scene() const;
  PanelModel panel_model();
  SunAngles first_sun() const; ///< over the left shoulder of who looks
  Triple sun_seen() const;
  void turn_sun(int x, int y);
  void turn(const Control& control, double place);
  void turn_held(const Control& control, double place); ///< in the scene as it was when its bar was taken
  void nudge(const Control& control, double by);
  void restore(const Control& control);
  void note_others(const Control& control, const nlohmann::ordered_json& before);
  void keep_own(const Control& control); ///< no other control's to undo
  void tint(int index, double hue, double saturation);
  Triple chosen_colour() const;
  void set_chosen_colour(const Triple& colour);
  void set_function(const TransferFunction& function);
  void choose_point(int index);
  FunctionPoint point_under(int x, int y);
  void show_picker(const HotSpot& swatch);
  bool picker_is_above(int index) const; ///< of that control's row
  void press_curve(const HotSpot& spot, int x, bool right_button, bool twice, int y);
  void press_colours(const HotSpot& spot, int x, bool right_button, bool twice);
  void drag_control(int x);
  bool drag_point(int x, int y);
  void step_preset(int by);
  void switch_effect(const std::string& name);
  void switch_light();
  void switch_paths();
  void next_mapper();
  void show_viewports(int count);
  void arrange(Arrangement arrangement);
  void step_time(int by);
  bool press_panel(int x, int y, bool right_button, bool twice);
  template <class Draw>
  bool draw(Pane& pane, const Draw& draw_it);
  bool compares() const;
  int panes_drawn() const;
  std::string caption(const Pane& pane) const;
  Bitmap bitmap_of(const Pane& pane) const;
  void tile_pictures();
  void put_captions(const std::vector<Caption>& captions); ///< one a viewport
  void tile_panel();
  void put(std::size_t index, const Box& box, Bitmap bitmap, bool picture);

  Settings Set;
  nlohmann::ordered_json Scene;  ///< without the camera where the user has not placed it
  nlohmann::ordered_json First;  ///< as it was opened
  std::optional<ParsedScene> Parsed;
  VolumeScene Volume;
  vtkSmartPointer<vtkCamera> FirstCamera; ///< as it was opened
  std::vector<Pane> Panes;
  std::array<int, 2> Window;
  Layout Boxes;
  std::vector<Tile> Tiles;
  DrawnPanel Panel;
  ControlPage Page = ControlPage::Light;
  std::array<int, 4> Scrolls{};  ///< of the panel's pages
  std::optional<int> Picker;     ///< as PanelModel has it
  std::optional<Histogram> Values; ///< made when it is first shown
  TransferFunction Function;
  FunctionPoint Hand;  ///< of the function: held, or under the mouse
  int Chosen = -1;     ///< its point of colour that can be given another
  std::vector<std::pair<std::string, std::string>> Figures;
  std::string Hint;
  std::string Progress;
  bool Stale = true;
  bool PicturesChanged = true;
  bool PanelChanged = true;
  bool Help = false;
  bool SecondShown = false; ///< Arrangement::Flicker
  bool Paused = false;
  double Divider = 0.5;     ///< Arrangement::Wipe, part of the width
  unsigned Version = 0;

  enum class Held
  {
    Nothing,
    Control,
    Ball,
    Point,
    Picker,
    Scroll,
    Divider,
  };
  /// What a control did to a key that is not its own; null: not in the scene.
  struct OthersKey
  {
    nlohmann::ordered_json before;
    nlohmann::ordered_json after;
  };
  std::map<const Control*, std::map<std::string, OthersKey>> Others; ///< for a right click to undo
  Held Hold = Held::Nothing;
  HotSpot HeldSpot;
  Triple HeldColour{ 1.0, 1.0, 1.0 }; ///< of a point: its brightness is dragged, and its hue must stay at 0
  /// The scene as it was when a bar was taken. Each place of the bar is set in that one, so that what
  /// hangs on a value comes back with it. Empty once anything else changed the scene.
  struct DragStart
  {
    nlohmann::ordered_json scene;
    SceneOptions options;
    std::map<std::string, OthersKey> others;
  };
  std::shared_ptr<const DragStart> BeforeDrag;
  int HeldOffset = 0;                 ///< from the scroll bar's thumb to the hand
};

}
