// Light volumes and shadow maps, for every SIMD target.
#include "Transport/march_task.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/light_sweep.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/shadow-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// Columns of nodes, as many at once as there are lanes.
class Sweep
{
public:
  explicit Sweep(const SweepTask& task)
    : Task(task)
    , Lit(*task.lit)
    , Rays(*task.volumes, *task.lit)
    , Column(static_cast<std::size_t>(task.positional ? 1 : task.dims[2]) * Lit.maps)
    , Batched(task.volumes->size() == 1 &&
              task.volumes->front().meaning == ValueMeaning::Density && !Lit.frames[0].cropped)
    , Functions(field_functions(task.volumes->front().field))
  {
  }

  void row(int number)
  {
    for (int u = 0; u < Task.dims[0]; u += lane_count)
    {
      Task.positional ? nodes(u, number % Task.dims[1], number / Task.dims[1])
                      : column(u, number);
    }
  }

private:
  Vec3<Real> place(int u, int v, int w) const
  {
    const Real x = hn::Iota(float_tag, static_cast<float>(u));
    return transform(Task.index_from_node,
      { x, real(static_cast<float>(v)), real(static_cast<float>(w)) });
  }

  /// Nodes one by one, each with a ray to the light.
  void nodes(int u, int v, int w)
  {
    const Vec3<Real> here = place(u, v, w);
    Vec3<Real> depth;
    const Mask all = hn::FirstN(float_tag, lane_count);
    Rays.depth(here, broadcast3<Real>(Task.place) - here, real(1.0f), all, depth);
    const Real channel[3] = { depth.x, depth.y, depth.z };
    for (int map = 0; map < Lit.maps; ++map)
    {
      put(map, u, v, w, channel[map]);
    }
  }

  void column(int u, int v)
  {
    const float* m = Task.index_from_node;
    const float axis[3] = { m[2], m[6], m[10] };
    const Real zero = hn::Zero(float_tag);
    const Mask all = hn::FirstN(float_tag, lane_count);
    DepthRays::Ways ways;
    Rays.find_ways(place(u, v, 0), broadcast3<Real>(axis), zero,
      real(static_cast<float>(Task.dims[2] - 1)), all, ways);
    Vec3<Real> depth{ zero, zero, zero };
    store(0, depth);
    Batched ? sweep_density(ways) : sweep_any(ways, depth);
    switch (Task.result)
    {
      case SweepTask::Result::Depth:
        for (int map = 0; map < Lit.maps; ++map)
        {
          for (int w = 0; w < Task.dims[2]; ++w)
          {
            put(map, u, v, w, load(w, map));
          }
        }
        break;
      case SweepTask::Result::Functions:
        for (int map = 0; map < Lit.maps; ++map)
        {
          put_functions(map, u, v);
        }
        break;
      case SweepTask::Result::BothWays:
        put_both_ways(u, v);
        break;
    }
  }

  void sweep_any(const DepthRays::Ways& ways, Vec3<Real> depth)
  {
    const float piece = 1.0f / static_cast<float>(Task.pieces);
    const bool one = Task.volumes->size() == 1;
    const Leaper leaper(one ? Task.volumes->front().bricks : nullptr, ways.lines[0]);
    for (int w = 1; w < Task.dims[2]; ++w)
    {
      if (leaper.leaps())
      {
        // Where all lanes may leap over the way to the node.
        const float before = static_cast<float>(w - 1);
        const Real way = leaper.way(real(before));
        if (hn::AllTrue(float_tag, hn::Or(hn::Not(ways.any), way > real(1.0f))))
        {
          store(w, depth);
          continue;
        }
      }
      for (int i = 0; i < Task.pieces; ++i)
      {
        const float from = static_cast<float>(w - 1) + static_cast<float>(i) * piece;
        Rays.add(ways, real(from), real(from + piece), ways.any, depth);
      }
      store(w, depth);
    }
  }

  /// The same for one grid of densities, read several places at a time.
  void sweep_density(const DepthRays::Ways& ways)
  {
    constexpr int at_once = 4;
    const VolumeTask& volume = Task.volumes->front();
    const Real zero = hn::Zero(float_tag);
    const Real scale = real(volume.extinction) * ways.length[0];
    const Leaper leaper(volume.bricks, ways.lines[0]);
    const float piece = 1.0f / static_cast<float>(Task.pieces);
    const int count = (Task.dims[2] - 1) * Task.pieces;
    Real sum = zero;
    int next = 1; // the node to be stored next
    for (int first = 0; first < count; first += at_once)
    {
      Real middles[at_once];
      Real lengths[at_once];
      Real values[at_once];
      Mask some = hn::FirstN(float_tag, 0);
      for (int i = 0; i < at_once; ++i)
      {
        const float from = static_cast<float>(first + i) * piece;
        const Real low = max(real(from), ways.begin[0]);
        const Real high = hn::Min(real(from + piece), ways.end[0]);
        const Mask here = hn::And(ways.any, low < high);
        lengths[i] = hn::IfThenElseZero(here, high - low);
        middles[i] = (low + high) * real(0.5f);
        some = hn::Or(some, here);
      }
      bool empty = hn::AllFalse(float_tag, some);
      if (!empty && leaper.leaps())
      {
        // Where all lanes may leap over all of these places.
        const Real way = leaper.way(max(middles[0], ways.begin[0]));
        empty = hn::AllTrue(float_tag,
          hn::Or(hn::Not(some), way > real(static_cast<float>(at_once) * piece)));
      }
      if (!empty)
      {
        Functions.values(volume.field, ways.lines[0], middles, at_once, values);
      }
      for (int i = 0; i < at_once && first + i < count; ++i)
      {
        if (!empty)
        {
          const Real density = clamp(values[i], zero, real(1e30f));
          sum = hn::Min(hn::MulAdd(density, lengths[i] * scale, sum), real(1e30f));
        }
        if ((first + i + 1) % Task.pieces == 0)
        {
          Column.set(next++, sum);
        }
      }
    }
  }

