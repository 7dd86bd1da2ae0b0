// A box and a plane that are dragged in a viewport, and cut the volume.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>

class vtkRenderWindowInteractor;
class vtkRenderer;

namespace brume::app
{

/// VTK's box and plane widgets. All places are world units.
class CuttingTools
{
public:
  using Bounds = std::array<double, 6>; ///< x0, x1, y0, y1, z0, z1
  using Plane = std::array<double, 4>;  ///< what is drawn has a x + b y + c z + d ≥ 0

  CuttingTools();
  ~CuttingTools();
  CuttingTools(const CuttingTools&) = delete;
  CuttingTools& operator=(const CuttingTools&) = delete;

  /// Called whenever the box or the plane was dragged.
  std::function<void(const Bounds&)> Boxed;
  std::function<void(const Plane&)> Planed;
  /// Called when one of them was taken: releases of the mouse are its own from now on.
  std::function<void()> Taken;

  /// Shows the box, around `now`, or the plane, which cuts at once, at first through the middle, then
  /// where it was; or hides it: what is cut stays.
  ///@{
  void switch_box(
    vtkRenderWindowInteractor* interactor, vtkRenderer* renderer, const Bounds& volume, const Bounds& now);
  void switch_plane(
    vtkRenderWindowInteractor* interactor, vtkRenderer* renderer, const Bounds& volume);
  ///@}
  /// Hides both, and forgets where they were.
  void hide();
  /// The volume may be another, and what is cropped may have been set elsewhere: what is shown goes along. A
  /// plane that misses the volume comes back to it; one that cuts no more is hidden. Costs nothing while all
  /// is as it was.
  void follow(const Bounds& volume, const Bounds& now, bool plane_cuts);

  /// What is shown; none where it is hidden.
  ///@{
  std::optional<Bounds> box() const;
  std::optional<Plane> plane() const;
  ///@}

private:
  struct Internals;
  std::unique_ptr<Internals> Internal;
};

}
