#include "study_report.h"

#include "difference_picture.h"
#include "figures.h"
#include "report_parts.h"
#include "report_text.h"
#include "study_words.h"
#include "text_template.h"

#include <algorithm>
#include <cmath>

namespace brume
{

namespace
{

using Json = nlohmann::ordered_json;

/// Front points whose pictures are shown, at the most.
constexpr std::size_t most_of_front = 4;

std::string percent(double share)
{
  return figure(100.0 * share, 3) + " %";
}

std::string rms_text(const StudyPoint& point)
{
  return point.errors.rms_limited ? "≤ " + in_255ths(point.errors.rms_upper)
                                  : in_255ths(point.errors.rms);
}

std::string limited(const StudyPoint& point, double value)
{
  return (point.errors.percentile_limited ? "~ " : "") + in_255ths(value);
}

Json figures_of(const Study& study, const StudyPoint& point)
{
  const StudyErrors& errors = point.errors;
  const double shift = errors.measured.mean_shift;
  return { { "name", point_name(study, point) }, { "seconds", figure(point.timing.median) },
    { "range", figure(point.timing.min) + "–" + figure(point.timing.max) + ", " +
        std::to_string(point.timing.repetitions) + (point.timing.repetitions == 1 ? " run" : " runs") },
    { "shift", (shift > 0.0 ? "+" : "") + in_255ths(shift) }, { "rms", rms_text(point) },
    { "percentile", limited(point, errors.measured.percentile_999) },
    { "largest", limited(point, errors.measured.largest) },
    { "perceptual", percent(errors.perceptual) },
    { "within", percent(errors.within[0]) + ", " + percent(errors.within[1]) + ", " +
        percent(errors.within[2]) },
    { "own", point.own ? in_255ths(point.own->rms) : std::string("–") } };
}

void add_front(Json& context, const Study& study)
{
  context["front"] = Json::array();
  const StudyPoint* before = nullptr;
  for (const StudyPoint* point : front_of(study))
  {
    Json row = figures_of(study, *point);
    const double price = before && !point->errors.rms_limited
      ? price_of_halving(
          before->timing.median, before->errors.rms, point->timing.median, point->errors.rms)
      : 0.0;
    row["price"] = price > 0.0 ? (price < 1000.0 ? figure(price, 2) + "×" : std::string("> 1000×"))
                               : std::string("–");
    context["front"].push_back(row);
    before = point;
  }
  context["has_front"] = !context["front"].empty();
}

/// The points whose pictures are shown.
std::vector<const StudyPoint*> chosen_points(const Study& study)
{
  std::vector<const StudyPoint*> chosen;
  const auto add = [&](const StudyPoint* point)
  {
    if (point && std::find(chosen.begin(), chosen.end(), point) == chosen.end())
    {
      chosen.push_back(point);
    }
  };
  const std::vector<const StudyPoint*> front = front_of(study);
  const std::size_t shown = std::min(front.size(), most_of_front);
  for (std::size_t i = 0; i < shown; ++i)
  {
    add(front[shown > 1 ? i * (front.size() - 1) / (shown - 1) : 0]);
  }
  const auto quickest = [&](const auto& condition)
  {
    const StudyPoint* found = nullptr;
    for (const StudyPoint& point : study.points)
    {
      if (point.skipped.empty() && condition(point) &&
        (!found || point.timing.median < found->timing.median))
      {
        found = &point;
      }
    }
    return found;
  };
  for (const StudyPoint& point : study.points)
  {
    if (point.knob == "octaves" && point.skipped.empty())
    {
      add(&point); // the first: single scattering
      break;
    }
  }
  add(quickest([](const StudyPoint& p) { return p.asked_tolerance > 0.0; }));
  for (const char* mapper : { "vtk-fixed-point", "vtk-gpu" })
  {
    add(quickest([&](const StudyPoint& p) { return p.mapper == mapper; }));
  }
  return chosen;
}

void add_places(Json& context, const Study& study, const std::vector<const StudyPoint*>& chosen)
{
  context["classes"] = Json::array();
  for (std::size_t i = 0; i < study.depths.names.size(); ++i)
  {
    context["classes"].push_back({ { "name", study.depths.names[i] },
      { "bounds", study.depths.bounds[i] }, { "pixels", study.depths.pixels[i] } });
  }
  context["places"] = Json::array();
  for (const StudyPoint* point : chosen)
  {
    Json shifts = Json::array();
    for (std::size_t i = 0; i < point->by_depth.size(); ++i)
    {
      const double brightness = study.depths.brightness[i];
      const ClassError& error = point->by_depth[i];
      const double part = brightness > 0.0 ? error.mean_shift / brightness : 0.0;
      shifts.push_back(study.depths.pixels[i] == 0 || !(brightness > 0.0)
          ? std::string("–")
          : (part > 0.0 ? "+" : "") + figure(100.0 * part, 2) + " ± " +
            figure(200.0 * error.mean_shift_error / brightness, 2) + " %");
    }
    context["places"].push_back({ { "name", point_name(study, *point) }, { "shifts", shifts },
      { "outlines", percent(share_of_class(point->by_outline, study.outlines, 0)) } });
  }
  context["has_places"] = !chosen.empty();
}

/// A gain at which half of the differences fill the scale; the larger errors reach beyond it.
double gain_for(const std::vector<const StudyPoint*>& chosen)
{
  std::vector<double> gains;
  for (const StudyPoint* point : chosen)
  {
    if (std::isfinite(point->errors.measured.percentile_999) && point->errors.measured.largest > 0.0)
    {
      gains.push_back(automatic_gain(point->errors.measured));
    }
  }
  std::sort(gains.begin(), gains.end());
  return gains.empty() ? 1.0 : gains[gains.size() / 2];
}

void add_pictures(Json& context, const Study& study)
{
  const std::vector<const StudyPoint*> chosen = chosen_points(study);
  const double gain = gain_for(chosen);
  const Picture& truth = study.truth.truth.picture;
  context["pictures"] = Json::array();
  context["differences"] = Json::array();
  const auto shown = [&](const Picture& picture)
  { return to_bitmap(picture, study.display_curve, study.exposure); };
  if (!chosen.empty())
  {
    Json picture = picture_json("truth", "Truth", shown(truth));
    picture["alt"] = "The scene as the truth has it";
    picture["figures"] = seconds_text(study.truth.truth.seconds) + ", its own error " +
      over_255(study.truth.noise.rms);
    context["pictures"].push_back(picture);
  }
  std::size_t number = 0;
  for (const StudyPoint* point : chosen)
  {
    const std::string id = std::to_string(++number);
    const std::string name = point_name(study, *point);
    Json picture = picture_json(id, name, shown(point->picture));
    picture["alt"] = "The scene with " + name;
    picture["figures"] =
      seconds_text(point->timing.median) + ", RMS error " + rms_text(*point) + "/255";
    context["pictures"].push_back(picture);
    const DifferencePicture difference =
      difference_picture(point->picture, truth, DifferenceKind::Signed, gain);
    Json different = picture_json(id, name, difference.bitmap);
    different["alt"] = "Difference of " + name + " from the truth, amplified " + figure(gain, 10) + " times";
    different["figures"] = "RMS error " + rms_text(*point) + "/255, 99.9th percentile " +
      limited(*point, point->errors.measured.percentile_999) + "/255";
    context["differences"].push_back(different);
  }
  context["has_pictures"] = !chosen.empty();
  context["by_chance"] = study.truth.kind == "paths";
  context["display_note"] = display_note(study.display_curve, study.exposure);
  add_legend(context, DifferenceKind::Signed, gain);
  add_places(context, study, chosen);
}

void add_groups(Json& context, const Study& study)
{
  context["groups"] = Json::array();
  context["skipped"] = Json::array();
  for (const StudyKnob& knob : study.knobs)
  {
    if (!knob.skipped.empty())
    {
      context["skipped"].push_back({ { "title", knob.title }, { "reason", knob.skipped } });
    }
    Json rows = Json::array();
    for (const StudyPoint& point : study.points)
    {
      if (point.knob != knob.name)
      {
        continue;
      }
      if (!point.skipped.empty())
      {
        context["skipped"].push_back(
          { { "title", point_name(study, point) }, { "reason", point.skipped } });
        continue;
      }
      Json row = figures_of(study, point);
      row["name"] = point.setting;
      row["kind"] = point.on_front ? "subject" : "other";
      std::string left_out;
      for (const std::string& words : point.left_out)
      {
        left_out += (left_out.empty() ? "without " : ", ") + words;
      }
      row["note"] = left_out;
      rows.push_back(row);
    }
    if (!rows.empty())
    {
      context["groups"].push_back(
        { { "title", knob.title }, { "what", knob.what }, { "rows", rows } });
    }
  }
  context["has_skipped"] = !context["skipped"].empty();
}

void add_study_truth(Json& context, const Study& study)
{
  const StudyTruth& truth = study.truth;
  context["truth_method"] = truth.truth.method;
  Json list = Json::array();
  describe(list, "Error of a value, RMS", over_255(truth.noise.rms));
  describe(list, "Error of the picture's mean", over_255(truth.noise.mean));
  describe(list, "99.9th percentile of its errors", over_255(truth.noise.percentile_999));
  describe(list, "Largest of its errors", over_255(truth.noise.largest));
  describe(list, "Paths through each pixel",
    truth.samples_per_pixel > 0 ? std::to_string(truth.samples_per_pixel) : "");
  describe(list, "Time of the truth", seconds_text(truth.truth.seconds));
  context["truth"] = list;
}

}

std::string to_html(const Study& study, const Bitmap* chart)
{
  Json context;
  const std::vector<std::string> words = study_words(study);
  context["date"] = study.date;
  context["headline"] = tied(words.size() > 2 ? words[2] : words.back());
  context["words"] = Json::array();
  for (const std::string& sentence : words)
  {
    context["words"].push_back(tied(sentence));
  }
  context["has_chart"] = chart != nullptr;
  context["chart"] = Json::array();
  if (chart)
  {
    Json picture = picture_json("chart", "Error against seconds", *chart);
    picture["alt"] = "RMS error over seconds of all settings; the tables below have the figures";
    context["chart"].push_back(picture);
  }
  context["command_line"] = study.command_line;
  add_scene(context, study.scene);
  add_front(context, study);
  add_pictures(context, study);
  add_groups(context, study);
  add_study_truth(context, study);
  add_machine(context, study.machine);
  describe(context["machine"], "Time of the study",
    seconds_text(study.seconds) + " of " + seconds_text(study.seconds_asked));
  describe(context["machine"], "Load when it began", figure(study.load));
  context["style"] = report_text::report_css;
  context["script"] = report_text::report_js;
  return fill_template(report_text::study_html, context);
}

}
