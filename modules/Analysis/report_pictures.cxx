// The pictures of the report, as data URIs.
#include "report_context.h"

#include "difference_picture.h"
#include "figures.h"
#include "report_parts.h"

#include <cmath>
#include <stdexcept>

namespace brume
{

namespace
{

using Json = nlohmann::ordered_json;

/// An id within the page, made of nothing that HTML or a link would mind.
std::string id_of(const ComparisonEntry& entry, std::size_t index)
{
  std::string id = std::to_string(index + 1);
  for (const char c : entry.mapper)
  {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
    id += (id.size() == 1 ? "-" : "") + std::string(plain ? 1 : 0, c);
  }
  return id;
}

std::string error_words(const ImageErrors& errors)
{
  return "mean " + over_255(errors.mean_absolute) + ", 99.9th percentile " +
    over_255(errors.percentile_999) + ", largest " + over_255(errors.largest);
}

Json difference_json(const std::string& id, const std::string& title,
  const DifferencePicture& difference, const ImageErrors& errors)
{
  Json json = picture_json(id, title, difference.bitmap);
  json["gain"] = figure(difference.gain, 10);
  json["scale_end"] = figure(255.0 / difference.gain);
  json["alt"] = "Absolute difference of " + title + " from the truth, amplified " +
    figure(difference.gain, 10) + " times; " + error_words(errors);
  json["figures"] = error_words(errors);
  if (difference.non_finite_pixels > 0)
  {
    json["figures"] = json["figures"].get<std::string>() + "; " +
      std::to_string(difference.non_finite_pixels) +
      (difference.non_finite_pixels == 1 ? " pixel" : " pixels") + " not finite";
  }
  return json;
}

void check_size(const Picture& picture, const Picture& other, const std::string& title)
{
  if (picture.width != other.width || picture.height != other.height)
  {
    throw std::invalid_argument("report: the picture of " + title +
      " differs in size from the others: draw all at one resolution");
  }
}

}

void add_pictures(Json& context, const Comparison& comparison)
{
  const Picture& truth = comparison.truth.picture;
  const bool has_truth = !truth.rgb.empty();
  std::vector<ImageErrors> drawn;
  const Picture* first = has_truth ? &truth : nullptr;
  for (const ComparisonEntry& entry : comparison.entries)
  {
    if (entry.skipped.empty())
    {
      drawn.push_back(entry.against_truth);
      first = first ? first : &entry.picture;
      check_size(entry.picture, *first, title_of(entry));
    }
  }
  const double gain = shared_gain(drawn);

  Json pictures = Json::array();
  Json differences = Json::array();
  Json own_gains = Json::array();
  std::size_t non_finite = 0;
  for (std::size_t i = 0; i < comparison.entries.size(); ++i)
  {
    const ComparisonEntry& entry = comparison.entries[i];
    if (!entry.skipped.empty())
    {
      continue;
    }
    const std::string id = id_of(entry, i);
    const std::string title = title_of(entry);
    Json picture =
      picture_json(id, title, to_bitmap(entry.picture, comparison.display_curve, comparison.exposure));
    picture["class_name"] = entry.class_name;
    picture["alt"] = "The scene as " + title + " draws it";
    picture["figures"] = seconds_text(entry.timing.median) +
      (entry.against_truth.values ? ", mean error " + over_255(entry.against_truth.mean_absolute)
                                  : std::string());
    pictures.push_back(picture);
    if (!has_truth)
    {
      continue;
    }
    const DifferencePicture shared =
      difference_picture(entry.picture, truth, DifferenceKind::Absolute, gain);
    differences.push_back(difference_json(id, title, shared, entry.against_truth));
    non_finite += shared.non_finite_pixels;
    if (automatic_gain(entry.against_truth) >= 4.0 * gain)
    {
      own_gains.push_back(difference_json(id, title,
        difference_picture(entry.picture, truth, DifferenceKind::Absolute,
          automatic_gain(entry.against_truth)),
        entry.against_truth));
    }
  }
  if (has_truth)
  {
    Json picture = picture_json("truth", "Truth", to_bitmap(truth, comparison.display_curve, comparison.exposure));
    picture["alt"] = "The scene as the truth has it";
    picture["figures"] = seconds_text(comparison.truth.seconds) + ", remaining mean error " +
      over_255(comparison.truth.remaining_mean);
    pictures.push_back(picture);
  }
  context["has_differences"] = !differences.empty();
  context["has_own_gains"] = !own_gains.empty();
  context["pictures"] = std::move(pictures);
  context["differences"] = std::move(differences);
  context["own_gains"] = std::move(own_gains);
  context["non_finite"] = non_finite > 0;
  context["display_note"] = display_note(comparison.display_curve, comparison.exposure);
  add_legend(context, DifferenceKind::Absolute, gain);
}

}
