// Uses the installed package as a stranger would: draws a volume with no window, and checks a pixel
// against Beer and Lambert's law; then lights it, and checks the light that it scatters.
#include <vtkBrumeMedium.h>
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

  // The same matter, under a headlight, over black: albedo · colour / 4 · ∫ σ e^(−2 σ s) ds, which
  // is (1 − 1/16) / 2 through the whole cube.
  vtkNew<vtkBrumeMedium> medium;
  medium->SetAlbedo(0.8);
  mapper->SetMedium(medium);
  const double black[3] = { 0.0, 0.0, 0.0 };
  if (!mapper->RenderImage(volume, camera, nullptr, 33, 33, black, picture))
  {
    return 1;
  }
  const double colours[3] = { 1.0, 0.5, 0.0 };
  for (int c = 0; c < 3; ++c)
  {
    const double lit = picture->GetScalarComponentAsDouble(16, 16, 0, c);
    const double scattered = 0.8 * colours[c] / 4.0 * (1.0 - 1.0 / 16.0) / 2.0;
    std::cout << lit << '\n';
    if (std::abs(lit - scattered) > 0.004)
    {
      std::cerr << "lit channel " << c << " should be " << scattered << '\n';
      return 1;
    }
  }
  return 0;
}
