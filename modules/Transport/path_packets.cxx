// Many paths side by side, for every SIMD target.
#include "Transport/path_packets.h"

#include <cmath>
#include <limits>

#include "Transport/path_scene.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/path_packets.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/path_random-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

#include "Transport/phase-inl.h"
#include "Transport/path_sampling-inl.h"

/// Below this weight a path goes on with a chance that is twice the weight.
constexpr float path_least_weight = 0.25f;
/// A shadow ray that is let through less than this goes on with the chance `path_survival`, and the
/// next such place is at that part of it.
constexpr float path_shadow_roulette = 0.1f;
constexpr float path_survival = 0.25f;

class PathPacket
{
public:
  PathPacket(const PathPacketScene& scene,
    const std::vector<PathStart>& starts,
    int samples,
    int most_scatterings,
    std::uint32_t seed,
    float* radiance,
    PathCounts& counts)
    : Scene(scene)
    , Starts(starts)
    , Samples(samples)
    , MostScatterings(most_scatterings)
    , Seed(seed)
    , Radiance(radiance)
    , Counts(counts)
    , Paths(starts.size() * static_cast<std::size_t>(samples))
    , Phase(scene.matter->phase().model())
    , Look(counts.collisions + PathCounts::between_looks)
  {
    const Mask none = hn::FirstN(float_tag, 0);
    Alive = Shadow = Collided = Faded = Gone = none;
    const Real zero = hn::Zero(float_tag);
    Begin = Along = Inverse = Heading = Onward = Sum = Kept = Gain = { zero, zero, zero };
    Scale = At = End = Left = OnwardLeft = Passes = Depth = StopDepth = Roulette = zero;
    BrickX = BrickY = BrickZ = Scatterings = hn::Zero(int_tag);
    Pixel = Sample = Block = Choice = hn::Zero(word_tag);
    for (std::size_t& path : Path)
    {
      path = Paths;
    }
  }

  void trace()
  {
    // Lanes that wait are served together, when they are enough; idle ones are filled sooner.
    constexpr int enough = lane_count >= 2 ? lane_count * 5 / 8 : 1;
    constexpr int few = lane_count >= 8 ? lane_count / 8 : 1;
    for (;;)
    {
      if (Counts.collisions >= Look)
      {
        Look = Counts.collisions + PathCounts::between_looks;
        if (Counts.look_up)
        {
          Counts.look_up();
        }
      }
      const int idle = lane_count - count(Alive);
      if (Next < Paths && (idle >= few || idle == lane_count))
      {
        refill();
      }
      if (hn::AllFalse(float_tag, Alive))
      {
        return;
      }
      for (;;)
      {
        const Mask walking = hn::AndNot(waiting(), Alive);
        if (hn::AllFalse(float_tag, walking) || count(hn::And(waiting(), Alive)) >= enough)
        {
          break;
        }
        walk(walking);
      }
      const Mask collided = hn::And(Collided, Alive);
      if (!hn::AllFalse(float_tag, collided))
      {
        collide(collided);
      }
      const Mask gone = hn::And(Gone, Alive);
      if (!hn::AllFalse(float_tag, gone))
      {
        leave(gone);
      }
    }
  }

private:
  static int count(Mask mask) { return static_cast<int>(hn::CountTrue(float_tag, mask)); }
  Mask waiting() const { return hn::Or(Collided, Gone); }

  static Int brick_of(Real place, int shift, int bricks)
  {
    const Real most = real(static_cast<float>(bricks << shift));
    const Int voxel = hn::ConvertTo(int_tag, clamp(place, hn::Zero(float_tag), most));
    return hn::Min(hn::ShiftRightSame(voxel, shift), integer(bricks - 1));
  }

  Int brick_index() const
  {
    const Int row = BrickZ * integer(Scene.brick_dims[1]) + BrickY;
    return hn::ShiftLeft<1>(row * integer(Scene.brick_dims[0]) + BrickX);
  }

