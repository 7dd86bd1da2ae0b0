#include "study_json.h"

#include "figures.h"
#include "json_parts.h"
#include "statistics.h"
#include "study_words.h"

#include <cmath>
#include <locale>
#include <sstream>

namespace brume
{

namespace
{

using Json = nlohmann::ordered_json;

Json within_json(const StudyErrors& errors)
{
  Json list = Json::array();
  for (std::size_t i = 0; i < study_tolerances.size(); ++i)
  {
    list.push_back({ { "tolerance", study_tolerances[i] }, { "share", number(errors.within[i]) } });
  }
  return list;
}

Json point_errors_json(const StudyErrors& errors)
{
  Json json = errors_json(errors.measured);
  if (json.is_null())
  {
    return json;
  }
  json["rms_measured"] = json["rms"];
  json["rms"] = number(errors.rms);
  json["rms_at_most"] = number(errors.rms_upper);
  json["mean_shift_standard_error"] = number(errors.mean_shift_error);
  json["perceptual"] = number(errors.perceptual);
  json["within"] = within_json(errors);
  json["rms_limited_by_truth"] = errors.rms_limited;
  json["percentile_limited_by_truth"] = errors.percentile_limited;
  return json;
}

/// The errors of a point in each class that is not left out.
Json class_errors_json(const std::vector<ClassError>& errors, const ErrorClasses& classes)
{
  Json list = Json::array();
  for (std::size_t i = 0; i < errors.size(); ++i)
  {
    if (classes.pixels[i] > 0)
    {
      list.push_back({ { "class", classes.names[i] }, { "mean_shift", number(errors[i].mean_shift) },
        { "mean_shift_standard_error", number(errors[i].mean_shift_error) },
        { "rms", number(errors[i].rms) },
        { "share_of_squared_error", number(share_of_class(errors, classes, i)) } });
    }
  }
  return list;
}

Json classes_json(const ErrorClasses& classes)
{
  Json list = Json::array();
  for (std::size_t i = 0; i < classes.names.size(); ++i)
  {
    list.push_back({ { "class", classes.names[i] }, { "bounds", classes.bounds[i] },
      { "pixels", classes.pixels[i] }, { "mean", number(classes.brightness[i]) } });
  }
  return list;
}

Json point_json(const StudyPoint& point, const Study& study)
{
  Json json{ { "knob", point.knob }, { "setting", valid_utf8(point.setting) },
    { "settings", parse_object(point.settings, point.setting) }, { "mapper", point.mapper },
    { "stock", point.stock }, { "skipped", text_or_null(point.skipped) } };
  if (!point.skipped.empty())
  {
    return json;
  }
  json["left_out"] = Json::array();
  for (const std::string& name : point.left_out)
  {
    json["left_out"].push_back(valid_utf8(name));
  }
  json["seconds"] = seconds_json(point.timing);
  json["errors"] = point_errors_json(point.errors);
  json["own_errors"] = point.own ? errors_json(*point.own) : Json(nullptr);
  json["by_depth"] = class_errors_json(point.by_depth, study.depths);
  json["by_outline"] = class_errors_json(point.by_outline, study.outlines);
  json["own_by_depth"] = class_errors_json(point.own_by_depth, study.depths);
  json["own_by_outline"] = class_errors_json(point.own_by_outline, study.outlines);
  const auto asked = [](double v) { return v > 0.0 ? number(v) : Json(nullptr); };
  json["asked_tolerance"] = asked(point.asked_tolerance);
  json["asked_seconds"] = asked(point.asked_seconds);
  json["front"] = point.on_front;
  json["percentile_front"] = point.on_percentile_front;
  json["statistics"] = parse_object(point.statistics, point.setting);
  return json;
}

Json study_truth_json(const StudyTruth& truth)
{
  Json json = truth_json(truth.truth);
  json["kind"] = truth.kind;
  json["samples_per_pixel"] =
    truth.samples_per_pixel > 0 ? Json(truth.samples_per_pixel) : Json(nullptr);
  json["standard_error"] = { { "rms", number(truth.noise.rms) }, { "mean", number(truth.noise.mean) },
    { "percentile_99_9", number(truth.noise.percentile_999) },
    { "largest", number(truth.noise.largest) }, { "perceptual", number(truth.noise.perceptual) } };
  return json;
}

/// A field of CSV.
std::string field(const std::string& text)
{
  if (text.find_first_of(",\"\n\r") == std::string::npos)
  {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text)
  {
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  }
  return quoted + "\"";
}

std::string field(double value)
{
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(9);
  out << value;
  return std::isnan(value) ? "" : out.str();
}

}

std::string to_json(const Study& study)
{
  Json knobs = Json::array();
  for (const StudyKnob& knob : study.knobs)
  {
    knobs.push_back({ { "name", knob.name }, { "title", valid_utf8(knob.title) },
      { "what", valid_utf8(knob.what) }, { "skipped", text_or_null(knob.skipped) } });
  }
  Json points = Json::array();
  for (const StudyPoint& point : study.points)
  {
    points.push_back(point_json(point, study));
  }
  Json words = Json::array();
  for (const std::string& sentence : study_words(study))
  {
    words.push_back(valid_utf8(sentence));
  }
  const Json json{ { "format", "brume-cost" }, { "version", 1 }, { "words", words },
    { "command_line", text_or_null(study.command_line) }, { "date", text_or_null(study.date) },
    { "seconds", number(study.seconds) }, { "seconds_asked", number(study.seconds_asked) },
    { "load", number(study.load) }, { "scene", scene_json(study.scene) },
    { "display_curve", study.display_curve == DisplayCurve::Srgb ? "srgb" : "identity" },
    { "exposure", number(study.exposure) }, { "truth", study_truth_json(study.truth) },
    { "depths", classes_json(study.depths) }, { "outlines", classes_json(study.outlines) },
    { "knobs", knobs }, { "points", points },
    { "machine", machine_json(study.machine) } };
  return json.dump(2) + "\n";
}

std::string to_csv(const Study& study)
{
  std::string csv = "knob,setting,mapper,seconds,seconds_min,seconds_max,repetitions,seconds_prepare,"
                    "mean_shift,mean_absolute,rms,rms_at_most,rms_measured,percentile_99_9,largest,"
                    "perceptual,within_0.05,within_0.01,within_0.002,rms_limited_by_truth,"
                    "percentile_limited_by_truth,own_rms,own_percentile_99_9,front,percentile_front,"
                    "skipped\n";
  for (const StudyPoint& point : study.points)
  {
    std::vector<std::string> fields{ point.knob, point.setting, point.mapper };
    if (point.skipped.empty())
    {
      const StudyErrors& e = point.errors;
      for (const double value : { point.timing.median, point.timing.min, point.timing.max,
             double(point.timing.repetitions), point.timing.prepare, e.measured.mean_shift,
             e.measured.mean_absolute, e.rms, e.rms_upper, e.measured.rms, e.measured.percentile_999,
             e.measured.largest, e.perceptual, e.within[0], e.within[1], e.within[2],
             double(e.rms_limited), double(e.percentile_limited) })
      {
        fields.push_back(field(value));
      }
      fields.push_back(point.own ? field(point.own->rms) : "");
      fields.push_back(point.own ? field(point.own->percentile_999) : "");
      fields.push_back(point.on_front ? "1" : "0");
      fields.push_back(point.on_percentile_front ? "1" : "0");
    }
    fields.resize(25);
    fields.push_back(point.skipped);
    for (std::size_t i = 0; i < fields.size(); ++i)
    {
      csv += (i ? "," : "") + field(valid_utf8(fields[i]));
    }
    csv += "\n";
  }
  return csv;
}

}
