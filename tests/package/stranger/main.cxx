// Uses the installed package as a stranger would: draws a volume with no window, and checks a pixel
// against Beer and Lambert's law.
#include <vtkBrumeRayMarchMapper.h>

#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cmath>
#include <iostream>

int main()
{
  // A cube of edge 16 whose every stretch of 8 hides half.
  vtkNew<vtkImageData> image;
  image->SetDimensions(17, 17, 17);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  auto* voxels = static_cast<unsigned char*>(image->GetScalarPointer());
  std::fill(voxels, voxels + image->GetNumberOfPoints(), static_cast<unsigned char>(100));

  vtkNew<vtkColorTransferFunction> colour;
  colour->AddRGBPoint(100.0, 1.0, 0.5, 0.0);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(100.0, 0.5);
  vtkNew<vtkVolumeProperty> property;
  property->SetColor(colour);
  property->SetScalarOpacity(opacity);
  property->SetScalarOpacityUnitDistance(8.0);

  vtkNew<vtkBrumeRayMarchMapper> mapper;
  mapper->SetInputData(image);
  vtkNew<vtkVolume> volume;
  volume->SetMapper(mapper);
  volume->SetProperty(property);

  vtkNew<vtkCamera> camera;
  camera->SetFocalPoint(8.0, 8.0, 8.0);
  camera->SetPosition(8.0, 8.0, 60.0);
  camera->ParallelProjectionOn();
  camera->SetParallelScale(12.0);
  vtkBrumeVolumeMapper::ResetClippingRange(volume, camera);

  const double background[3] = { 0.0, 0.0, 1.0 };
  vtkNew<vtkImageData> picture;
  if (!mapper->RenderImage(volume, camera, nullptr, 33, 33, background, picture))
  {
    return 1;
  }
  // Through the whole cube a quarter of the background passes.
  const double expected[3] = { 0.75, 0.375, 0.25 };
  for (int c = 0; c < 3; ++c)
  {
    const double middle = picture->GetScalarComponentAsDouble(16, 16, 0, c);
    const double corner = picture->GetScalarComponentAsDouble(0, 0, 0, c);
    std::cout << middle << ' ' << corner << '\n';
    if (std::abs(middle - expected[c]) > 1e-5 || corner != background[c])
    {
      std::cerr << "channel " << c << " should be " << expected[c] << " and " << background[c]
                << '\n';
      return 1;
    }
  }
  return 0;
}