  /// Sets a ray from Begin along Heading, for the lanes of the mask.
  void aim(Mask mask, const Vec3<Real>& heading, Real left)
  {
    Heading = choose(mask, heading, Heading);
    const Vec3<Real> whole = multiply(Scene.index_from_world, 3, heading);
    const Vec3<Real> along{ or_zero(whole.x), or_zero(whole.y), or_zero(whole.z) };
    const Vec3<Real> data = multiply(Scene.data_from_index, 3, along);
    Along = choose(mask, along, Along);
    Scale = select(mask, hn::Sqrt(dot(data, data)), Scale);
    const Vec3<Real> inverse{ inverse_of(along.x), inverse_of(along.y), inverse_of(along.z) };
    Inverse = choose(mask, inverse, Inverse);
    const Real end = hn::Min(border(along.x, inverse.x, Begin.x, 0),
      hn::Min(border(along.y, inverse.y, Begin.y, 1), border(along.z, inverse.z, Begin.z, 2)));
    End = select(mask, max(end, hn::Zero(float_tag)), End);
    At = hn::IfThenZeroElse(mask, At);
    Left = select(mask, left, Left);
    BrickX = choose(mask, brick_of(Begin.x, Scene.shift, Scene.brick_dims[0]), BrickX);
    BrickY = choose(mask, brick_of(Begin.y, Scene.shift, Scene.brick_dims[1]), BrickY);
    BrickZ = choose(mask, brick_of(Begin.z, Scene.shift, Scene.brick_dims[2]), BrickZ);
    Collided = hn::AndNot(mask, Collided);
    Gone = hn::AndNot(mask, Gone);
  }
  /// 0 for what has no inverse.
  static Real or_zero(Real x) { return hn::IfThenElseZero(hn::Abs(x) > real(1e-30f), x); }
  /// +infinity for 0.
  static Real inverse_of(Real x)
  {
    return select(
      x == hn::Zero(float_tag), real(std::numeric_limits<float>::infinity()), real(1.0f) / x);
  }
  /// Where a ray leaves the box along an axis.
  Real border(Real along, Real inverse, Real begin, int axis) const
  {
    const Real side =
      select(along > hn::Zero(float_tag), real(Scene.upper[axis]), real(Scene.lower[axis]));
    return select(along == hn::Zero(float_tag),
      real(std::numeric_limits<float>::infinity()),
      (side - begin) * inverse);
  }

  /// Where the ray leaves a cube of bricks around the one in hand along an axis, and the brick
  /// beyond.
  struct Side
  {
    Real leave;
    Int beyond;
  };
  Side side(Real along, Real inverse, Real begin, Int brick, Int away, int bricks) const
  {
    const auto up = along > hn::Zero(float_tag);
    const auto up_int = hn::RebindMask(int_tag, up);
    Side result;
    result.beyond = hn::IfThenElse(up_int, brick + away, brick - away);
    const Int corner = hn::IfThenElse(up_int, result.beyond, result.beyond + integer(1));
    const Real at = hn::ConvertTo(float_tag, hn::ShiftLeftSame(corner, Scene.shift));
    // The outermost bricks reach as far as the ray.
    const auto inside =
      hn::AndNot(result.beyond < hn::Zero(int_tag), result.beyond < integer(bricks));
    const auto stays =
      hn::Or(hn::RebindMask(float_tag, hn::Not(inside)), along == hn::Zero(float_tag));
    result.leave =
      select(stays, real(std::numeric_limits<float>::infinity()), (at - begin) * inverse);
    return result;
  }
  /// The brick along an axis in which the ray goes on: never back, whatever rounding says.
  static Int
  go_on(Real along, Real place, Int brick, const Side& side, Mask leaves, int shift, int bricks)
  {
    const Int found = brick_of(place, shift, bricks);
    const auto up = hn::RebindMask(int_tag, along > hn::Zero(float_tag));
    const Int drift = hn::IfThenElse(up, hn::Max(brick, found), hn::Min(brick, found));
    return hn::IfThenElse(hn::RebindMask(int_tag, leaves), side.beyond, drift);
  }

