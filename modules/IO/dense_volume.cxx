#include "dense_volume.h"

#include "memory_limit.h"
#include "orientation.h"
#include "scan_header.h"

#include "Transport/sparse_voxels.h"

#include "vtkBrumeSparseVolume.h"

#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace brume
{

namespace
{

/// The box, in voxels of the sparse grid.
struct Box
{
  std::array<std::int32_t, 3> first;
  std::array<std::int32_t, 3> size;
};

Box box_of(const SparseVoxels& voxels)
{
  Box box;
  for (int axis = 0; axis < 3; ++axis)
  {
    box.first[axis] = voxels.first()[axis] + 1; // without the voxel of background around it
    box.size[axis] = voxels.dims()[axis] - 1 - box.first[axis];
  }
  return box;
}

/// Places an image as the volume's matrix has it, as well as images can be placed.
void place(vtkImageData* image,
  vtkMatrix4x4* matrix,
  const SparseVoxels& voxels,
  const Box& box,
  std::vector<std::string>& messages)
{
  std::array<double, 12> affine;
  double corner[4] = { 0, 0, 0, 1 };
  for (int axis = 0; axis < 3; ++axis)
  {
    corner[axis] = static_cast<double>(voxels.origin()[axis]) + box.first[axis];
  }
  matrix->MultiplyPoint(corner, corner);
  double spacing[3];
  double direction[9];
  for (int axis = 0; axis < 3; ++axis)
  {
    spacing[axis] = std::hypot(
      matrix->GetElement(0, axis), matrix->GetElement(1, axis), matrix->GetElement(2, axis));
    for (int row = 0; row < 3; ++row)
    {
      affine[4 * row + axis] = matrix->GetElement(row, axis);
      direction[3 * row + axis] = matrix->GetElement(row, axis) / spacing[axis];
    }
    affine[4 * axis + 3] = corner[axis];
  }
  double oblique = 0; // the largest cosine between two axes
  for (int axis = 0; axis < 3; ++axis)
  {
    const int next = (axis + 1) % 3;
    oblique = std::max(oblique,
      std::abs(direction[axis] * direction[next] + direction[3 + axis] * direction[3 + next] +
               direction[6 + axis] * direction[6 + next]));
  }
  if (oblique > 1e-6)
  {
    // With its handedness kept: the frame is found for a right-handed map, and turned back.
    const double determinant = matrix->Determinant();
    if (determinant < 0)
    {
      for (int row = 0; row < 3; ++row)
      {
        affine[4 * row + 2] = -affine[4 * row + 2];
      }
      for (int row = 0; row < 3; ++row)
      {
        affine[4 * row + 3] -= affine[4 * row + 2] * (box.size[2] - 1);
      }
    }
    const GridFrame frame = frame_of_affine(affine, { { box.size[0], box.size[1], box.size[2] } });
    std::copy(frame.spacing.begin(), frame.spacing.end(), spacing);
    std::copy(frame.direction.begin(), frame.direction.end(), direction);
    std::copy(frame.origin.begin(), frame.origin.end(), corner);
    if (determinant < 0)
    {
      for (int row = 0; row < 3; ++row)
      {
        corner[row] += direction[3 * row + 2] * spacing[2] * (box.size[2] - 1);
        direction[3 * row + 2] = -direction[3 * row + 2];
      }
    }
    char degrees[32];
    std::snprintf(degrees, sizeof(degrees), "%.3g", frame.shear_degrees);
    messages.push_back(
      "its axes are not perpendicular (by " + std::string(degrees) +
      " degrees), which no dense volume can be: the closest perpendicular axes are taken");
  }
  image->SetSpacing(spacing);
  image->SetOrigin(corner);
  image->SetDirectionMatrix(direction);
}

}

vtkSmartPointer<vtkImageData> make_dense(vtkBrumeSparseVolume* volume,
  const std::string& name,
  std::uint64_t limit,
  std::vector<std::string>& messages,
  const std::function<bool(double)>& progress)
{
  if (!volume || !volume->GetVoxels())
  {
    io::fail(name, "there are no voxels", "see what made the volume");
  }
  const SparseVoxels& voxels = *volume->GetVoxels();
  const Box box = box_of(voxels);
  const double count = static_cast<double>(box.size[0]) * box.size[1] * box.size[2];
  const double most = static_cast<double>(io::memory_limit(limit));
  if (count * sizeof(float) > most)
  {
    const auto gigabytes = [](double bytes)
    {
      char text[32];
      std::snprintf(text, sizeof(text), "%.3g GB", bytes / 1e9);
      return std::string(text);
    };
    io::fail(name,
      "dense, its box of " + std::to_string(box.size[0]) + " x " + std::to_string(box.size[1]) +
        " x " + std::to_string(box.size[2]) + " voxels takes " + gigabytes(count * sizeof(float)) +
        ", and the limit is " + gigabytes(most),
      "keep it sparse (.vdb), or allow more (--max-memory)");
  }
  vtkNew<vtkFloatArray> array;
  array->SetName(volume->GetName().empty() ? "density" : volume->GetName().c_str());
  array->SetNumberOfTuples(static_cast<vtkIdType>(count));
  float* values = array->GetPointer(0);
  const auto background = static_cast<float>(voxels.background());
  const std::size_t row = static_cast<std::size_t>(box.size[0]);
  const std::size_t slice = row * static_cast<std::size_t>(box.size[1]);
  for (std::int32_t k = 0; k < box.size[2]; ++k)
  {
    if (progress && !progress(0.3 * k / box.size[2]))
    {
      throw std::runtime_error("interrupted");
    }
    std::fill_n(values + static_cast<std::size_t>(k) * slice, slice, background);
  }
  // Every voxel of a box of bricks, that are all in the image's own box.
  const auto put = [&](const BrickPlace& first, const BrickPlace& last, auto&& value)
  {
    for (std::int32_t z = 8 * first[2]; z < 8 * last[2] + 8; ++z)
    {
      for (std::int32_t y = 8 * first[1]; y < 8 * last[1] + 8; ++y)
      {
        float* out = values + static_cast<std::size_t>(z - box.first[2]) * slice +
                     static_cast<std::size_t>(y - box.first[1]) * row;
        for (std::int32_t x = 8 * first[0]; x < 8 * last[0] + 8; ++x)
        {
          out[x - box.first[0]] = value(x, y, z);
        }
      }
    }
  };
  for (const BrickBox& tile : voxels.tiles())
  {
    const auto value =
      static_cast<float>(voxels.value_in_slot(static_cast<std::size_t>(tile.slot), 0));
    put(tile.first, tile.last, [value](int, int, int) { return value; });
  }
  const std::vector<BrickPlace>& places = voxels.places();
  const std::size_t first_slot = 1 + voxels.tile_slots();
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    if (i % 4096 == 0 && progress &&
        !progress(0.3 + 0.7 * static_cast<double>(i) / static_cast<double>(places.size())))
    {
      throw std::runtime_error("interrupted");
    }
    const std::size_t slot = first_slot + i;
    put(places[i],
      places[i],
      [&voxels, slot](std::int32_t x, std::int32_t y, std::int32_t z) {
        return static_cast<float>(
          voxels.value_in_slot(slot, (z & 7) << 6 | (y & 7) << 3 | (x & 7)));
      });
  }
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(box.size[0], box.size[1], box.size[2]);
  image->GetPointData()->SetScalars(array);
  place(image, volume->GetIndexToWorld(), voxels, box, messages);
  return image;
}

}
