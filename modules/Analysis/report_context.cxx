#include "report_context.h"

#include "figures.h"
#include "headline.h"
#include "report_parts.h"
#include "statistics.h"

#include <algorithm>
#include <cmath>

namespace brume
{

std::string title_of(const ComparisonEntry& entry)
{
  return entry.title.empty() ? entry.mapper : entry.title;
}

namespace
{

using Json = nlohmann::ordered_json;

std::vector<const ComparisonEntry*> drawn_entries(const Comparison& comparison)
{
  std::vector<const ComparisonEntry*> drawn;
  for (const ComparisonEntry& entry : comparison.entries)
  {
    if (entry.skipped.empty())
    {
      drawn.push_back(&entry);
    }
  }
  return drawn;
}

/// One bar; `largest` is the longest finite one of its chart. What is infinite fills the chart.
Json bar(const std::string& name, double value, double largest, const std::string& text,
  const char* kind)
{
  const bool endless = !std::isfinite(value);
  const double share = endless ? 100.0 : largest > 0.0 ? 100.0 * value / largest : 0.0;
  return { { "name", name }, { "share", figure(std::clamp(share, 0.0, 100.0), 4) },
    { "value", text }, { "kind", endless ? "endless" : kind } };
}

double larger_finite(double largest, double value)
{
  return std::isfinite(value) ? std::max(largest, value) : largest;
}

void add_bars(Json& context, const Comparison& comparison)
{
  const auto entries = drawn_entries(comparison);
  double slowest = 0.0;
  double worst = 0.0;
  bool measured = false;
  for (const ComparisonEntry* entry : entries)
  {
    slowest = larger_finite(slowest, entry->timing.median);
    worst = larger_finite(worst, entry->against_truth.mean_absolute);
    measured = measured || entry->against_truth.values > 0;
  }
  context["speed_bars"] = Json::array();
  context["error_bars"] = Json::array();
  for (const ComparisonEntry* entry : entries)
  {
    const char* kind = entry == subject_of(comparison) ? "subject" : "other";
    const double seconds = entry->timing.median;
    context["speed_bars"].push_back(
      bar(title_of(*entry), seconds, slowest, seconds_text(seconds), kind));
    if (entry->against_truth.values > 0)
    {
      const double error = entry->against_truth.mean_absolute;
      context["error_bars"].push_back(
        bar(title_of(*entry), error, worst, in_255ths(error), kind));
    }
  }
  context["has_errors"] = measured;
}

std::string plus_if_positive(double value)
{
  return value > 0.0 && std::isfinite(value) ? "+" : "";
}

Json error_cells(const ImageErrors& errors)
{
  Json cells = Json::array();
  const double values[] = { errors.mean_shift, errors.mean_absolute, errors.rms,
    errors.percentile_999, errors.largest };
  for (std::size_t i = 0; i < 5; ++i)
  {
    const std::string sign = i == 0 ? plus_if_positive(values[i]) : "";
    const bool finite = std::isfinite(values[i]);
    cells.push_back(errors.values == 0
        ? Json{ { "display", "–" }, { "plain", "not measured" } }
        : Json{ { "display", finite ? sign + in_255ths(values[i]) : "∞" },
            { "plain", finite ? sign + figure(values[i]) : "not finite" } });
  }
  return cells;
}

std::string timing_note(const Timing& timing)
{
  std::vector<std::string> parts;
  if (timing.repetitions > 0)
  {
    parts.push_back(std::to_string(timing.repetitions) + (timing.repetitions == 1 ? " run" : " runs"));
  }
  if (timing.warm_up > 0)
  {
    parts.push_back("first " + seconds_text(timing.warm_up));
  }
  if (timing.prepare > 0)
  {
    parts.push_back("prepared in " + seconds_text(timing.prepare));
  }
  return joined(parts, ", ");
}

void add_tables(Json& context, const Comparison& comparison)
{
  const ComparisonEntry* reference = find_drawn(comparison, comparison.reference_mapper);
  context["reference_title"] = reference ? title_of(*reference) : "no reference";
  context["speed_note"] = reference ? title_of(*reference) + " = 1" : "no reference";
  context["rows"] = Json::array();
  context["reference_rows"] = Json::array();
  for (const ComparisonEntry* entry : drawn_entries(comparison))
  {
    const Timing& timing = entry->timing;
    const char* kind = entry == subject_of(comparison) ? "subject" : "other";
    context["rows"].push_back({ { "title", title_of(*entry) }, { "kind", kind },
      { "timing_note", timing_note(timing) }, { "median", figure(timing.median) },
      { "range", figure(timing.min) + "–" + figure(timing.max) },
      { "speed",
        reference && timing.median > 0
          ? figure(reference->timing.median / timing.median) + "×"
          : std::string("–") },
      { "errors", error_cells(entry->against_truth) },
      { "non_finite_count", entry->against_truth.non_finite_test } });
    if (reference && entry->against_reference && entry != reference)
    {
      context["reference_rows"].push_back({ { "title", title_of(*entry) }, { "kind", kind },
        { "errors", error_cells(*entry->against_reference) } });
    }
  }
  context["has_reference_rows"] = !context["reference_rows"].empty();
}

void add_contributions(Json& context, const Comparison& comparison)
{
  double largest = 0.0;
  for (const ComparisonEntry* entry : drawn_entries(comparison))
  {
    for (const Contribution& cause : entry->contributions)
    {
      largest = larger_finite(largest, cause.errors.mean_absolute);
    }
  }
  context["contributions"] = Json::array();
  for (const ComparisonEntry* entry : drawn_entries(comparison))
  {
    std::vector<Contribution> causes = entry->contributions;
    std::stable_sort(causes.begin(), causes.end(), [](const Contribution& a, const Contribution& b) {
      return a.errors.mean_absolute > b.errors.mean_absolute;
    });
    Json list = Json::array();
    for (const Contribution& cause : causes)
    {
      const ImageErrors& errors = cause.errors;
      Json item = bar(cause.name, errors.mean_absolute, largest, in_255ths(errors.mean_absolute),
        entry == subject_of(comparison) ? "subject" : "other");
      item["explanation"] = cause.explanation.empty() || cause.explanation.back() == '.'
        ? cause.explanation
        : cause.explanation + ".";
      item["rms"] = in_255ths(errors.rms);
      item["percentile"] = in_255ths(errors.percentile_999);
      item["largest"] = in_255ths(errors.largest);
      list.push_back(item);
    }
    if (!list.empty())
    {
      context["contributions"].push_back({ { "title", title_of(*entry) },
        { "total", over_255(entry->against_truth.mean_absolute) }, { "causes", list } });
    }
  }
  context["has_contributions"] = !context["contributions"].empty();
}

/// A member of an effect as text, whatever its type.
std::string member_text(const Json& effect, const char* name)
{
  const auto found = effect.find(name);
  if (found == effect.end() || found->is_null())
  {
    return {};
  }
  return found->is_string() ? found->get<std::string>()
    : found->is_number()    ? figure(found->get<double>())
                            : found->dump();
}

void add_effects(Json& context, const Comparison& comparison)
{
  context["effect_groups"] = Json::array();
  for (const ComparisonEntry* entry : drawn_entries(comparison))
  {
    const Json statistics = parse_statistics(*entry);
    const auto effects = statistics.find("effects");
    if (effects == statistics.end() || !effects->is_array() || effects->empty())
    {
      continue;
    }
    Json list = Json::array();
    for (const Json& effect : *effects)
    {
      if (effect.is_object())
      {
        const auto bound = effect.find("error_bound");
        const auto on = effect.find("on");
        list.push_back({ { "name", member_text(effect, "name") },
          { "on", on != effect.end() && on->is_boolean() && on->get<bool>() },
          { "reason", member_text(effect, "reason") },
          { "bound",
            bound != effect.end() && bound->is_number() ? over_255(bound->get<double>())
                                                        : member_text(effect, "error_bound") } });
      }
    }
    const auto radiometric = statistics.find("radiometric");
    const bool not_radiometric =
      radiometric != statistics.end() && radiometric->is_boolean() && !radiometric->get<bool>();
    context["effect_groups"].push_back({ { "title", title_of(*entry) },
      { "remark", not_radiometric ? "not radiometric: terms that are not physics are on" : "" },
      { "effects", list } });
  }
  context["has_effects"] = !context["effect_groups"].empty();
}

void add_truth(Json& context, const Truth& truth)
{
  context["truth_method"] =
    truth.method.empty() ? "No truth was computed, so no error is known." : truth.method;
  Json list = Json::array();
  if (!truth.method.empty())
  {
    describe(list, "Remaining mean error", over_255(truth.remaining_mean));
    describe(list, "Remaining largest error", over_255(truth.remaining_largest));
    describe(list, "Refinements",
      truth.refinement_levels > 0 ? std::to_string(truth.refinement_levels) : "");
    describe(list, "Time", seconds_text(truth.seconds));
  }
  context["truth"] = list;
}

}

Json report_context(const Comparison& comparison)
{
  Json context;
  context["date"] = comparison.date;
  context["headline"] = tied(headline(comparison));
  context["command_line"] = comparison.command_line;
  context["has_entries"] = subject_of(comparison) != nullptr;
  context["skipped"] = Json::array();
  for (const ComparisonEntry& entry : comparison.entries)
  {
    if (!entry.skipped.empty())
    {
      context["skipped"].push_back({ { "title", title_of(entry) }, { "reason", entry.skipped } });
    }
  }
  context["has_skipped"] = !context["skipped"].empty();
  context["in_part"] = Json::array();
  for (const ComparisonEntry& entry : comparison.entries)
  {
    if (!entry.left_out.empty())
    {
      context["in_part"].push_back(
        { { "title", title_of(entry) }, { "words", left_out_words(entry) } });
    }
  }
  context["has_in_part"] = !context["in_part"].empty();
  add_scene(context, comparison.scene);
  add_bars(context, comparison);
  add_pictures(context, comparison);
  add_tables(context, comparison);
  add_contributions(context, comparison);
  add_effects(context, comparison);
  add_truth(context, comparison.truth);
  add_machine(context, comparison.machine);
  return context;
}

}
