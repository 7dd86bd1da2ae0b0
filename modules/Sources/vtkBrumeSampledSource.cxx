#include "vtkBrumeSampledSource.h"

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

vtkBrumeSampledSource::vtkBrumeSampledSource()
{
  this->SetNumberOfInputPorts(0);
}

vtkBrumeSampledSource::~vtkBrumeSampledSource() = default;

vtkBrumeSparseVolume* vtkBrumeSampledSource::GetSparseOutput()
{
  return vtkBrumeSparseVolume::SafeDownCast(this->GetOutputDataObject(0));
}

vtkMTimeType vtkBrumeSampledSource::GetFieldMTime()
{
  return this->GetMTime();
}

const brume::Field& vtkBrumeSampledSource::GetField()
{
  const vtkMTimeType changed = this->GetFieldMTime();
  if (!this->Kept || this->KeptTime != changed)
  {
    this->Kept = this->MakeField();
    this->KeptTime = changed;
  }
  return *this->Kept;
}

int vtkBrumeSampledSource::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject"); // which one: ProcessRequest
  return 1;
}

const char* vtkBrumeSampledSource::GetFieldName() const
{
  return "density";
}

float vtkBrumeSampledSource::GetFieldBackground() const
{
  return 0.0f;
}

int vtkBrumeSampledSource::GetFieldGridClass() const
{
  return vtkBrumeSparseVolume::GridClassFogVolume;
}

void vtkBrumeSampledSource::DescribeTime(vtkInformation*) {}

double vtkBrumeSampledSource::GetMoment(vtkInformation*)
{
  return 0.0;
}

bool vtkBrumeSampledSource::Prepare(const brume::Field&, double)
{
  return true;
}

double vtkBrumeSampledSource::GetPreparedShare() const
{
  return 0.0;
}

bool vtkBrumeSampledSource::FillImage(vtkImageData* image,
  const brume::Field& field,
  const brume::Lattice& grid,
  double time)
{
  return brume::sample(field,
    time,
    grid,
    brume::extent_of(image->GetExtent()),
    static_cast<float*>(image->GetScalarPointer()),
    brume::progress_of(this));
}

vtkTypeBool vtkBrumeSampledSource::ProcessRequest(vtkInformation* request,
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

int vtkBrumeSampledSource::RequestInformation(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  try
  {
    brume::describe_grid(brume::grid_over(this->GetField().bounds(), this->Size), VTK_FLOAT, info);
    this->DescribeTime(info);
  }
  catch (const std::exception& problem)
  {
    vtkErrorMacro("the settings make no volume: " << problem.what());
    return 0;
  }
  return 1;
}

int vtkBrumeSampledSource::RequestData(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  const double time = this->GetMoment(info);
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
      brume::SparseSampleOptions options;
      options.background = this->GetFieldBackground();
      const brume::SparseSample sample =
        this->Prepare(field, time)
          ? brume::sample_sparse(
              field, time, grid, options, brume::progress_of(this, this->GetPreparedShare()))
          : brume::SparseSample{ nullptr, 0, true };
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
      volume->SetName(this->GetFieldName());
      volume->SetGridClass(this->GetFieldGridClass());
      volume->SetVoxels(sample.voxels);
      volume->SetActiveVoxelCount(sample.active_voxels);
    }
    else
    {
      vtkImageData* image = vtkImageData::SafeDownCast(output);
      this->AllocateOutputData(image, info);
      image->GetPointData()->GetScalars()->SetName(this->GetFieldName());
      const brume::Extent block = brume::extent_of(image->GetExtent());
      if (block.voxels() > 0 &&
          !(this->Prepare(field, time) && this->FillImage(image, field, grid, time)))
      {
        image->Initialize();
      }
    }
    if (info->Has(vtkStreamingDemandDrivenPipeline::TIME_RANGE()))
    {
      output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    }
  }
  catch (const std::exception& problem)
  {
    output->Initialize();
    vtkErrorMacro("the volume could not be made: " << problem.what());
    return 0;
  }
  return 1;
}

void vtkBrumeSampledSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Size: " << this->Size << " voxels\n";
  os << indent << "Sparse: " << (this->Sparse ? "on" : "off") << "\n";
}
