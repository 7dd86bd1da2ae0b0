#include "report_parts.h"

#include "figures.h"

#include <vtkBase64Utilities.h>

namespace brume
{

using Json = nlohmann::ordered_json;

namespace
{

std::string triple(const std::array<double, 3>& values)
{
  return figure(values[0], 4) + ", " + figure(values[1], 4) + ", " + figure(values[2], 4);
}

std::string rgb_text(const std::array<unsigned char, 3>& colour)
{
  return "rgb(" + std::to_string(colour[0]) + "," + std::to_string(colour[1]) + "," +
    std::to_string(colour[2]) + ")";
}

}

std::string tied(std::string sentence)
{
  for (const char* unit : { " s,", " s)", " s.", " s ", " %", " times" })
  {
    for (std::size_t at = 0; (at = sentence.find(unit, at)) != std::string::npos; ++at)
    {
      sentence.replace(at, 1, "\u00A0");
    }
  }
  return sentence;
}

void describe(Json& list, const char* name, const std::string& value)
{
  if (!value.empty())
  {
    list.push_back({ { "name", name }, { "value", value } });
  }
}

std::string joined(const std::vector<std::string>& parts, const std::string& separator)
{
  std::string text;
  for (const std::string& part : parts)
  {
    text += part.empty() ? "" : (text.empty() ? "" : separator) + part;
  }
  return text;
}

void add_scene(Json& context, const SceneDescription& scene)
{
  const std::string voxels = voxels_text(scene.dimensions.data(), scene.spacing.data(), scene.unit);
  const std::string step = step_text(scene.step, scene.step_voxels, scene.unit);
  const std::string resolution = scene.width > 0
    ? std::to_string(scene.width) + " × " + std::to_string(scene.height) + " pixels"
    : "";
  context["input"] = scene.input;
  context["scene_line"] = joined({ voxels, scene.preset.empty() ? "" : "preset " + scene.preset,
                                   resolution, step.empty() ? "" : "step " + step },
    " · ");
  context["matched"] = Json::array();
  for (const MatchedSetting& setting : scene.matched)
  {
    context["matched"].push_back({ { "name", setting.name }, { "value", setting.value },
      { "applies_to", setting.applies_to } });
  }
  context["has_matched"] = !scene.matched.empty();

  const CameraDescription& camera = scene.camera;
  Json list = Json::array();
  describe(list, "Data", voxels);
  describe(list, "Transfer functions", scene.preset);
  describe(list, "Resolution", resolution);
  describe(list, "Sample distance", step.empty() ? "chosen by each mapper" : step);
  describe(list, "Opacity unit distance",
    scene.opacity_unit_distance > 0 ? step_text(scene.opacity_unit_distance, 0, scene.unit) : "");
  describe(list, "Interpolation", scene.interpolation);
  describe(list, "Shading", scene.shading ? "on" : "off");
  describe(list, "Lights", scene.lights.empty() ? "none" : joined(scene.lights, "; "));
  describe(list, "Background, linear RGB", triple(scene.background));
  describe(list, "Camera position", triple(camera.position));
  describe(list, "Camera focal point", triple(camera.focal_point));
  describe(list, "Camera view up", triple(camera.view_up));
  describe(list, "Projection",
    camera.parallel ? "parallel, scale " + figure(camera.parallel_scale)
                    : "perspective, view angle " + figure(camera.view_angle) + "°");
  context["scene"] = list;
}

void add_machine(Json& context, const Machine& machine)
{
  Json list = Json::array();
  describe(list, "Processor", machine.cpu);
  describe(list, "Threads", machine.threads > 0 ? std::to_string(machine.threads) : "");
  describe(list, "Instruction set", machine.simd);
  describe(list, "System", machine.os);
  describe(list, "Brume", machine.brume_version);
  describe(list, "VTK", machine.vtk_version);
  context["machine"] = list;
}

std::string data_uri(const Bitmap& bitmap)
{
  const std::vector<unsigned char> png = encode_png(bitmap);
  std::string text(4 * ((png.size() + 2) / 3) + 4, '\0');
  const unsigned long length = vtkBase64Utilities::Encode(
    png.data(), static_cast<unsigned long>(png.size()), reinterpret_cast<unsigned char*>(&text[0]));
  text.resize(length);
  return "data:image/png;base64," + text;
}

Json picture_json(const std::string& id, const std::string& title, const Bitmap& bitmap)
{
  return { { "id", id }, { "title", title }, { "class_name", nullptr },
    { "source", data_uri(bitmap) }, { "width", bitmap.width }, { "height", bitmap.height } };
}

void add_legend(Json& context, DifferenceKind kind, double gain)
{
  context["gain"] = figure(gain, 10);
  context["scale_end"] = figure(255.0 / gain);
  std::string ramp;
  constexpr int stops = 24;
  for (int i = 0; i <= stops; ++i)
  {
    ramp += (i ? "," : "") +
      rgb_text(legend_colour(kind, static_cast<double>(i) / stops));
  }
  context["ramp"] = ramp;
  context["ticks"] = Json::array();
  for (const LegendTick& tick : legend_ticks(kind, gain))
  {
    context["ticks"].push_back({ { "at", figure(100.0 * tick.position) }, { "text", tick.text } });
  }
}

std::string display_note(DisplayCurve curve, double exposure)
{
  const std::string exposed = exposure == 0.0
    ? ""
    : "Brightened by " + figure(exposure) + " stops. ";
  return exposed +
    (curve == DisplayCurve::Srgb
        ? "Shown through the sRGB curve and cut to what a display holds; measured before both."
        : "Shown as a VTK window shows the same numbers (a byte is 255 times the value, with no display "
          "curve) and cut to what a display holds; measured before that.");
}

}
