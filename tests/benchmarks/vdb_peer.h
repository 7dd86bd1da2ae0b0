// The cloud of the light rows, and OpenVDB's own renderer on it.
#pragma once

#include "Transport/film.h"

#include "vtkSmartPointer.h"

#include <memory>
#include <string>
#include <vector>

class vtkCamera;
class vtkImageData;

namespace benchmarks
{

/// n³ floats in [0, 1] over the cube [0, 2]³: a ball with noise on it.
class SceneOfCloud
{
public:
  explicit SceneOfCloud(int n);
  double voxel() const { return 2.0 / (this->Size - 1); }
  int size() const { return this->Size; }
  /// A parallel view that shows all of it.
  void aim(vtkCamera* camera) const;

  vtkSmartPointer<vtkImageData> image;

private:
  int Size;
};

/// One file, drawn by both: an isotropic medium of albedo 15/16 under one sun.
class VdbPeer
{
public:
  /// Throws Skipped where vdb_render is not installed.
  VdbPeer(const SceneOfCloud& scene, double extinction, int resolution, int threads, bool quick);
  ~VdbPeer();
  /// Seconds of the render, shadows included, file not.
  double draw();
  double draw_peer();
  /// Draws both and the truth; what came out, in words.
  std::vector<std::string> compare();

private:
  struct Parts;
  std::unique_ptr<Parts> Own;
};

}