  /// To the next tentative collision or the next brick.
  void walk(Mask walking)
  {
    const Int index = brick_index();
    const Real found = hn::GatherIndex(float_tag, Scene.bricks.data(), index);
    const Real least = hn::GatherIndex(float_tag, Scene.bricks.data() + 1, index);
    const Real zero = hn::Zero(float_tag);
    const Mask empty = found < zero;
    const Int away = hn::ConvertTo(int_tag, select(empty, hn::Neg(found), real(1.0f)));
    const Real rate = hn::IfThenZeroElse(empty, found) * Scale;
    const Real base = hn::IfThenElseZero(Shadow, least) * Scale;
    const Real extra = rate - base;

    const Side x = side(Along.x, Inverse.x, Begin.x, BrickX, away, Scene.brick_dims[0]);
    const Side y = side(Along.y, Inverse.y, Begin.y, BrickY, away, Scene.brick_dims[1]);
    const Side z = side(Along.z, Inverse.z, Begin.z, BrickZ, away, Scene.brick_dims[2]);
    const Real leave = hn::Min(x.leave, hn::Min(y.leave, z.leave));
    const Real to = hn::Min(max(leave, At), End);
    const Real rest = (to - At) * extra;
    const Mask collides = hn::And(walking, Left < rest);
    const Mask moves = hn::AndNot(collides, walking);
    const Real next = select(collides, hn::Min(At + Left / max(extra, real(1e-37f)), to), to);
    Depth = hn::MulAdd(hn::IfThenElseZero(walking, base), next - At, Depth);
    Left = select(moves, Left - rest, Left);
    At = select(walking, next, At);
    const Mask ends = hn::And(moves, leave >= End);
    const Mask fades = hn::And(hn::And(moves, Shadow), Depth > StopDepth);
    Gone = hn::Or(Gone, ends);
    Collided = hn::Or(Collided, hn::Or(collides, hn::AndNot(ends, fades)));
    Faded = hn::Or(hn::AndNot(walking, Faded), hn::AndNot(ends, fades));

    const Vec3<Real> place = here();
    const Mask by_x = x.leave <= leave;
    const Mask by_y = hn::AndNot(by_x, y.leave <= leave);
    const Mask by_z = hn::AndNot(hn::Or(by_x, by_y), z.leave <= leave);
    const Mask steps = hn::AndNot(ends, moves);
    BrickX = choose(
      steps, go_on(Along.x, place.x, BrickX, x, by_x, Scene.shift, Scene.brick_dims[0]), BrickX);
    BrickY = choose(
      steps, go_on(Along.y, place.y, BrickY, y, by_y, Scene.shift, Scene.brick_dims[1]), BrickY);
    BrickZ = choose(
      steps, go_on(Along.z, place.z, BrickZ, z, by_z, Scene.shift, Scene.brick_dims[2]), BrickZ);
  }

  /// No more scatterings are allowed.
  Mask is_last() const
  {
    return hn::RebindMask(float_tag, Scatterings > integer(MostScatterings - 1));
  }

  Vec3<Real> here() const
  {
    return { hn::MulAdd(At, Along.x, Begin.x),
      hn::MulAdd(At, Along.y, Begin.y),
      hn::MulAdd(At, Along.z, Begin.z) };
  }

  /// RandomStream::stratify, of each lane's sample.
  Word stratified(Word word) const
  {
    constexpr int bits = RandomStream::strata_bits;
    const Words turned = random_block({ { hn::Set(word_tag, RandomStream::of_strata),
                                        hn::ShiftRight<bits>(Sample),
                                        Pixel,
                                        hn::Zero(word_tag) } },
      Seed);
    const Word part =
      hn::And(hn::Xor(Sample, turned.word[0]), hn::Set(word_tag, RandomStream::strata - 1u));
    return hn::Or(hn::ShiftLeft<32 - bits>(part), hn::ShiftRight<bits>(word));
  }

  Words draw(Mask mask)
  {
    const Words words = random_block({ { Block, Sample, Pixel, hn::Zero(word_tag) } }, Seed);
    Block = Block + hn::IfThenElseZero(hn::RebindMask(word_tag, mask), hn::Set(word_tag, 1u));
    return words;
  }

  /// −ln(1 − u), which keeps the digits of short ways.
  static Real free_path(Word word)
  {
    return hn::Neg(hn::Log1p(float_tag, hn::Neg(uniform(word))));
  }

