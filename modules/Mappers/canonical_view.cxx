// vtkBrumeVolumeMapper::CreateCanonicalView.
#include "vtkBrumeVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkVolume.h"

#include <algorithm>
#include <cmath>

void vtkBrumeVolumeMapper::CreateCanonicalView(vtkVolume* volume, vtkImageData* image,
  int blendMode, double viewDirection[3], double viewUp[3])
{
  int dims[3];
  image->GetDimensions(dims);
  if (!volume || dims[0] < 1 || dims[1] < 1 || !volume->GetBounds())
  {
    vtkErrorMacro("CreateCanonicalView needs a volume and an image of at least 1 x 1 pixels.");
    return;
  }
  // The view that VTK's mappers take.
  double bounds[6];
  volume->GetBounds(bounds);
  const double* centre = volume->GetCenter();
  const double distance = bounds[1] - bounds[0];
  vtkNew<vtkCamera> camera;
  camera->SetFocalPoint(centre);
  camera->ParallelProjectionOn();
  camera->SetPosition(centre[0] - distance * viewDirection[0],
    centre[1] - distance * viewDirection[1], centre[2] - distance * viewDirection[2]);
  camera->SetViewUp(viewUp);
  camera->SetParallelScale(0.5 * distance);
  ResetClippingRange(volume, camera);

  const int savedBlendMode = this->BlendMode;
  const vtkTypeBool savedCropping = this->Cropping;
  this->BlendMode = blendMode;
  this->Cropping = 0;
  const double black[3] = { 0.0, 0.0, 0.0 };
  vtkNew<vtkImageData> picture;
  const bool drawn =
    this->RenderImage(volume, camera, nullptr, dims[0], dims[1], black, picture);
  this->BlendMode = savedBlendMode;
  this->Cropping = savedCropping;
  if (!drawn)
  {
    return;
  }
  vtkDataArray* scalars = image->GetPointData()->GetScalars();
  if (!scalars || scalars->GetDataType() != VTK_UNSIGNED_CHAR ||
    scalars->GetNumberOfComponents() != 3)
  {
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  }
  vtkDataArray* rgb = picture->GetPointData()->GetScalars();
  auto* out = static_cast<unsigned char*>(image->GetScalarPointer());
  for (vtkIdType i = 0; i < rgb->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      *out++ = static_cast<unsigned char>(
        std::lround(255.0 * std::clamp(rgb->GetComponent(i, c), 0.0, 1.0)));
    }
  }
  image->GetPointData()->GetScalars()->Modified();
}
