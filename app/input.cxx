#include "input.h"

#include "command.h"
#include "interruption.h"
#include "progress.h"

#include "vtkBrumeImageReader.h"
#include "vtkBrumeOpenVDBReader.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace brume::app
{

namespace
{

using Progress = std::function<void(double)>;

/// A file's or a folder's name without the folders around it.
std::string name_of(const std::string& spec)
{
  const std::filesystem::path path(spec);
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

Input make_sample(const std::string& name, const Progress& progress)
{
  std::string known;
  for (const Sample& sample : samples())
  {
    if (name == sample.name)
    {
      Input input = sample.make(progress);
      InterruptionWatch::check(("sample:" + name).c_str());
      input.name = "sample:" + name;
      input.format = "sample";
      return input;
    }
    known += (known.empty() ? "" : ", ") + sample.name;
  }
  throw Failure("sample:" + name, "there is no such sample",
    known.empty() ? "this build has none" : "choose one of " + known, BadCall);
}

/// Hears a reader in place of the standard error stream.
void hear(vtkObject* caller, unsigned long event, void* client, void*)
{
  const Progress& progress = *static_cast<const Progress*>(client);
  if (event == vtkCommand::ProgressEvent && progress)
  {
    progress(static_cast<vtkAlgorithm*>(caller)->GetProgress());
  }
  if (event == vtkCommand::ProgressEvent && InterruptionWatch::requested())
  {
    static_cast<vtkAlgorithm*>(caller)->AbortExecuteOn();
  }
}

}

vtkDataObject* Input::data() const
{
  return this->sparse ? static_cast<vtkDataObject*>(this->sparse) : this->image;
}

namespace
{

/// Takes what a reader knows of times after UpdateInformation(), and settles which is read.
void choose_time(vtkAlgorithm* reader, const std::string& path, const InputChoice& choice, Input& input)
{
  vtkInformation* info = reader->GetOutputInformation(0);
  if (info->Has(vtkStreamingDemandDrivenPipeline::TIME_STEPS()))
  {
    const double* times = info->Get(vtkStreamingDemandDrivenPipeline::TIME_STEPS());
    input.times.assign(times, times + info->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()));
  }
  const int count = static_cast<int>(input.times.size());
  if (choice.time_step && *choice.time_step >= std::max(count, 1))
  {
    throw Failure("--time-step " + std::to_string(*choice.time_step),
      count == 0 ? path + " holds one volume, not a series"
                 : path + " holds " + std::to_string(count) + " volumes",
      count == 0 ? "leave it out" : "take one from 0 to " + std::to_string(count - 1), BadCall);
  }
  if (choice.time && count == 0)
  {
    throw Failure("--time", path + " holds one volume, not a series", "leave it out", BadCall);
  }
  input.time_step = choice.time_step.value_or(0);
  if (choice.time)
  {
    const auto away = [&](double t) { return std::abs(t - *choice.time); };
    const auto nearest = std::min_element(input.times.begin(), input.times.end(),
      [&](double a, double b) { return away(a) < away(b); });
    input.time_step = static_cast<int>(nearest - input.times.begin());
  }
}

/// Puts the series of a folder, which an error without a choice lists in one line, on lines of their own.
void name_choices(vtkBrumeImageReader* reader, Failure& failure)
{
  const std::string message = failure.what();
  const std::size_t list = message.find("choose one with --series N (");
  const int count = reader->GetNumberOfSeries();
  if (list == std::string::npos || count < 1)
  {
    return;
  }
  failure = Failure(message.substr(0, list) + "choose one with --series N or its UID", BadCall);
  for (int i = 0; i < count; ++i)
  {
    failure.Choices.push_back("--series " + std::to_string(i + 1) + "  " +
      reader->GetNameOfSeries(i) + "  (" + reader->GetUIDOfSeries(i) + ")");
  }
}

void name_choices(vtkBrumeOpenVDBReader*, Failure&) {}

/// Throws what a reader complains of as "FILE: what is wrong: what to do".
template <class Reader>
void check(Reader* reader, const std::string& path)
{
  InterruptionWatch::check(path.c_str());
  if (*reader->GetErrorMessage())
  {
    Failure failure(reader->GetErrorMessage());
    name_choices(reader, failure);
    throw failure;
  }
}

/// Updates a reader to what `choice` says, and throws what it complains of. Puts what it tells of times
/// into `input`. `progress` must live as long as the reader is updated.
template <class Reader>
void read(Reader* reader, const std::string& path, const InputChoice& choice,
  const Progress& progress, Input& input)
{
  vtkNew<vtkCallbackCommand> ear;
  ear->SetClientData(const_cast<Progress*>(&progress));
  ear->SetCallback(hear);
  reader->AddObserver(vtkCommand::ErrorEvent, ear);
  reader->AddObserver(vtkCommand::ProgressEvent, ear);
  reader->SetFileName(path.c_str());
  reader->SetMaximumMemory(choice.max_memory);
  reader->UpdateInformation();
  if (!*reader->GetErrorMessage())
  {
    choose_time(reader, path, choice, input);
    if (input.times.empty())
    {
      reader->Update();
    }
    else
    {
      reader->UpdateTimeStep(input.times[input.time_step]);
    }
  }
  check(reader, path);
}

template <class Reader>
std::vector<std::string> messages_of(Reader* reader)
{
  std::vector<std::string> messages;
  for (int i = 0; i < reader->GetNumberOfMessages(); ++i)
  {
    messages.push_back(reader->GetMessage(i));
  }
  return messages;
}

/// What the reader has read, into `input`.
void take(vtkBrumeImageReader* reader, Input& input)
{
  input.time_unit = reader->GetTimeUnit();
  input.image = reader->GetOutput();
  input.format = reader->GetFormat();
  input.length_unit = reader->GetLengthUnit();
  input.value_unit = reader->GetValueUnit();
  input.patient_axes = reader->GetPatientAxes();
  input.messages = messages_of(reader);
}

Input open_image(const std::string& path, const InputChoice& choice, const Progress& progress)
{
  vtkNew<vtkBrumeImageReader> reader;
  reader->SetSeries(choice.series.empty() ? nullptr : choice.series.c_str());
  Input input;
  read(reader.Get(), path, choice, progress, input);
  take(reader, input);
  return input;
}

/// All volumes of an image over time, by one reader.
void visit_images(const std::string& path, const InputChoice& choice, const Progress& progress,
  const std::function<void(Input&)>& visit)
{
  vtkNew<vtkBrumeImageReader> reader;
  reader->SetSeries(choice.series.empty() ? nullptr : choice.series.c_str());
  Input first;
  read(reader.Get(), path, choice, progress, first);
  for (std::size_t step = 0; step == 0 || step < first.times.size(); ++step)
  {
    if (step > 0)
    {
      reader->UpdateTimeStep(first.times[step]);
      check(reader.Get(), path);
    }
    Input input;
    input.times = first.times;
    input.time_step = static_cast<int>(step);
    take(reader, input);
    // The visitor's own, which it may change and release.
    vtkNew<vtkImageData> image;
    image->ShallowCopy(input.image);
    input.image = image;
    input.name = name_of(path);
    reader->GetOutput()->Initialize();
    visit(input);
  }
}

Input open_sparse(const std::string& path, const InputChoice& choice, const Progress& progress)
{
  Input input;
  const auto open = [&](const std::string& grid)
  {
    vtkNew<vtkBrumeOpenVDBReader> reader;
    reader->SetGridName(grid.empty() ? nullptr : grid.c_str());
    reader->SetLevelSets(choice.chosen_level_set.value_or(choice.level_set) == "distance"
        ? vtkBrumeOpenVDBReader::LevelSetsAsDistances
        : vtkBrumeOpenVDBReader::LevelSetsAsFog);
    read(reader.Get(), path, choice, progress, input);
    return vtkSmartPointer<vtkBrumeOpenVDBReader>(reader);
  };
  const auto reader = open(choice.grid);
  input.sparse = reader->GetOutput();
  input.format = "OpenVDB";
  input.length_unit = reader->GetLengthUnit();
  input.value_unit = reader->GetValueUnit();
  input.patient_axes = reader->GetPatientAxes();
  for (int i = 0; i < reader->GetNumberOfGrids(); ++i)
  {
    input.grids.push_back(std::string(reader->GetNameOfGrid(i)) + " (" + reader->GetTypeOfGrid(i) +
      ", " + reader->GetKindOfGrid(i) + ")");
  }
  input.messages = messages_of(reader.Get());
  if (choice.all_grids && choice.grid.empty())
  {
    input.messages.clear(); // of which grid is taken: all are
    for (int i = 0; i < reader->GetNumberOfGrids(); ++i)
    {
      if (i == reader->GetGridIndex())
      {
        continue;
      }
      try
      {
        const std::string name = reader->GetNameOfGrid(i);
        input.more_sparse.push_back(open(name)->GetOutput());
      }
      catch (const Failure& failure)
      {
        InterruptionWatch::check(path.c_str());
        input.messages.push_back(std::string("left out: ") + failure.what());
      }
    }
  }
  return input;
}

}

namespace
{

const char Prefix[] = "sample:";

bool is_sample(const std::string& spec)
{
  return spec.compare(0, sizeof(Prefix) - 1, Prefix) == 0;
}

/// Throws where the input is of a kind that has not what is chosen.
void check_choice(const std::string& spec, const InputChoice& choice, bool sample, bool sparse)
{
  if (!choice.grid.empty() && !sparse)
  {
    throw Failure("--grid " + choice.grid, spec + " is not an OpenVDB file, which has grids to choose from",
      "leave it out", BadCall);
  }
  if (choice.chosen_level_set && !sparse)
  {
    throw Failure("--level-set " + *choice.chosen_level_set,
      spec + " is not an OpenVDB file, which may hold level sets", "leave it out", BadCall);
  }
  if (!choice.series.empty() && (sample || !std::filesystem::is_directory(spec)))
  {
    throw Failure("--series " + choice.series,
      spec + " is no folder, which may hold several series to choose from", "leave it out", BadCall);
  }
  if (sample && (choice.time || choice.time_step))
  {
    throw Failure(choice.time ? "--time" : "--time-step", spec + " is one volume, not a series",
      "leave it out", BadCall);
  }
}

}

Input open_input(const std::string& spec, const Progress& progress, const InputChoice& choice)
{
  const bool sample = is_sample(spec);
  const bool sparse = !sample && vtkBrumeOpenVDBReader::CanReadFile(spec.c_str());
  check_choice(spec, choice, sample, sparse);
  if (sample)
  {
    return make_sample(spec.substr(sizeof(Prefix) - 1), progress);
  }
  Input input = sparse ? open_sparse(spec, choice, progress) : open_image(spec, choice, progress);
  input.name = name_of(spec);
  return input;
}

void for_each_volume(const std::string& spec, const Progress& progress, const InputChoice& choice,
  const std::function<void(Input&)>& visit)
{
  InputChoice at = choice;
  at.time.reset();
  at.time_step.reset();
  if (!is_sample(spec) && !vtkBrumeOpenVDBReader::CanReadFile(spec.c_str()))
  {
    check_choice(spec, at, false, false);
    visit_images(spec, at, progress, visit);
    return;
  }
  std::size_t count = 1;
  for (std::size_t step = 0; step < count; ++step)
  {
    if (step > 0)
    {
      at.time_step = static_cast<int>(step);
    }
    Input input = open_input(spec, progress, at);
    count = std::max<std::size_t>(input.times.size(), 1);
    visit(input);
  }
}

Input open_input_with_bar(const std::string& spec, const InputChoice& choice, bool quiet)
{
  ProgressBar bar("reading", !quiet);
  return open_input(spec, [&bar](double done) { bar.update(done); }, choice);
}

}