  /// A voxel beside the place along an axis, and what is left of u.
  Int pick(Real place, Real& u, int axis) const
  {
    const Real at = clamp(place,
      real(static_cast<float>(Scene.first[axis])),
      real(static_cast<float>(Scene.last[axis])));
    const Int lower = hn::ConvertTo(int_tag, at);
    const Real fraction = at - hn::ConvertTo(float_tag, lower);
    const Mask up = u < fraction;
    u = select(up, u / max(fraction, real(1e-37f)), (u - fraction) / (real(1.0f) - fraction));
    return lower + hn::IfThenElseZero(hn::RebindMask(int_tag, up), integer(1));
  }

  /// Where a voxel is in a sparse grid's pool (SparseVoxels).
  Int sparse_index(Int x, Int y, Int z) const
  {
    const SparseTable& table = *Scene.table;
    const int k = table.page_shift;
    const Int bx = hn::ShiftRight<3>(x);
    const Int by = hn::ShiftRight<3>(y);
    const Int bz = hn::ShiftRight<3>(z);
    const Int top =
      (hn::ShiftRightSame(bz, k) * integer(table.top[1]) + hn::ShiftRightSame(by, k)) *
        integer(table.top[0]) +
      hn::ShiftRightSame(bx, k);
    const Int page = hn::GatherIndex(int_tag, table.pages.data(), top);
    const Int m = integer((1 << k) - 1);
    const Int in_page =
      hn::Or(hn::ShiftLeftSame(hn::Or(hn::ShiftLeftSame(hn::And(bz, m), k), hn::And(by, m)), k),
        hn::And(bx, m));
    const Int slot = hn::GatherIndex(int_tag, table.slots.data(), page + in_page);
    const Int seven = integer(7);
    return hn::ShiftLeft<9>(slot) + hn::ShiftLeft<6>(hn::And(z, seven)) +
           hn::ShiftLeft<3>(hn::And(y, seven)) + hn::And(x, seven);
  }

  /// The extinction at one of the voxels around.
  Real density(Mask mask, const Vec3<Real>& place, Real u)
  {
    const auto reads = hn::RebindMask(int_tag, mask);
    const Int z = hn::IfThenElseZero(reads, pick(place.z, u, 2));
    const Int y = hn::IfThenElseZero(reads, pick(place.y, u, 1));
    const Int x = hn::IfThenElseZero(reads, pick(place.x, u, 0));
    Real value;
    if (Scene.voxels)
    {
      const Int index =
        Scene.table ? sparse_index(x, y, z)
                    : ((z * integer(Scene.last[1] + 1) + y) * integer(Scene.last[0] + 1) + x) *
                        integer(Scene.components);
      value = hn::GatherIndex(float_tag, Scene.voxels, index);
    }
    else
    {
      HWY_ALIGN std::int32_t at[3][lane_count];
      HWY_ALIGN float read[lane_count] = {};
      hn::Store(x, int_tag, at[0]);
      hn::Store(y, int_tag, at[1]);
      hn::Store(z, int_tag, at[2]);
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(float_tag, mask, bits);
      Scene.matter->read_voxels(at[0], at[1], at[2], bits, lane_count, read);
      value = hn::Load(float_tag, read);
    }
    return hn::IfThenElseZero(hn::IsFinite(value), value * real(Scene.scale));
  }

