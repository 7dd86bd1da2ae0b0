// What the modes other than Composite need of a volume, prepared once. Internal to Transport.
#pragma once

#include "Transport/bricks.h"
#include "Transport/lookup_table.h"
#include "Transport/march_task.h"
#include "Transport/scene.h"

#include <vector>

namespace brume
{

class ModeTables
{
public:
  /// Whether the tables and the visible bricks of a volume are still those of this scene, as far as
  /// its mode goes.
  bool serve(const Scene& scene) const;

  /// `table` is the volume's, made anew: it holds opacities afterwards where the mode wants them.
  void update(
    const Scene& scene, const Volume& volume, const BrickRanges& ranges, LookupTable& table);

  /// Whether anything in a brick of these values counts.
  bool can_show(const Scene& scene,
    const Volume& volume,
    const LookupTable& table,
    float lower,
    float upper) const;

  /// What a non-finite voxel is read as.
  float empty_value(const LookupTable& table) const;

  void fill(const Scene& scene, const Volume& volume, VolumeTask& task) const;

private:
  void find_bounds(const BrickRanges& ranges, float empty_value);
  void find_surfaces(const Volume& volume);

  bool Ready = false;
  BlendMode Mode = BlendMode::Composite;
  double AverageRange[2] = { 0, 0 };
  std::vector<double> Isosurfaces; ///< as the scene has them
  float Sign = 1.0f;
  float Extreme = 0.0f; ///< in place of non-finite voxels, for the largest and smallest value
  float Top = 0.0f;
  float Rounding = 0.0f;
  int BrickDims[3] = { 0, 0, 0 };
  int BrickShift = 3;
  std::vector<float> Bounds;
  std::vector<LookupNode> Surfaces;
};

/// The scene's isovalues, sorted, each once.
std::vector<float> sorted_isosurfaces(const Scene& scene);

}
