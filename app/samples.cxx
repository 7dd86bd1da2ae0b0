// The table of samples: volumes that are made on the spot.
#include "input.h"

#include "interruption.h"

#include "vtkBrumeCloudSource.h"
#include "vtkBrumeFogSource.h"
#include "vtkBrumePhantomSource.h"
#include "vtkBrumeSmokeSource.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkNew.h"

namespace brume::app
{

namespace
{

/// Runs a source to its end and hands out what it made.
vtkSmartPointer<vtkImageData> run(
  vtkImageAlgorithm* source, const std::function<void(double)>& progress)
{
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(const_cast<std::function<void(double)>*>(&progress));
  observer->SetCallback(
    [](vtkObject* caller, unsigned long, void* data, void*)
    {
      const auto& report = *static_cast<const std::function<void(double)>*>(data);
      if (report)
      {
        report(static_cast<vtkAlgorithm*>(caller)->GetProgress());
      }
      if (InterruptionWatch::requested())
      {
        static_cast<vtkAlgorithm*>(caller)->AbortExecuteOn();
      }
    });
  source->AddObserver(vtkCommand::ProgressEvent, observer);
  source->Update();
  vtkSmartPointer<vtkImageData> image = source->GetOutput();
  source->RemoveObserver(observer);
  return image;
}

Input head_ct(const std::function<void(double)>& progress)
{
  vtkNew<vtkBrumePhantomSource> source;
  Input input;
  input.image = run(source, progress);
  input.length_unit = "mm";
  input.value_unit = "HU";
  input.patient_axes = true;
  return input;
}

Input cloud(const std::function<void(double)>& progress)
{
  vtkNew<vtkBrumeCloudSource> source;
  Input input;
  input.image = run(source, progress);
  input.length_unit = "m";
  return input;
}

Input fog(const std::function<void(double)>& progress)
{
  vtkNew<vtkBrumeFogSource> source;
  source->SetKindToValley();
  Input input;
  input.image = run(source, progress);
  input.length_unit = "m";
  return input;
}

Input smoke(const std::function<void(double)>& progress)
{
  vtkNew<vtkBrumeSmokeSource> source;
  Input input;
  input.image = run(source, progress);
  input.length_unit = "m";
  return input;
}

}

const std::vector<Sample>& samples()
{
  static const std::vector<Sample> table{
    { "head-ct", "a head as a CT scanner sees it, in Hounsfield units", head_ct },
    { "cloud", "a cumulus of 2 km, density from 0 to 1", cloud },
    { "fog", "fog in a valley of 4 km, density from 0 to 1", fog },
    { "smoke", "a plume of hot smoke of 8 m, density from 0 to 1 and temperature", smoke },
  };
  return table;
}

}
