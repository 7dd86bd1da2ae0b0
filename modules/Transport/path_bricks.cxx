#include "Transport/path_bricks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brume
{

BrickWalk::BrickWalk(const PathBricks& bricks,
  const glm::dvec3& begin,
  const glm::dvec3& along,
  double from,
  double to)
  : Bricks(&bricks)
  , Begin(begin)
  , Along(along)
  , Inverse(1.0 / along)
  , At(from)
  , End(to)
{
  this->settle(from, true);
}

/// Where the ray meets the border of the given brick that it moves toward along an axis.
double BrickWalk::border(int axis, int side_brick) const
{
  // The outermost bricks reach as far as the ray is asked for: half a voxel beyond, of cells.
  const bool up = this->Along[axis] > 0.0;
  if (this->Along[axis] == 0.0 || (up ? side_brick + 1 >= this->Bricks->dims[axis] : side_brick <= 0))
  {
    return std::numeric_limits<double>::infinity();
  }
  const int corner = (side_brick + (up ? 1 : 0)) << this->Bricks->shift;
  return (corner - this->Begin[axis]) * this->Inverse[axis];
}

void BrickWalk::settle(double t, bool first)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double place = this->Begin[axis] + this->Along[axis] * t;
    const int last = this->Bricks->dims[axis] - 1;
    const double most = static_cast<double>(last + 1) * (1 << this->Bricks->shift);
    // Not std::floor, which without SSE4 is a call: below 0 there is no brick.
    const int voxel = static_cast<int>(std::clamp(place, 0.0, most));
    const int found = std::min(voxel >> this->Bricks->shift, last);
    // Never back, whatever rounding says: so each turn of next() comes nearer to the end.
    this->Place[axis] = first                     ? found
                        : this->Along[axis] > 0.0 ? std::max(this->Place[axis], found)
                                                  : std::min(this->Place[axis], found);
    this->Next[axis] = this->border(axis, this->Place[axis]);
  }
}

std::size_t BrickWalk::index() const
{
  return (static_cast<std::size_t>(this->Place[2]) * this->Bricks->dims[1] + this->Place[1]) *
           this->Bricks->dims[0] +
         this->Place[0];
}

bool BrickWalk::next()
{
  while (this->At < this->End)
  {
    const std::size_t brick = this->index();
    const int away = std::max(this->Bricks->distance[brick], 1);
    const bool empty = this->Bricks->distance[brick] > 0;
    // The cube of bricks around, `away` − 1 on each side, is as empty as this one.
    int axis = 0;
    double leave = std::numeric_limits<double>::infinity();
    int leap[3];
    for (int a = 0; a < 3; ++a)
    {
      leap[a] = this->Along[a] > 0.0 ? away - 1 : 1 - away;
      const double t =
        away == 1 ? this->Next[a] : this->border(a, this->Place[a] + leap[a]);
      if (t < leave)
      {
        leave = t;
        axis = a;
      }
    }
    const double from = this->At;
    const double to = std::min(std::max(leave, from), this->End);
    if (leave >= this->End)
    {
      this->At = this->End;
    }
    else
    {
      this->At = to;
      const int beyond = this->Place[axis] + leap[axis] + (this->Along[axis] > 0.0 ? 1 : -1);
      if (away > 1)
      {
        this->settle(to, false);
      }
      this->Place[axis] = beyond;
      if (beyond < 0 || beyond >= this->Bricks->dims[axis])
      {
        this->At = this->End;
      }
      else
      {
        this->Next[axis] = this->border(axis, beyond);
      }
    }
    if (!empty && to > from)
    {
      this->Brick = brick;
      this->From = from;
      this->To = to;
      return true;
    }
  }
  return false;
}

}
