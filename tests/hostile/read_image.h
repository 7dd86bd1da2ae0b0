// What reading a path with vtkBrumeImageReader comes to.
#pragma once

#include "trial.h"

#include "vtkBrumeImageReader.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <stdexcept>
#include <string>

namespace hostile
{

/// Reads the first volume and, of a series, the last.
inline std::string read_image(const std::string& path)
{
  vtkNew<vtkCallbackCommand> silent;
  silent->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
  vtkNew<vtkBrumeImageReader> reader;
  reader->AddObserver(vtkCommand::ErrorEvent, silent);
  reader->SetMaximumMemory(memory_limit);
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  vtkInformation* info = reader->GetOutputInformation(0);
  auto* times = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
  const int steps = info->Has(times) ? info->Length(times) : 0;
  for (int step : { 0, steps - 1 })
  {
    if (steps == 0)
    {
      reader->Update();
    }
    else
    {
      reader->UpdateTimeStep(info->Get(times)[step]);
    }
    const std::string error = reader->GetErrorMessage();
    vtkImageData* image = reader->GetOutput();
    vtkDataArray* scalars = image->GetPointData()->GetScalars();
    if (!error.empty())
    {
      if (image->GetNumberOfPoints() != 0)
      {
        throw std::runtime_error("an error, and an image: " + error);
      }
      return error;
    }
    if (image->GetNumberOfPoints() < 1 || !scalars ||
      scalars->GetNumberOfTuples() != image->GetNumberOfPoints())
    {
      throw std::runtime_error(path + ": read, and no image");
    }
    double range[2];
    scalars->GetRange(range, 0); // every number is there to be read
    if (steps == 0)
    {
      break;
    }
  }
  return {};
}

inline Example alone(const std::string& name, const std::string& bytes)
{
  return { name, { { name, bytes } } };
}

}
