// The parts that the page of a comparison and that of a study have in common. Texts are not escaped
// yet.
#pragma once

#include "comparison.h"
#include "difference_picture.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace brume
{

/// The sentence with each figure tied to its unit, so that no line breaks between them.
std::string tied(std::string sentence);

/// Appends a named value to a description list, if it has one.
void describe(nlohmann::ordered_json& list, const char* name, const std::string& value);

/// Those that are not empty, with a separator between.
std::string joined(const std::vector<std::string>& parts, const std::string& separator);

/// `input`, `scene_line`, `matched`, `has_matched` and `scene` of a page.
void add_scene(nlohmann::ordered_json& context, const SceneDescription& scene);

/// `machine` of a page.
void add_machine(nlohmann::ordered_json& context, const Machine& machine);

/// A bitmap as it stands in a page.
std::string data_uri(const Bitmap& bitmap);

/// An element of a list of pictures: `id`, `title`, `class_name`, `source`, `width`, `height`.
nlohmann::ordered_json picture_json(
  const std::string& id, const std::string& title, const Bitmap& bitmap);

/// `gain`, `scale_end`, `ramp` and `ticks` of a page: the scale of differences.
void add_legend(nlohmann::ordered_json& context, DifferenceKind kind, double gain);

/// How pictures are shown, in words.
std::string display_note(DisplayCurve curve, double exposure);

}
