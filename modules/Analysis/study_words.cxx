#include "study_words.h"

#include "figures.h"

#include <algorithm>
#include <cmath>

namespace brume
{

namespace
{

/// Below this share of a class's brightness an error is not spoken of.
constexpr double least_bias = 0.005;
/// A class's share of the squared error that is spoken of, where a tenth would be even.
constexpr double telling_share = 0.25;

std::string percent(double share)
{
  return figure(100.0 * share, 2) + " %";
}

std::string cost_words(const StudyPoint& point)
{
  return seconds_text(point.timing.median) + ", RMS error " + over_255(point.errors.rms);
}

std::string truth_words(const Study& study)
{
  const StudyTruth& truth = study.truth;
  if (truth.kind == "paths")
  {
    return "The truth holds every scattering: " + figure(truth.samples_per_pixel, 6) +
      " paths through each pixel, in two halves that know nothing of one another. A value's standard "
      "error is " + over_255(truth.noise.rms) + ", that of the whole picture's mean " +
      over_255(truth.noise.mean) +
      ". RMS errors below are freed of that noise; percentiles and largest errors cannot be, and are "
      "marked where they are less than twice the truth's own (" + over_255(truth.noise.percentile_999) +
      " and " + over_255(truth.noise.largest) + ").";
  }
  return std::string(truth.kind == "march"
             ? "The truth holds one scattering, with exact shadows. "
             : "The truth is a quadrature in double precision. ") +
    "Its own error is " + over_255(truth.truth.remaining_mean) + " in the mean and " +
    over_255(truth.truth.remaining_largest) + " at most.";
}

/// The front's last doubling of effort.
std::vector<std::string> front_words(const Study& study)
{
  std::vector<const StudyPoint*> front = front_of(study);
  if (front.empty())
  {
    return { "Nothing was drawn, so no front is known." };
  }
  std::vector<std::string> words;
  const StudyPoint& cheapest = *front.front();
  const StudyPoint& best = *front.back();
  if (front.size() == 1)
  {
    return { "One setting beats all others: " + point_name(study, best) + " (" + cost_words(best) + ")." };
  }
  words.push_back("Of " + std::to_string(study.points.size()) + " settings " +
    std::to_string(front.size()) + " are beaten by none: from " + point_name(study, cheapest) + " (" +
    cost_words(cheapest) + ") to " + point_name(study, best) + " (" +
    (best.errors.rms_limited
        ? seconds_text(best.timing.median) + ", RMS error at most " + over_255(best.errors.rms_upper)
        : cost_words(best)) +
    ").");
  // Points that the truth cannot measure say nothing of what a halving costs.
  const auto end = std::remove_if(front.begin(), front.end(),
    [](const StudyPoint* p) { return p->errors.rms_limited || !(p->errors.rms > 0.0); });
  front.erase(end, front.end());
  if (front.size() < 2)
  {
    return words;
  }
  const StudyPoint& last = *front.back();
  // The last setting before it with twice its error or more.
  const StudyPoint* before = nullptr;
  for (const StudyPoint* point : front)
  {
    before = point->errors.rms >= 2.0 * last.errors.rms ? point : before;
  }
  if (!before)
  {
    const StudyPoint& first = *front.front();
    words.push_back("No more time halves the error here: from " + point_name(study, first) + " to " +
      point_name(study, last) + " it falls to " +
      percent(last.errors.rms / first.errors.rms) + " for " +
      figure(last.timing.median / first.timing.median, 2) + " times the time.");
    return words;
  }
  const double price = price_of_halving(
    before->timing.median, before->errors.rms, last.timing.median, last.errors.rms);
  words.push_back("The last halving of the error cost " + figure(price, 2) + " times the time: " +
    point_name(study, *before) + " (" + cost_words(*before) + ") against " + point_name(study, last) + " (" +
    cost_words(last) + "), " + figure(before->errors.rms / last.errors.rms, 2) + " times less error for " +
    figure(last.timing.median / before->timing.median, 2) + " times the time.");
  return words;
}

/// "too dark by 34 % in thick cores" for each class, and "right within …" where nothing is shown.
std::string depth_words(const std::vector<ClassError>& errors, const ErrorClasses& classes)
{
  std::string wrong;
  std::string right;
  for (std::size_t i = 0; i < errors.size(); ++i)
  {
    if (classes.pixels[i] == 0 || !std::isfinite(errors[i].mean_shift))
    {
      continue;
    }
    const double shift = errors[i].mean_shift;
    const double uncertain = 2.0 * errors[i].mean_shift_error;
    const double brightness = classes.brightness[i];
    const double part = brightness > 0.0 ? std::abs(shift) / brightness : 0.0;
    if (std::abs(shift) <= uncertain || part < least_bias)
    {
      right += (right.empty() ? "" : ", ") + classes.names[i];
      continue;
    }
    wrong += (wrong.empty() ? "" : ", ") + std::string(shift < 0.0 ? "too dark by " : "too bright by ") +
      percent(part) + " in " + classes.names[i];
  }
  if (wrong.empty())
  {
    return right.empty() ? "" : "in the mean within " + percent(least_bias) + " at all depths";
  }
  return wrong + (right.empty() ? "" : ", within " + percent(least_bias) + " in " + right);
}

/// Where the squared error is gathered; empty where it is nowhere.
std::string place_words(const Study& study,
  const std::vector<ClassError>& by_depth,
  const std::vector<ClassError>& by_outline)
{
  const double steep = share_of_class(by_outline, study.outlines, 0);
  if (steep >= telling_share)
  {
    return percent(steep) + " of the squared error lies on outlines, a tenth of the matter";
  }
  std::size_t matter = 0;
  for (const std::size_t pixels : study.depths.pixels)
  {
    matter += pixels;
  }
  for (std::size_t i = 0; i < by_depth.size(); ++i)
  {
    const double share = share_of_class(by_depth, study.depths, i);
    const double even = matter ? double(study.depths.pixels[i]) / double(matter) : 0.0;
    if (share >= telling_share && share >= 1.5 * even)
    {
      return percent(share) + " of the squared error lies in " + study.depths.names[i] + ", which are " +
        percent(even) + " of the matter";
    }
  }
  return "";
}

std::string knob_title(const Study& study, const std::string& name)
{
  for (const StudyKnob& knob : study.knobs)
  {
    if (knob.name == name)
    {
      return knob.title;
    }
  }
  return name;
}

/// What one setting gets wrong and where. Against its knob's finest setting where there is one.
std::string point_words(const Study& study, const StudyPoint& point)
{
  const bool own = point.own.has_value();
  const auto& by_depth = own ? point.own_by_depth : point.by_depth;
  const auto& by_outline = own ? point.own_by_outline : point.by_outline;
  const double rms = own ? point.own->rms : point.errors.rms;
  const std::string depth = point.by_chance ? "noise alone" : depth_words(by_depth, study.depths);
  const std::string place = rms > 0.0 ? place_words(study, by_depth, by_outline) : "";
  std::string words = point_name(study, point) + (own ? " by itself" : "") + " is off by " + over_255(rms) +
    " RMS in " + seconds_text(point.timing.median);
  if (!own && point.errors.rms_limited)
  {
    words = point_name(study, point) + " is off by no more than the truth can tell, " +
      over_255(point.errors.rms_upper) + " RMS, in " + seconds_text(point.timing.median);
    return words + ".";
  }
  words += depth.empty() ? "" : ": " + depth;
  words += place.empty() ? "" : "; " + place;
  return words + ".";
}

/// What settings of a knob are compared within: "volume" of "volume 4 voxels"; empty for numbers.
std::string kind_of(const StudyPoint& point)
{
  const std::string first = point.setting.substr(0, point.setting.find_first_of(" ,"));
  return first.find_first_of("0123456789") == std::string::npos ? first : "";
}

/// Of each kind of a knob's settings the one with the largest error, and the knob's best one that is not
/// the measure of the others.
std::vector<std::string> knob_words(const Study& study)
{
  std::vector<std::string> words;
  for (const StudyKnob& knob : study.knobs)
  {
    if (knob.name == "combined")
    {
      continue; // of several knobs: what each gets wrong is told of each
    }
    std::vector<const StudyPoint*> drawn;
    for (const StudyPoint& point : study.points)
    {
      const bool measurable = point.skipped.empty() && std::isfinite(point.errors.measured.rms);
      if (measurable && point.knob == knob.name && !point.finest)
      {
        drawn.push_back(&point);
      }
    }
    if (drawn.empty())
    {
      continue;
    }
    const auto error = [](const StudyPoint* p) { return p->own ? p->own->rms : p->errors.rms; };
    const auto by_error = [&](const StudyPoint* a, const StudyPoint* b) { return error(a) < error(b); };
    const StudyPoint* best = *std::min_element(drawn.begin(), drawn.end(), by_error);
    std::vector<const StudyPoint*> told;
    for (const StudyPoint* point : drawn)
    {
      const auto worst = std::find_if(told.begin(), told.end(),
        [&](const StudyPoint* other) { return kind_of(*other) == kind_of(*point); });
      if (worst == told.end())
      {
        told.push_back(point);
      }
      else if (by_error(*worst, point))
      {
        *worst = point;
      }
    }
    if (std::find(told.begin(), told.end(), best) == told.end())
    {
      told.push_back(best);
    }
    std::string text;
    for (const StudyPoint* point : told)
    {
      text += (text.empty() ? "" : " ") + point_words(study, *point);
    }
    words.push_back(text);
  }
  return words;
}

/// Whether what was asked for was kept, and what it cost.
std::vector<std::string> promise_words(const Study& study)
{
  std::vector<std::string> words;
  for (const StudyPoint& point : study.points)
  {
    if (!point.skipped.empty())
    {
      continue;
    }
    if (point.asked_tolerance > 0.0)
    {
      const double share =
        share_within(point.picture, study.truth.truth.picture, point.asked_tolerance);
      const bool kept = share >= 0.999;
      const bool untold = !kept && study.truth.noise.percentile_999 > 0.5 * point.asked_tolerance;
      std::string text = point_name(study, point) + ": " + percent(share) + " of the pixels are within " +
        figure(point.asked_tolerance) + " of white, which " +
        (kept         ? "keeps it"
            : untold ? "the truth is too noisy to judge"
                     : "misses it: 99.9 % were asked for");
      if (const StudyPoint* other = cheapest_within(study, point.asked_tolerance, &point))
      {
        text += "; it took " + figure(point.timing.median / other->timing.median, 2) +
          " times as long as the cheapest other setting that keeps it, " + point_name(study, *other) +
          " (" + seconds_text(other->timing.median) + ")";
      }
      words.push_back(text + ".");
    }
    if (point.asked_seconds > 0.0)
    {
      words.push_back(point_name(study, point) + ": it took " + seconds_text(point.timing.median) +
        ", " + percent(point.timing.median / point.asked_seconds) + " of what it was given.");
    }
  }
  return words;
}

}

std::string point_name(const Study& study, const StudyPoint& point)
{
  return knob_title(study, point.knob) + " " + point.setting;
}

double price_of_halving(double from_seconds, double from_error, double to_seconds, double to_error)
{
  if (!(from_seconds > 0.0) || !(to_seconds > from_seconds) || !(to_error > 0.0) ||
    !(from_error > to_error) || !std::isfinite(from_error))
  {
    return 0.0;
  }
  return std::exp(std::log(to_seconds / from_seconds) * std::log(2.0) / std::log(from_error / to_error));
}

std::vector<std::string> study_words(const Study& study)
{
  std::vector<std::string> words{ truth_words(study) };
  for (const auto& more : { front_words(study), knob_words(study), promise_words(study) })
  {
    words.insert(words.end(), more.begin(), more.end());
  }
  return words;
}

}
