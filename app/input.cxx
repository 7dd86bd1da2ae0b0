#include "input.h"

#include "command.h"
#include "interruption.h"
#include "progress.h"

#include "vtkBrumeImageReader.h"

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
    known += (known.empty() ? "" : ", ") + std::string(sample.name);
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

Input open_input(const std::string& spec, const Progress& progress)
{
  const std::string prefix = "sample:";
  if (spec.compare(0, prefix.size(), prefix) == 0)
  {
    return make_sample(spec.substr(prefix.size()), progress);
  }
  vtkNew<vtkCallbackCommand> ear;
  ear->SetClientData(const_cast<Progress*>(&progress));
  ear->SetCallback(hear);
  vtkNew<vtkBrumeImageReader> reader;
  reader->AddObserver(vtkCommand::ErrorEvent, ear);
  reader->AddObserver(vtkCommand::ProgressEvent, ear);
  reader->SetFileName(spec.c_str());
  reader->Update();
  InterruptionWatch::check(spec.c_str());
  if (*reader->GetErrorMessage())
  {
    // "FILE: what is wrong: what to do", as Failure has it.
    throw Failure(reader->GetErrorMessage());
  }
  Input input;
  input.image = reader->GetOutput();
  input.name = std::filesystem::path(spec).filename().string();
  input.format = reader->GetFormat();
  input.length_unit = reader->GetLengthUnit();
  input.value_unit = reader->GetValueUnit();
  input.patient_axes = reader->GetPatientAxes();
  for (int i = 0; i < reader->GetNumberOfMessages(); ++i)
  {
    input.messages.push_back(reader->GetMessage(i));
  }
  return input;
}

Input open_input_with_bar(const std::string& spec, bool quiet)
{
  ProgressBar bar("reading", !quiet);
  return open_input(spec, [&bar](double done) { bar.update(done); });
}

}