  void collide(Mask collided)
  {
    // The voxels come from far: they are asked for before the next random numbers are drawn.
    const Mask read = hn::AndNot(Faded, collided);
    const Vec3<Real> place = here();
    const Real extinction = density(read, place, uniform(Choice));
    const Int index = brick_index();
    const Real rate = hn::GatherIndex(float_tag, Scene.bricks.data(), index);
    const Real least = hn::GatherIndex(float_tag, Scene.bricks.data() + 1, index);
    const Words words = draw(collided);
    const Real left = free_path(words.word[0]);
    Choice = hn::IfThenElse(hn::RebindMask(word_tag, collided), words.word[1], Choice);
    Counts.collisions += count(read);

    // Shadow rays: let through in part, and given up by chance when that is little.
    const Mask shadow = hn::And(collided, Shadow);
    const Real zero = hn::Zero(float_tag);
    const Real one = real(1.0f);
    if (!hn::AllFalse(float_tag, shadow))
    {
      const Mask dims = hn::And(shadow, read);
      const Real part = max(extinction - least, zero) / max(rate - least, real(1e-37f));
      Passes = select(dims, Passes * max(one - part, zero), Passes);
      const Real most = Passes * hn::Exp(float_tag, hn::Neg(hn::Min(Depth, real(80.0f))));
      const Mask little = hn::And(shadow, most < Roulette);
      const Mask dies = hn::And(
        little, hn::Or(uniform(words.word[3]) >= real(path_survival), most <= real(1e-30f)));
      Passes = select(hn::AndNot(dies, little), Passes * real(1.0f / path_survival), Passes);
      Roulette = select(little, Roulette * real(path_survival), Roulette);
      StopDepth =
        select(shadow, hn::Log(float_tag, max(Passes, real(1e-30f)) / Roulette), StopDepth);
      Passes = hn::IfThenZeroElse(dies, Passes);
      Gone = hn::Or(Gone, dies);
    }

    // Paths: real, or on along the same ray.
    const Mask track = hn::AndNot(Shadow, collided);
    const Mask scatters = hn::And(track, uniform(words.word[2]) * rate < extinction);
    Left = select(read, left, Left);
    Collided = hn::AndNot(collided, Collided);
    if (!hn::AllFalse(float_tag, scatters))
    {
      scatter(scatters, place, left, uniform(words.word[3]));
    }
  }

  /// Light is scattered at a place: it is looked for in the suns, and the path goes on.
  void scatter(Mask scatters, const Vec3<Real>& place, Real left, Real roulette)
  {
    const Real zero = hn::Zero(float_tag);
    const Real one = real(1.0f);
    Begin = choose(scatters, place, Begin);
    const auto scatters_int = hn::RebindMask(int_tag, scatters);
    Mask ends = hn::FirstN(float_tag, 0);
    if (MostScatterings > 0)
    {
      ends = hn::And(scatters, is_last());
    }
    const Vec3<Real> kept = Kept * broadcast3<Real>(Scene.albedo);
    const Real weight = hn::Max(kept.x, hn::Max(kept.y, kept.z));
    const Mask light = weight < real(path_least_weight);
    const Real chance = weight * real(0.5f / path_least_weight);
    ends = hn::Or(ends, hn::And(scatters, hn::And(light, roulette >= chance)));
    ends = hn::Or(ends, hn::And(scatters, weight <= zero));
    const Real more = one / select(light, max(chance, real(1e-37f)), one);
    Kept = choose(scatters, kept * more, Kept);
    const Mask on = hn::AndNot(ends, scatters);
    if (!hn::AllFalse(float_tag, ends))
    {
      finish(ends);
    }
    if (hn::AllFalse(float_tag, on))
    {
      return;
    }
    Scatterings = Scatterings + hn::IfThenElseZero(scatters_int, integer(1));
    Counts.scatterings += count(on);

    const Words words = draw(on);
    const Vec3<Real> from = Heading;
    const Vec3<Real> onward =
      sample_phase(Scene.matter->phase(), from, uniform(words.word[0]), uniform(words.word[1]));
    const Real onward_left = free_path(words.word[2]);
    if (Scene.suns.empty())
    {
      aim(on, onward, left);
      return;
    }
    // One sun, by what would arrive from each without shadows.
    Real u = uniform(words.word[3]);
    Real sum = zero;
    Real chosen_brightness = one;
    Vec3<Real> toward = broadcast3<Real>(Scene.suns.front().toward);
    Vec3<Real> arrives{ zero, zero, zero };
    for (const PathSun& sun : Scene.suns)
    {
      const Vec3<Real> back = broadcast3<Real>(sun.toward);
      const Vec3<Real> less = from - back;
      const Vec3<Real> plus = from + back;
      const Real half = real(0.5f);
      const Real value = phase<Real>(Phase, half * dot(less, less), half * dot(plus, plus));
      const Vec3<Real> comes = broadcast3<Real>(sun.irradiance) * value;
      const Vec3<Real> seen = Kept * comes;
      const Real brightness = hn::Max(seen.x, hn::Max(seen.y, seen.z));
      sum = sum + brightness;
      const Real share = hn::Min(brightness / max(sum, real(1e-37f)), one);
      const Mask takes = hn::And(u<share, brightness> zero);
      u = select(takes, u / max(share, real(1e-37f)), (u - share) / max(one - share, real(1e-7f)));
      toward = choose(takes, back, toward);
      arrives = choose(takes, seen, arrives);
      chosen_brightness = select(takes, brightness, chosen_brightness);
    }
    const Real by_chance = sum / chosen_brightness;
    const Mask lit = hn::And(on, sum > zero);
    Counts.shadow_rays += count(lit);
    Gain = choose(on, arrives * by_chance, Gain);
    Onward = choose(on, onward, Onward);
    OnwardLeft = select(on, onward_left, OnwardLeft);
    Passes = select(on, one, Passes);
    Depth = hn::IfThenZeroElse(on, Depth);
    Roulette = select(on, real(path_shadow_roulette), Roulette);
    StopDepth = select(on, real(-std::log(path_shadow_roulette)), StopDepth);
    Shadow = hn::Or(Shadow, on);
    aim(on, toward, left);
    // Heading is the path's own again when the shadow ray has ended.
    const Mask dark = hn::AndNot(lit, on);
    Passes = hn::IfThenZeroElse(dark, Passes);
    Gone = hn::Or(Gone, dark);
  }

