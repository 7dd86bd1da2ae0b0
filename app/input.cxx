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
#include "vtkNew.h"
#include "vtkPointData.h"

#include <filesystem>

namespace brume::app
{

namespace
{

using Progress = std::function<void(double)>;

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

/// Updates a reader, and throws what it complains of as "FILE: what is wrong: what to do".
template <class Reader>
void read(Reader* reader, const std::string& path, const Progress& progress)
{
  vtkNew<vtkCallbackCommand> ear;
  ear->SetClientData(const_cast<Progress*>(&progress));
  ear->SetCallback(hear);
  reader->AddObserver(vtkCommand::ErrorEvent, ear);
  reader->AddObserver(vtkCommand::ProgressEvent, ear);
  reader->SetFileName(path.c_str());
  reader->Update();
  InterruptionWatch::check(path.c_str());
  if (*reader->GetErrorMessage())
  {
    throw Failure(reader->GetErrorMessage());
  }
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

Input open_image(const std::string& path, const Progress& progress)
{
  vtkNew<vtkBrumeImageReader> reader;
  read(reader.Get(), path, progress);
  Input input;
  input.image = reader->GetOutput();
  input.format = reader->GetFormat();
  input.length_unit = reader->GetLengthUnit();
  input.value_unit = reader->GetValueUnit();
  input.patient_axes = reader->GetPatientAxes();
  input.messages = messages_of(reader.Get());
  return input;
}

Input open_sparse(const std::string& path, const Progress& progress, const std::string& grid)
{
  vtkNew<vtkBrumeOpenVDBReader> reader;
  reader->SetGridName(grid.empty() ? nullptr : grid.c_str());
  read(reader.Get(), path, progress);
  Input input;
  input.sparse = reader->GetOutput();
  input.format = "OpenVDB";
  for (int i = 0; i < reader->GetNumberOfGrids(); ++i)
  {
    input.grids.push_back(std::string(reader->GetNameOfGrid(i)) + " (" +
      reader->GetTypeOfGrid(i) + ", " + reader->GetKindOfGrid(i) + ")");
  }
  input.messages = messages_of(reader.Get());
  return input;
}

}

Input open_input(const std::string& spec, const Progress& progress, const std::string& grid)
{
  const std::string prefix = "sample:";
  const bool sample = spec.compare(0, prefix.size(), prefix) == 0;
  const bool sparse = !sample && vtkBrumeOpenVDBReader::CanReadFile(spec.c_str());
  if (!grid.empty() && !sparse)
  {
    throw Failure("--grid " + grid, spec + " is not an OpenVDB file, which has grids to choose from",
      "leave it out", BadCall);
  }
  if (sample)
  {
    return make_sample(spec.substr(prefix.size()), progress);
  }
  Input input = sparse ? open_sparse(spec, progress, grid) : open_image(spec, progress);
  input.name = std::filesystem::path(spec).filename().string();
  return input;
}

Input open_input_with_bar(const std::string& spec, const std::string& grid, bool quiet)
{
  ProgressBar bar("reading", !quiet);
  return open_input(spec, [&bar](double done) { bar.update(done); }, grid);
}

}
