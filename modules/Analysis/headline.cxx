#include "headline.h"

#include "figures.h"

#include <cmath>

namespace brume
{

namespace
{

constexpr double same_within = 0.05;

enum class Outcome
{
  Gain,
  Same,
  Loss,
  Unknown,
};

struct Clause
{
  Outcome outcome = Outcome::Unknown;
  std::string words;
};

std::string name_of(const ComparisonEntry& entry)
{
  return entry.title.empty() ? entry.mapper : entry.title;
}

bool same(double a, double b)
{
  return std::abs(a - b) <= same_within * std::min(std::abs(a), std::abs(b));
}

/// "1.9 times", from 10 on without decimals.
std::string times(double ratio)
{
  return (ratio < 9.95 ? figure(ratio, 2) : figure(std::round(ratio), 6)) + " times";
}

/// A ratio below 1 as a part: "half", "a third", "1/17"; a percentage where no such part is near.
std::string part(double ratio)
{
  static const std::pair<double, const char*> parts[] = { { 1.0 / 2, "half" },
    { 1.0 / 3, "a third" }, { 2.0 / 3, "two thirds" }, { 1.0 / 4, "a quarter" },
    { 3.0 / 4, "three quarters" }, { 1.0 / 5, "a fifth" }, { 1.0 / 10, "a tenth" } };
  for (const auto& [value, words] : parts)
  {
    if (std::abs(ratio / value - 1.0) <= 0.04)
    {
      return words;
    }
  }
  if (ratio >= 0.2)
  {
    return figure(std::round(100.0 * ratio), 3) + " %";
  }
  return "1/" + figure(std::round(1.0 / ratio), 10);
}

bool within(double value, const Timing& timing)
{
  return value >= timing.min && value <= timing.max;
}

Clause speed(const ComparisonEntry& subject, const ComparisonEntry& reference)
{
  const Timing& ours = subject.timing;
  const Timing& theirs = reference.timing;
  const std::string other = name_of(reference) + " (" + seconds_text(theirs.median) + ")";
  if (!(ours.median > 0.0) || !(theirs.median > 0.0))
  {
    return { Outcome::Unknown, "where " + other + " was not timed alike" };
  }
  if (same(ours.median, theirs.median) ||
    (within(ours.median, theirs) && within(theirs.median, ours)))
  {
    return { Outcome::Same, "about as fast as " + other };
  }
  const double ratio = theirs.median / ours.median;
  return ratio > 1.0 ? Clause{ Outcome::Gain, times(ratio) + " as fast as " + other }
                     : Clause{ Outcome::Loss, times(1.0 / ratio) + " as long as " + other };
}

std::size_t non_finite(const ComparisonEntry& entry)
{
  return entry.against_truth.non_finite_test;
}

Clause accuracy(
  const ComparisonEntry& subject, const ComparisonEntry& reference, const Truth& truth)
{
  const double ours = subject.against_truth.mean_absolute;
  const double theirs = reference.against_truth.mean_absolute;
  const double floor = std::max(0.0, truth.remaining_mean);
  const std::string figures = " (" + over_255(ours) + " against " + over_255(theirs) + ")";
  if (ours <= floor && theirs <= floor)
  {
    return ours == 0.0 && theirs == 0.0
      ? Clause{ Outcome::Same, "no measurable error in either picture" }
      : Clause{ Outcome::Same,
          "mean errors that the truth, itself uncertain by " + over_255(floor) +
            ", cannot tell apart" + figures };
  }
  if (ours <= floor)
  {
    return { Outcome::Gain, "a mean error too small for the truth, itself uncertain by " +
        over_255(floor) + ", to resolve" + figures };
  }
  if (theirs <= floor)
  {
    return { Outcome::Loss, "a larger mean error" + figures };
  }
  if (same(ours, theirs))
  {
    return { Outcome::Same, "the same mean error" + figures };
  }
  return ours < theirs
    ? Clause{ Outcome::Gain, part(ours / theirs) + " of its mean error" + figures }
    : Clause{ Outcome::Loss, times(ours / theirs) + " its mean error" + figures };
}

/// A sentence for each picture with values that are not finite; empty for none.
std::string broken_pictures(const ComparisonEntry& subject, const ComparisonEntry* reference)
{
  std::string text;
  for (const ComparisonEntry* entry : { &subject, reference })
  {
    if (entry && non_finite(*entry) > 0)
    {
      text += " The picture of " + name_of(*entry) + " holds " +
        std::to_string(non_finite(*entry)) +
        (non_finite(*entry) == 1 ? " value that is not a finite number"
                                 : " values that are not finite numbers") +
        ", so its error is infinite.";
    }
  }
  return text;
}

std::string joined(const Clause& speed, const Clause& accuracy)
{
  const bool opposed = (speed.outcome == Outcome::Gain && accuracy.outcome == Outcome::Loss) ||
    (speed.outcome == Outcome::Loss && accuracy.outcome == Outcome::Gain);
  return speed.words + ", " + (opposed ? "but with " : "with ") + accuracy.words + ".";
}

}

std::string headline(const Comparison& comparison)
{
  const ComparisonEntry* subject = subject_of(comparison);
  if (!subject)
  {
    return "No mapper drew this scene.";
  }
  const ComparisonEntry* reference = find_drawn(comparison, comparison.reference_mapper);
  std::string text =
    name_of(*subject) + " drew this in " + seconds_text(subject->timing.median);
  const ImageErrors& errors = subject->against_truth;
  const bool measured = errors.values > 0;
  if (!reference || reference == subject)
  {
    if (measured && std::isfinite(errors.mean_absolute))
    {
      text += " with a mean error of " + over_255(errors.mean_absolute) +
        " and a largest of " + over_255(errors.largest);
    }
    return text + "." + broken_pictures(*subject, nullptr);
  }
  text += ", ";
  const Clause faster = speed(*subject, *reference);
  const bool comparable = measured && reference->against_truth.values > 0 &&
    std::isfinite(errors.mean_absolute) && std::isfinite(reference->against_truth.mean_absolute);
  text += comparable ? joined(faster, accuracy(*subject, *reference, comparison.truth))
                     : faster.words + ".";
  if (!reference->left_out.empty())
  {
    text += " The picture of " + name_of(*reference) + " holds " + left_out_words(*reference) +
      ", which its error counts.";
  }
  return text + broken_pictures(*subject, reference);
}

}
