#include "Transport/path_bricks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brume
{

namespace
{

/// Tentative collisions in a stretch of a cell, at the most, unless many are real.
constexpr double few_collisions = 8.0;

}

BrickWalk::BrickWalk(const PathBricks& bricks,
  const glm::dvec3& begin,
  const glm::dvec3& along,
  double from,
  double to,
  double scale)
  : Bricks(&bricks)
  , Begin(begin)
  , Along(along)
  , Inverse(1.0 / along)
  , At(from)
  , End(to)
  , Scale(scale)
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
  if (this->StretchAt < this->StretchEnd && this->next_stretch())
  {
    return true;
  }
  this->Stretched = false;
  if (this->CellAt < this->CellEnd && this->next_cell())
  {
    return true;
  }
  while (this->next_brick())
  {
    if (!this->Bricks->has_cells() || this->Bricks->first_cell[this->Brick] < 0)
    {
      this->Rate = this->Bricks->rate[this->Brick];
      this->Least = this->Bricks->least[this->Brick];
      return true;
    }
    this->begin_cells();
    if (this->next_cell())
    {
      return true;
    }
  }
  return false;
}

void BrickWalk::begin_cells()
{
  const int edge = 1 << this->Bricks->shift;
  this->CellAt = this->From;
  this->CellEnd = this->To;
  std::size_t rest = this->Brick;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int corner = static_cast<int>(rest % this->Bricks->dims[axis]) * edge;
    rest /= this->Bricks->dims[axis];
    const double place = this->Begin[axis] + this->Along[axis] * this->From - corner;
    this->Cell[axis] = static_cast<int>(std::clamp(place, 0.0, edge - 0.5));
    const int side = corner + this->Cell[axis] + (this->Along[axis] > 0.0 ? 1 : 0);
    this->CellNext[axis] = this->Along[axis] == 0.0
                             ? std::numeric_limits<double>::infinity()
                             : (side - this->Begin[axis]) * this->Inverse[axis];
  }
}

bool BrickWalk::next_cell()
{
  const int shift = this->Bricks->shift;
  while (this->CellAt < this->CellEnd)
  {
    const int axis = this->CellNext[0] < this->CellNext[1]
                       ? (this->CellNext[0] < this->CellNext[2] ? 0 : 2)
                       : (this->CellNext[1] < this->CellNext[2] ? 1 : 2);
    const std::size_t cell =
      this->Bricks->first_cell[this->Brick] +
      ((((static_cast<std::size_t>(this->Cell[2]) << shift) + this->Cell[1]) << shift) +
        this->Cell[0]);
    const double from = this->CellAt;
    const double to = std::min(std::max(this->CellNext[axis], from), this->CellEnd);
    this->CellAt = to;
    const int beyond = this->Cell[axis] + (this->Along[axis] > 0.0 ? 1 : -1);
    if (beyond < 0 || beyond >= 1 << shift)
    {
      // What is left of the brick is its outermost cell's, as of the bricks themselves.
      this->CellNext[axis] = std::numeric_limits<double>::infinity();
    }
    else if (to < this->CellEnd)
    {
      this->Cell[axis] = beyond;
      this->CellNext[axis] += std::abs(this->Inverse[axis]);
    }
    if (this->Bricks->cell_rate[cell] > 0.0 && to > from)
    {
      this->Rate = this->Bricks->cell_rate[cell];
      this->Least = this->Bricks->cell_least[cell];
      this->From = from;
      this->To = to;
      if (this->Rate * (to - from) * this->Scale > few_collisions && this->Bricks->along)
      {
        this->StretchAt = from;
        this->StretchEnd = to;
        this->StretchLength = to - from;
        return this->next_stretch() || this->next();
      }
      return true;
    }
  }
  return false;
}

bool BrickWalk::next_stretch()
{
  while (this->StretchAt < this->StretchEnd)
  {
    const double from = this->StretchAt;
    const glm::dvec3 begin = this->Begin + from * this->Along;
    double to = from;
    double rate = 0.0;
    double least = 0.0;
    this->StretchLength *= 4.0;
    for (int halvings = 0; halvings < 64; ++halvings)
    {
      to = from + this->StretchLength < this->StretchEnd ? from + this->StretchLength
                                                         : this->StretchEnd;
      this->Bricks->along(begin, this->Begin + to * this->Along, rate, least);
      // Few collisions, or most of them real.
      if (rate * (to - from) * this->Scale <= few_collisions || rate <= 2.0 * least)
      {
        break;
      }
      this->StretchLength = 0.5 * (to - from);
    }
    this->StretchAt = to > from ? to : this->StretchEnd;
    if (rate > 0.0)
    {
      this->Rate = rate;
      this->Least = least;
      this->From = from;
      this->To = this->StretchAt;
      this->Stretched = true;
      return true;
    }
  }
  return false;
}

bool BrickWalk::next_brick()
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