  /// A ray has left the matter, or a shadow ray was given up.
  void leave(Mask gone)
  {
    const Mask shadow = hn::And(gone, Shadow);
    const Mask track = hn::AndNot(Shadow, gone);
    if (!hn::AllFalse(float_tag, shadow))
    {
      const Real passes = Passes * hn::Exp(float_tag, hn::Neg(hn::Min(Depth, real(80.0f))));
      Sum = choose(shadow, Sum + Gain * passes, Sum);
      Shadow = hn::AndNot(shadow, Shadow);
      aim(shadow, Onward, OnwardLeft);
      if (!Scene.glows && MostScatterings > 0)
      {
        const Mask last = hn::And(shadow, is_last());
        if (!hn::AllFalse(float_tag, last))
        {
          finish(last); // nothing more can come
        }
      }
    }
    if (!hn::AllFalse(float_tag, track))
    {
      if (Scene.glows)
      {
        const Mask scattered =
          hn::And(track, hn::RebindMask(float_tag, Scatterings > hn::Zero(int_tag)));
        const Mask up = dot(Heading, broadcast3<Real>(Scene.up)) >= hn::Zero(float_tag);
        const Vec3<Real> sky =
          choose(up, broadcast3<Real>(Scene.sky), broadcast3<Real>(Scene.ground));
        Sum = choose(scattered, Sum + Kept * sky, Sum);
      }
      finish(track);
    }
  }

  void finish(Mask mask)
  {
    Alive = hn::AndNot(mask, Alive);
    Collided = hn::AndNot(mask, Collided);
    Gone = hn::AndNot(mask, Gone);
    HWY_ALIGN float sums[3][lane_count];
    hn::Store(Sum.x, float_tag, sums[0]);
    hn::Store(Sum.y, float_tag, sums[1]);
    hn::Store(Sum.z, float_tag, sums[2]);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(float_tag, mask, bits);
    for (int lane = 0; lane < lane_count; ++lane)
    {
      if (bits[lane / 8] >> (lane % 8) & 1)
      {
        for (int c = 0; c < 3; ++c)
        {
          Radiance[3 * Path[lane] + c] = sums[c][lane];
        }
      }
    }
  }

