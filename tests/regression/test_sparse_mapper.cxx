// vtkBrumeRayMarchMapper on a vtkBrumeSparseVolume: the picture of the same voxels as image data.
#include "../support/sparse_grids.h"
#include "../support/vtk_scenes.h"

#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkFloatArray.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkTrivialProducer.h"

#include <gtest/gtest.h>

using namespace vtk_scenes;

namespace
{

constexpr int edge = 40;

/// The ball of vtk_scenes, cut to nothing below 5.
double value_at(int i, int j, int k)
{
  const double v = ball(2.0 * i / edge - 1.0, 2.0 * j / edge - 1.0, 2.0 * k / edge - 1.0);
  return v < 5.0 ? 0.0 : v;
}

/// Sparse, and the same as an image: turned, with uneven voxels, away from the origin.
struct Pair
{
  vtkNew<vtkBrumeSparseVolume> sparse;
  vtkNew<vtkImageData> image;

  Pair()
  {
    const std::shared_ptr<const brume::SparseVoxels> voxels =
      sparse_grids::make_sparse(brume::VoxelType::Float32,
        { { -8, -8, -8 } },
        { { edge + 8, edge + 8, edge + 8 } },
        0.0,
        value_at);
    const double c = std::cos(0.5), s = std::sin(0.5);
    const double direction[9] = { c, -s, 0, s, c, 0, 0, 0, 1 };
    const double spacing[3] = { 0.5, 0.75, 1.25 };
    const double origin[3] = { 30, -20, 7 };
    vtkNew<vtkMatrix4x4> matrix;
    for (int row = 0; row < 3; ++row)
    {
      for (int column = 0; column < 3; ++column)
      {
        matrix->SetElement(row, column, direction[3 * row + column] * spacing[column]);
      }
      matrix->SetElement(row, 3, origin[row]);
    }
    this->sparse->SetVoxels(voxels);
    this->sparse->SetIndexToWorld(matrix);

    const auto& first = voxels->first();
    const auto& last = voxels->dims();
    const auto& o = voxels->origin();
    this->image->SetExtent(o[0] + first[0],
      o[0] + last[0] - 1,
      o[1] + first[1],
      o[1] + last[1] - 1,
      o[2] + first[2],
      o[2] + last[2] - 1);
    this->image->SetSpacing(spacing);
    this->image->SetOrigin(origin);
    this->image->SetDirectionMatrix(direction);
    vtkNew<vtkFloatArray> scalars;
    for (int k = first[2]; k < last[2]; ++k)
      for (int j = first[1]; j < last[1]; ++j)
        for (int i = first[0]; i < last[0]; ++i)
          scalars->InsertNextValue(static_cast<float>(voxels->value(i, j, k)));
    this->image->GetPointData()->SetScalars(scalars);
  }
};

brume::Film draw(vtkDataObject* input,
  bool shade,
  double extinction,
  vtkBrumeRayMarchMapper* mapper,
  double bounds[6])
{
  mapper->SetInputDataObject(input);
  mapper->SetExtinction(extinction);
  mapper->AutoAdjustSampleDistancesOff();
  mapper->SetSampleDistance(0.3);
  auto volume = volume_of();
  volume->GetProperty()->SetShade(shade);
  volume->SetMapper(mapper);
  std::copy_n(volume->GetBounds(), 6, bounds);
  const double centre[3] = {
    0.5 * (bounds[0] + bounds[1]), 0.5 * (bounds[2] + bounds[3]), 0.5 * (bounds[4] + bounds[5])
  };
  vtkNew<vtkCamera> camera;
  look_at(camera, centre, 120.0);
  vtkBrumeVolumeMapper::ResetClippingRange(volume, camera);
  brume::Film film(40, 30);
  EXPECT_TRUE(mapper->RenderFilm(volume, camera, nullptr, film));
  return film;
}

}

TEST(SparseMapper, DrawsWhatItDrawsOfAnImage)
{
  Pair pair;
  for (bool shade : { false, true })
  {
    for (double extinction : { 0.0, 0.002 })
    {
      double sparse_bounds[6], image_bounds[6];
      vtkNew<vtkBrumeRayMarchMapper> mapper;
      const brume::Film a = draw(pair.sparse, shade, extinction, mapper, sparse_bounds);
      const brume::Film b = draw(pair.image, shade, extinction, mapper, image_bounds);
      EXPECT_GT(most_opaque(b), 0.3);
      EXPECT_LE(difference(a, b), 1e-5) << shade << ' ' << extinction;
      for (int i = 0; i < 6; ++i)
      {
        EXPECT_NEAR(sparse_bounds[i], image_bounds[i], 1e-9);
      }
      const brume::Film again = draw(pair.sparse, shade, extinction, mapper, sparse_bounds);
      EXPECT_EQ(difference(a, again), 0.0);
    }
  }
}

TEST(SparseMapper, FollowsItsInputsPipeline)
{
  Pair pair;
  vtkNew<vtkTrivialProducer> producer;
  producer->SetOutput(pair.sparse);
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  mapper->SetInputConnection(producer->GetOutputPort());
  double before[6], after[6];
  std::copy_n(mapper->GetBounds(), 6, before);
  vtkNew<vtkMatrix4x4> matrix;
  pair.sparse->SetIndexToWorld(matrix);
  std::copy_n(mapper->GetBounds(), 6, after);
  EXPECT_NE(before[0], after[0]);
  EXPECT_EQ(
    after[1], pair.sparse->GetVoxels()->origin()[0] + pair.sparse->GetVoxels()->dims()[0] - 1);
}

TEST(SparseMapper, RefusesWhatItCannotDraw)
{
  Pair pair;
  vtkNew<vtkBrumeSparseVolume> empty;
  vtkNew<vtkImageData> mask;
  for (bool masked : { false, true })
  {
    vtkNew<vtkBrumeRayMarchMapper> mapper;
    int errors = 0;
    vtkNew<vtkCallbackCommand> ear;
    ear->SetClientData(&errors);
    ear->SetCallback(
      [](vtkObject*, unsigned long, void* count, void*) { ++*static_cast<int*>(count); });
    mapper->AddObserver(vtkCommand::ErrorEvent, ear);
    mapper->SetInputDataObject(masked ? pair.sparse.Get() : empty.Get());
    mapper->SetMaskInput(masked ? mask.Get() : nullptr);
    auto volume = volume_of();
    volume->SetMapper(mapper);
    vtkNew<vtkCamera> camera;
    brume::Film film(4, 4);
    EXPECT_FALSE(mapper->RenderFilm(volume, camera, nullptr, film));
    EXPECT_EQ(errors, 1);
  }
}
