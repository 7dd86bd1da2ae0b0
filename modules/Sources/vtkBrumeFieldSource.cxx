#include "vtkBrumeFieldSource.h"

#include "vtkBrumeSourceTools.h"
#include "vtkBrumeSparseVolume.h"

#include "data-generators/field.h"
#include "data-generators/sparse_sampling.h"

#include "vtkDataArray.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkImageData.h"
#include "vtkInformationVector.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <exception>

vtkBrumeFieldSource::vtkBrumeFieldSource()
{
  this->SetNumberOfInputPorts(0);
}

vtkBrumeFieldSource::~vtkBrumeFieldSource() = default;

vtkBrumeSparseVolume* vtkBrumeFieldSource::GetSparseOutput()
{
  return vtkBrumeSparseVolume::SafeDownCast(this->GetOutputDataObject(0));
}

vtkMTimeType vtkBrumeFieldSource::GetFieldMTime()
{
  return this->GetMTime();
}

const brume::Field& vtkBrumeFieldSource::GetField()
{
  const vtkMTimeType changed = this->GetFieldMTime();
  if (!this->Kept || this->KeptTime != changed)
  {
    this->Kept = this->MakeField();
    this->KeptTime = changed;
  }
  return *this->Kept;
}

int vtkBrumeFieldSource::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject"); // which one: ProcessRequest
  return 1;
}

vtkTypeBool vtkBrumeFieldSource::ProcessRequest(vtkInformation* request,
  vtkInformationVector** inputs,
  vtkInformationVector* outputs)
{
  if (!request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT()))
  {
    return this->Superclass::ProcessRequest(request, inputs, outputs);
  }
  vtkInformation* info = outputs->GetInformationObject(0);
  if (this->Sparse && !vtkBrumeSparseVolume::GetData(info))
  {
    vtkNew<vtkBrumeSparseVolume> volume;
    info->Set(vtkDataObject::DATA_OBJECT(), volume);
  }
  else if (!this->Sparse && !vtkImageData::GetData(info))
  {
    vtkNew<vtkImageData> image;
    info->Set(vtkDataObject::DATA_OBJECT(), image);
  }
  return 1;
}

int vtkBrumeFieldSource::RequestInformation(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  try
  {
    brume::describe_grid(brume::grid_over(this->GetField().bounds(), this->Size), VTK_FLOAT, info);
    brume::describe_time(this->StartTime, this->EndTime, this->NumberOfTimeSteps, info);
  }
  catch (const std::exception& problem)
  {
    vtkErrorMacro("the settings make no volume: " << problem.what());
    return 0;
  }
  return 1;
}

int vtkBrumeFieldSource::RequestData(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  const double time = brume::requested_time(info, this->Time);
  vtkDataObject* output = info->Get(vtkDataObject::DATA_OBJECT());
  try
  {
    const brume::Field& field = this->GetField();
    const brume::Lattice grid = brume::grid_over(field.bounds(), this->Size);
    if (vtkBrumeSparseVolume* volume = vtkBrumeSparseVolume::SafeDownCast(output))
    {
      volume->Initialize();
      if (info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER()) > 0)
      {
        return 1;
      }
      const brume::SparseSample sample =
        brume::sample_sparse(field, time, grid, {}, brume::progress_of(this));
      if (sample.stopped)
      {
        info->Set(vtkDemandDrivenPipeline::DATA_NOT_GENERATED(), 1); // the next update starts over
        return 1;
      }
      vtkNew<vtkMatrix4x4> index_to_world;
      for (int axis = 0; axis < 3; ++axis)
      {
        index_to_world->SetElement(axis, axis, grid.spacing[axis]);
        index_to_world->SetElement(axis, 3, grid.origin[axis]);
      }
      volume->SetIndexToWorld(index_to_world);
      volume->SetName("density");
      volume->SetVoxels(sample.voxels);
      volume->SetActiveVoxelCount(sample.active_voxels);
    }
    else
    {
      vtkImageData* image = vtkImageData::SafeDownCast(output);
      this->AllocateOutputData(image, info);
      image->GetPointData()->GetScalars()->SetName("density");
      const brume::Extent block = brume::extent_of(image->GetExtent());
      if (block.voxels() > 0 && !brume::sample(field,
                                  time,
                                  grid,
                                  block,
                                  static_cast<float*>(image->GetScalarPointer()),
                                  brume::progress_of(this)))
      {
        image->Initialize();
      }
    }
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
  }
  catch (const std::exception& problem)
  {
    output->Initialize();
    vtkErrorMacro("the volume could not be made: " << problem.what());
    return 0;
  }
  return 1;
}

void vtkBrumeFieldSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Size: " << this->Size << " voxels\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "Time: " << this->Time << " s\n";
  os << indent << "StartTime: " << this->StartTime << " s\n";
  os << indent << "EndTime: " << this->EndTime << " s\n";
  os << indent << "NumberOfTimeSteps: " << this->NumberOfTimeSteps << "\n";
  os << indent << "Sparse: " << (this->Sparse ? "on" : "off") << "\n";
}
