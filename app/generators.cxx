#include "generators.h"

#include "command.h"
#include "interruption.h"

#include "vtkBrumeSparseVolume.h"

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"

namespace brume::app
{

namespace
{

/// What is heard from a source while it runs.
struct Ear
{
  const GeneratorRequest& request;
  std::string error;

  static void hear(vtkObject* caller, unsigned long event, void* client, void* data)
  {
    Ear& self = *static_cast<Ear*>(client);
    if (event == vtkCommand::ErrorEvent)
    {
      // "ERROR: In FILE, line N\nvtkClass (0x…): words\n\n"
      std::string text = data ? static_cast<const char*>(data) : "";
      const std::size_t place = text.find("): ");
      text = place == std::string::npos ? text : text.substr(place + 3);
      text = text.substr(0, text.find('\n'));
      self.error = self.error.empty() ? text : self.error;
      return;
    }
    auto* algorithm = static_cast<vtkAlgorithm*>(caller);
    if (self.request.progress)
    {
      self.request.progress(algorithm->GetProgress());
    }
    if (InterruptionWatch::requested())
    {
      algorithm->AbortExecuteOn();
    }
  }
};

}

const std::vector<Generator>& generators()
{
  static const std::vector<Generator> all = []
  {
    std::vector<Generator> list = cloud_generators();
    for (const Generator& generator : shape_generators())
    {
      list.push_back(generator);
    }
    return list;
  }();
  return all;
}

Input run_source(vtkAlgorithm* source, const GeneratorRequest& request)
{
  Ear ear{ request, {} };
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&ear);
  observer->SetCallback(&Ear::hear);
  source->AddObserver(vtkCommand::ProgressEvent, observer);
  source->AddObserver(vtkCommand::ErrorEvent, observer);
  source->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, observer);
  source->Update();
  source->RemoveObserver(observer);
  source->GetExecutive()->RemoveObserver(observer);
  InterruptionWatch::check("the volume");
  if (!ear.error.empty())
  {
    // A source says "what is wrong: what to do"; where it does not, a remedy is added.
    throw Failure("the volume",
      ear.error,
      ear.error.find(": ") == std::string::npos ? "change the options" : "see the kind's --help");
  }
  Input input;
  vtkDataObject* output = source->GetOutputDataObject(0);
  input.image = vtkImageData::SafeDownCast(output);
  input.sparse = vtkBrumeSparseVolume::SafeDownCast(output);
  const bool image = input.image && input.image->GetPointData()->GetScalars() &&
                     input.image->GetNumberOfPoints() > 0;
  if (!image && !(input.sparse && input.sparse->GetVoxels()))
  {
    throw Failure("the volume", "it is empty", "change the options");
  }
  return input;
}

}