  void store(int w, const Vec3<Real>& depth)
  {
    const Real channel[3] = { depth.x, depth.y, depth.z };
    for (int map = 0; map < Lit.maps; ++map)
    {
      Column.set(static_cast<std::size_t>(w) * Lit.maps + map, channel[map]);
    }
  }
  Real load(int w, int map) const
  {
    return Column.get(static_cast<std::size_t>(w) * Lit.maps + map);
  }

  void put(int which, int u, int v, int w, Real value) const
  {
    const std::size_t node =
      (static_cast<std::size_t>(w) * Task.dims[1] + v) * Task.dims[0] + u;
    if (Task.floats)
    {
      hn::StoreU(value, float_tag, static_cast<float*>(Task.out[which]) + node);
      return;
    }
    const Real scaled = hn::Min(value * real(1.0f / Task.scale), real(65535.0f));
    const hn::Rebind<std::uint16_t, FloatTag> narrow;
    hn::StoreU(hn::DemoteTo(narrow, hn::NearestInt(scaled)), narrow,
      static_cast<std::uint16_t*>(Task.out[which]) + node);
  }

  /// Where matter begins and ends, and the cosine series of the transmittance between.
  void put_functions(int map, int u, int v) const
  {
    const Real zero = hn::Zero(float_tag);
    const Real one = real(1.0f);
    const int last = Task.dims[2] - 1;
    const Real total = load(last, map);
    const Real much = hn::Min(total * real(0.9999f), real(16.0f));
    Real begin = zero;
    Real end = zero;
    for (int w = 0; w < last; ++w)
    {
      const Real depth = load(w, map);
      const Real next = real(static_cast<float>(w + 1));
      begin = hn::IfThenElse(depth <= total * real(1e-4f), real(static_cast<float>(w)), begin);
      end = hn::IfThenElse(depth < much, next, end);
    }
    const Mask some = hn::And(total > zero, end > begin);
    const Real scale = hn::IfThenElseZero(some, one / hn::IfThenElse(some, end - begin, one));
    Real sums[ShadowFunctions::coefficients];
    Real cosines[2][ShadowFunctions::coefficients];
    for (Real& sum : sums)
    {
      sum = zero;
    }
    Real before = zero;
    for (int w = 0; w <= last; ++w)
    {
      const Real z = clamp((real(static_cast<float>(w)) - begin) * scale, zero, one);
      const Real passes = hn::Exp(float_tag, hn::Neg(hn::Min(load(w, map), real(80.0f))));
      const Real cosine = hn::Cos(float_tag, z * real(3.14159265f));
      Real* now = cosines[w & 1];
      const Real* then = cosines[(w & 1) ^ 1];
      now[0] = passes;
      now[1] = passes * cosine;
      Real c[2] = { one, cosine };
      for (int k = 2; k < ShadowFunctions::coefficients; ++k)
      {
        const Real further = hn::MulSub(c[1] + c[1], cosine, c[0]);
        c[0] = c[1];
        c[1] = further;
        now[k] = passes * further;
      }
      for (int k = 0; k < ShadowFunctions::coefficients && w > 0; ++k)
      {
        const float half = k == 0 ? 0.5f : 1.0f; // the mean, and twice the others
        sums[k] = hn::MulAdd((now[k] + then[k]) * (z - before), real(half), sums[k]);
      }
      before = z;
    }
    const std::size_t plane = static_cast<std::size_t>(Task.dims[0]) * Task.dims[1];
    float* texel = static_cast<float*>(Task.out[map]) + static_cast<std::size_t>(v) * Task.dims[0] + u;
    hn::StoreU(begin, float_tag, texel);
    hn::StoreU(scale, float_tag, texel + plane);
    for (int k = 0; k < ShadowFunctions::coefficients; ++k)
    {
      const Real nothing = k == 0 ? one : zero; // of no matter: 1 everywhere
      hn::StoreU(hn::IfThenElse(some, sums[k], nothing), float_tag,
        texel + (ShadowFunctions::FirstCoefficient + k) * plane);
    }
  }

  void put_both_ways(int u, int v) const
  {
    for (int map = 0; map < Lit.maps; ++map)
    {
      const Real total = load(Task.dims[2] - 1, map);
      for (int w = 0; w < Task.dims[2]; ++w)
      {
        const Real here = load(w, map);
        if (Task.out[map])
        {
          put(map, u, v, w, here);
        }
        if (Task.out[3 + map])
        {
          put(3 + map, u, v, w, max(total - here, hn::Zero(float_tag)));
        }
      }
    }
  }

  const SweepTask& Task;
  const LitTask& Lit;
  DepthRays Rays;
  PacketArray Column;
  bool Batched;
  FieldFunctions Functions;
};

void sweep_target(const SweepTask& task, int first_row, int last_row)
{
  Sweep rows(task);
  for (int row = first_row; row < last_row; ++row)
  {
    rows.row(row);
  }
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(sweep_target);
void sweep(const SweepTask& task, int first_row, int last_row)
{
  HWY_DYNAMIC_DISPATCH(sweep_target)(task, first_row, last_row);
}
}
#endif
