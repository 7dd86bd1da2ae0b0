// brume info INPUT: what a volume is, before anything is drawn.
#include "command.h"
#include "input.h"
#include "optical_depth.h"
#include "option_checks.h"
#include "output_check.h"
#include "scene_options.h"
#include "volume_summary.h"

#include "atomic_file.h"
#include "orientation.h"

#include "Transport/sparse_voxels.h"

#include "vtkBrumeSparseVolume.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkPointData.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

namespace brume::app
{

namespace
{

using Json = nlohmann::ordered_json;

struct Options
{
  std::string input;
  InputChoice choice;
  std::string json;
  double extinction = 0.0; ///< 0: the values are not said to be a density
  bool quiet = false;
};

/// Up to six digits, and no trailing zeros.
std::string number(double value)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

std::string joined(const std::vector<double>& values, const char* between)
{
  std::string text;
  for (double value : values)
  {
    text += (text.empty() ? "" : between) + number(value);
  }
  return text;
}

std::string memory_size(double bytes)
{
  const char* units[] = { "bytes", "KiB", "MiB", "GiB", "TiB" };
  int unit = 0;
  while (bytes >= 1024 && unit < 4)
  {
    bytes /= 1024;
    ++unit;
  }
  return number(std::round(bytes * 10) / 10) + " " + units[unit];
}

/// JSON has no infinity and no NaN: null stands for them.
Json finite(double value)
{
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// What is told of every volume's values.
void add_values(const Input& input, const VolumeSummary& summary, Json& j)
{
  j["non_finite_voxels"] = summary.non_finite;
  Json percentiles = Json::object();
  for (std::size_t i = 0; i < summary.percentiles.size(); ++i)
  {
    percentiles["p" + std::to_string(percents()[i])] = finite(summary.percentiles[i]);
  }
  j["percentiles"] = percentiles;
  j["histogram"] = { { "minimum", finite(summary.minimum) },
    { "bin_width", finite(summary.bin_width) }, { "counts", summary.histogram } };
  j["messages"] = input.messages;
}

/// Of a sparse volume, with the same keys where they have a meaning.
Json describe_sparse(const Input& input, const VolumeSummary& summary)
{
  vtkBrumeSparseVolume* volume = input.sparse;
  const SparseVoxels& voxels = *volume->GetVoxels();
  const vtkMatrix4x4* matrix = volume->GetIndexToWorld();
  double spacing[3];
  volume->GetSpacing(spacing);
  // The box of what is stored, without the background around it.
  double first[4] = { 0, 0, 0, 1 };
  double middle[3];
  int dimensions[3];
  for (int a = 0; a < 3; ++a)
  {
    const int lower = voxels.first()[a] + 1;
    dimensions[a] = voxels.dims()[a] - 1 - lower;
    first[a] = voxels.origin()[a] + lower;
    middle[a] = lower + dimensions[a] / 2;
  }
  double corner[4];
  volume->GetIndexToWorld()->MultiplyPoint(first, corner);

  Json j;
  j["name"] = input.name;
  j["format"] = input.format;
  j["grid"] = volume->GetName();
  j["grids"] = input.grids;
  j["dimensions"] = { dimensions[0], dimensions[1], dimensions[2] };
  j["spacing"] = { spacing[0], spacing[1], spacing[2] };
  j["length_unit"] = input.length_unit;
  j["physical_size"] = Json::array();
  for (int a = 0; a < 3; ++a)
  {
    j["physical_size"].push_back(finite(dimensions[a] * spacing[a]));
  }
  j["origin"] = { finite(corner[0]), finite(corner[1]), finite(corner[2]) };
  std::array<double, 9> direction;
  for (int i = 0; i < 9; ++i)
  {
    direction[i] = matrix->GetElement(i / 3, i % 3) / spacing[i % 3];
  }
  j["patient_axes"] = input.patient_axes;
  j["orientation"] = input.patient_axes ? Json(anatomical_code(direction)) : Json(nullptr);
  j["direction"] = Json::array();
  for (int row = 0; row < 3; ++row)
  {
    j["direction"].push_back(
      { direction[3 * row], direction[3 * row + 1], direction[3 * row + 2] });
  }
  j["scalar_type"] = voxels.type() == VoxelType::Float16 ? "half" : "float";
  j["components"] = 1;
  j["value_unit"] = input.value_unit;
  double range[2];
  volume->GetValueRange(range);
  j["value_range"] = { finite(range[0]), finite(range[1]) };
  j["background"] = finite(voxels.background());
  j["mean"] = finite(summary.mean);
  j["standard_deviation"] = finite(summary.standard_deviation);
  j["center_value"] = finite(voxels.value(static_cast<int>(middle[0]),
    static_cast<int>(middle[1]), static_cast<int>(middle[2])));
  j["voxels"] = static_cast<std::uint64_t>(voxels.places().size()) * SparseVoxels::brick_voxels;
  j["active_voxels"] = static_cast<std::uint64_t>(volume->GetActiveVoxelCount());
  j["bricks"] = static_cast<std::uint64_t>(voxels.places().size());
  j["tiles"] = static_cast<std::uint64_t>(voxels.tiles().size());
  j["memory_bytes"] = static_cast<std::uint64_t>(voxels.memory_bytes());
  add_values(input, summary, j);
  return j;
}

/// All that is told, as the JSON file has it; the text is made from the same.
Json describe(const Input& input, const VolumeSummary& summary)
{
  vtkImageData* image = input.image;
  vtkDataArray* scalars = image->GetPointData()->GetScalars();
  const int components = scalars->GetNumberOfComponents();
  int dimensions[3];
  double spacing[3];
  double corner[3]; // the world place of the first voxel: an extent may not begin at 0
  image->GetDimensions(dimensions);
  image->GetSpacing(spacing);
  image->GetPoint(0, corner);
  std::array<double, 9> direction;
  std::copy_n(image->GetDirectionMatrix()->GetData(), 9, direction.begin());

  Json j;
  j["name"] = input.name;
  j["format"] = input.format;
  j["dimensions"] = { dimensions[0], dimensions[1], dimensions[2] };
  j["spacing"] = { spacing[0], spacing[1], spacing[2] };
  j["length_unit"] = input.length_unit;
  j["physical_size"] = Json::array();
  for (int a = 0; a < 3; ++a)
  {
    j["physical_size"].push_back(finite(dimensions[a] * spacing[a]));
  }
  j["origin"] = { finite(corner[0]), finite(corner[1]), finite(corner[2]) };
  j["patient_axes"] = input.patient_axes;
  j["orientation"] = input.patient_axes ? Json(anatomical_code(direction)) : Json(nullptr);
  j["direction"] = Json::array();
  for (int row = 0; row < 3; ++row)
  {
    j["direction"].push_back(
      { direction[3 * row], direction[3 * row + 1], direction[3 * row + 2] });
  }
  j["scalar_type"] = scalars->GetDataTypeAsString();
  j["components"] = components;
  j["value_unit"] = input.value_unit;
  j["value_range"] = { finite(summary.minimum), finite(summary.maximum) };
  j["mean"] = finite(summary.mean);
  j["standard_deviation"] = finite(summary.standard_deviation);
  int middle[3];
  int extent[6];
  image->GetExtent(extent);
  for (int a = 0; a < 3; ++a)
  {
    middle[a] = extent[2 * a] + dimensions[a] / 2;
  }
  j["center_value"] = finite(scalars->GetComponent(image->ComputePointId(middle), 0));
  j["voxels"] = static_cast<std::uint64_t>(image->GetNumberOfPoints());
  j["memory_bytes"] = static_cast<std::uint64_t>(scalars->GetNumberOfValues()) *
    static_cast<std::uint64_t>(scalars->GetDataTypeSize());
  add_values(input, summary, j);
  return j;
}

/// How deep the values are as a density.
void add_optical_depth(const Input& input, const Options& options, Json& j)
{
  const double extinction = options.extinction;
  const std::array<AxisDepth, 3> depths = input.sparse
    ? optical_depths(input.sparse.Get(), extinction, input.name,
        static_cast<std::uint64_t>(options.choice.max_memory))
    : optical_depths(input.image.Get(), extinction);
  Json axes = Json::array();
  for (const AxisDepth& depth : depths)
  {
    axes.push_back({ { "lines", depth.lines }, { "median", finite(depth.median) },
      { "largest", finite(depth.largest) } });
  }
  j["optical_depth"] = { { "extinction", extinction }, { "axes", axes } };
}

std::string value_text(const Json& value, const std::string& unit)
{
  return (value.is_null() ? "not finite" : number(value.get<double>())) +
    (unit.empty() ? "" : " " + unit);
}

std::string triple(const Json& values, const char* between)
{
  std::vector<double> numbers;
  for (const Json& v : values)
  {
    numbers.push_back(v.is_null() ? NAN : v.get<double>());
  }
  return joined(numbers, between);
}

void print(std::ostream& out, const Json& j, const VolumeSummary& summary)
{
  const std::string length = j["length_unit"].get<std::string>();
  const std::string lengths = length.empty() ? " (unit unknown)" : " " + length;
  const std::string unit = j["value_unit"].get<std::string>();
  const int components = j["components"].get<int>();
  const auto line = [&out](const char* label, const std::string& text)
  {
    char start[32];
    std::snprintf(start, sizeof(start), "%-20s", label);
    out << start << text << '\n';
  };
  line("name", j["name"].get<std::string>());
  line("format", j["format"].get<std::string>());
  const bool sparse = j.contains("active_voxels");
  if (sparse)
  {
    line("grid", j["grid"].get<std::string>());
    for (std::size_t i = 0; i < j["grids"].size(); ++i)
    {
      line(i == 0 ? "grids" : "", j["grids"][i].get<std::string>());
    }
  }
  line("dimensions", triple(j["dimensions"], " x ") + " voxels" + (sparse ? ", sparse" : ""));
  line("spacing", triple(j["spacing"], " x ") + lengths);
  line("physical size", triple(j["physical_size"], " x ") + lengths);
  line("origin", triple(j["origin"], ", ") + lengths);
  line("orientation", j["orientation"].is_null()
      ? "not known; axes as in the file"
      : j["orientation"].get<std::string>() + " (where each index axis grows; world is RAS+)");
  for (int row = 0; row < 3; ++row)
  {
    line(row == 0 ? "direction" : "", "[ " + triple(j["direction"][row], "  ") + " ]");
  }
  line("scalar type", j["scalar_type"].get<std::string>());
  line("components", std::to_string(components) +
      (components > 1 ? " (the figures below are of the first)" : ""));
  if (summary.finite == 0)
  {
    line("value range", "no finite value");
  }
  else
  {
    line("value range", value_text(j["value_range"][0], "") + " to " +
        value_text(j["value_range"][1], unit));
    line("mean", value_text(j["mean"], unit) + ", standard deviation " +
        value_text(j["standard_deviation"], unit));
  }
  line("center voxel", value_text(j["center_value"], unit));
  line("non-finite voxels", std::to_string(summary.non_finite));
  if (sparse)
  {
    line("background", value_text(j["background"], unit));
    line("active voxels", std::to_string(j["active_voxels"].get<std::uint64_t>()) + " in " +
        std::to_string(j["bricks"].get<std::uint64_t>()) + " bricks and " +
        std::to_string(j["tiles"].get<std::uint64_t>()) + " tiles");
  }
  line("memory", memory_size(j["memory_bytes"].get<double>()) +
      (sparse && j["active_voxels"] > 0
          ? ", " + number(j["memory_bytes"].get<double>() / j["active_voxels"].get<double>()) +
            " bytes an active voxel"
          : ""));
  std::string percentiles;
  for (const auto& [key, value] : j["percentiles"].items())
  {
    percentiles += (percentiles.empty() ? "" : "  ") + key.substr(1) + "%: " + value_text(value, "");
  }
  if (!percentiles.empty())
  {
    line("percentiles", percentiles);
    out << "histogram (bars: logarithm of the count)\n" << draw_histogram(summary, 72, terminal_takes_utf8());
  }
  if (j.contains("optical_depth"))
  {
    const Json& depth = j["optical_depth"];
    for (int axis = 0; axis < 3; ++axis)
    {
      const Json& along = depth["axes"][axis];
      line(axis == 0 ? "optical depth" : "",
        std::string("along axis ") + "ijk"[axis] + ": median " +
          value_text(along["median"], "") + ", largest " + value_text(along["largest"], "") +
          ", of " +
          std::to_string(along["lines"].get<std::uint64_t>()) + " lines of voxels that meet matter");
    }
  }
  for (const Json& message : j["messages"])
  {
    line("note", message.get<std::string>());
  }
}

void run(const Options& options)
{
  check_output(options.json, options.input);
  // Messages are part of what is told, so they are not written to standard error as well.
  const Input input = open_input_with_bar(options.input, options.choice, options.quiet);
  const VolumeSummary summary =
    input.sparse ? summarize(input.sparse.Get()) : summarize(input.image.Get());
  Json description = input.sparse ? describe_sparse(input, summary) : describe(input, summary);
  if (options.extinction > 0.0)
  {
    add_optical_depth(input, options, description);
  }
  if (!options.json.empty())
  {
    // A name may hold bytes that are no UTF-8: they are replaced, not an error.
    write_atomically(options.json,
      description.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  }
  print(std::cout, description, summary);
}

}

void add_info(CLI::App& program)
{
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("info",
    "Tell what a volume is: size, spacing, orientation, values and their histogram");
  options->choice.level_set = "distance";
  add_input(*command, options->input, options->choice);
  command->add_option("--json", options->json, "Write the same, as JSON, to FILE")
    ->type_name("FILE");
  command
    ->add_option("--extinction", options->extinction,
      "Take the values for a density and tell its optical depth along the three axes; per world unit "
      "and unit of density")
    ->check(number("a number greater than 0", [](double v) { return v > 0.0; }))
    ->type_name("S");
  command->add_flag("--quiet", options->quiet, "No progress bar");
  command->footer("Examples: brume info scan.nii.gz --json scan.json\n"
                  "          brume info cloud.vdb --extinction 0.05");
  command->callback([options] { run(*options); });
}

}