  /// New paths in idle lanes.
  void refill()
  {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(float_tag, Alive, bits);
    HWY_ALIGN float begin[3][lane_count] = {};
    HWY_ALIGN float heading[3][lane_count] = {};
    HWY_ALIGN float length[lane_count] = {};
    HWY_ALIGN std::uint32_t pixel[lane_count] = {};
    HWY_ALIGN std::uint32_t sample[lane_count] = {};
    HWY_ALIGN float filled[lane_count] = {};
    for (int lane = 0; lane < lane_count; ++lane)
    {
      heading[0][lane] = 1.0f;
      if ((bits[lane / 8] >> (lane % 8) & 1) == 0 && Next < Paths)
      {
        const PathStart& start = Starts[Next / Samples];
        for (int a = 0; a < 3; ++a)
        {
          begin[a][lane] = start.begin[a];
          heading[a][lane] = start.direction[a];
        }
        length[lane] = start.length;
        pixel[lane] = start.pixel;
        sample[lane] = start.first + static_cast<std::uint32_t>(Next % Samples);
        filled[lane] = 1.0f;
        Path[lane] = Next++;
      }
    }
    const Mask fresh = hn::Load(float_tag, filled) > hn::Zero(float_tag);
    const auto fresh_word = hn::RebindMask(word_tag, fresh);
    const auto load = [](const float* values) { return hn::Load(float_tag, values); };
    Begin = choose(fresh, { load(begin[0]), load(begin[1]), load(begin[2]) }, Begin);
    Pixel = hn::IfThenElse(fresh_word, hn::Load(word_tag, pixel), Pixel);
    Sample = hn::IfThenElse(fresh_word, hn::Load(word_tag, sample), Sample);
    Block = hn::IfThenZeroElse(fresh_word, Block);
    Scatterings = hn::IfThenZeroElse(hn::RebindMask(int_tag, fresh), Scatterings);
    const Real zero = hn::Zero(float_tag);
    const Real one = real(1.0f);
    Sum = choose(fresh, { zero, zero, zero }, Sum);
    Kept = choose(fresh, { one, one, one }, Kept);
    Shadow = hn::AndNot(fresh, Shadow);
    Alive = hn::Or(Alive, fresh);
    const Words words = draw(fresh);
    Choice = hn::IfThenElse(fresh_word, words.word[1], Choice);
    const Word first = stratified(words.word[0]);
    aim(fresh, { load(heading[0]), load(heading[1]), load(heading[2]) }, free_path(first));
    End = select(fresh, hn::Min(End, hn::Load(float_tag, length)), End);
  }

  const PathPacketScene& Scene;
  const std::vector<PathStart>& Starts;
  const int Samples;
  const int MostScatterings;
  const std::uint32_t Seed;
  float* Radiance;
  PathCounts& Counts;
  const std::size_t Paths;
  const PhaseModel& Phase;
  std::size_t Next = 0;
  std::uint64_t Look; ///< collisions at which to look up
  std::size_t Path[lane_count];

  Mask Alive;
  Mask Shadow;   ///< the ray in hand asks how much of a sun comes through
  Mask Collided; ///< waits for collide()
  Mask Faded;    ///< it does so since a shadow ray has become weak, without a collision
  Mask Gone;     ///< waits for leave()
  // The ray in hand.
  Vec3<Real> Begin; ///< index space
  Vec3<Real> Along; ///< index space, of one world unit
  Vec3<Real> Inverse;
  Vec3<Real> Heading; ///< unit vector of the world
  Real Scale;         ///< of the data's units in one of the world's
  Real At;
  Real End;
  Real Left; ///< optical depth to the next tentative collision
  Int BrickX, BrickY, BrickZ;
  // Of a shadow ray.
  Vec3<Real> Gain; ///< what arrives if all is let through
  Real Passes;     ///< what collisions let through
  Real Depth;      ///< of what is everywhere in the bricks
  Real Roulette;
  Real StopDepth; ///< more depth than this is weak
  Vec3<Real> Onward;
  Real OnwardLeft;
  // Of the path.
  Vec3<Real> Sum;
  Vec3<Real> Kept;
  Int Scatterings;
  Word Pixel, Sample, Block;
  Word Choice; ///< which voxel stands for the next place
};

void trace_paths_target(const PathPacketScene& scene,
  const std::vector<PathStart>& starts,
  int samples,
  int most_scatterings,
  std::uint32_t seed,
  float* radiance,
  PathCounts& counts)
{
  PathPacket(scene, starts, samples, most_scatterings, seed, radiance, counts).trace();
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(trace_paths_target);
void trace_paths(const PathPacketScene& scene,
  const std::vector<PathStart>& starts,
  int samples,
  int most_scatterings,
  std::uint32_t seed,
  float* radiance,
  PathCounts& counts)
{
  HWY_DYNAMIC_DISPATCH(trace_paths_target)
  (scene, starts, samples, most_scatterings, seed, radiance, counts);
}
}
#endif
