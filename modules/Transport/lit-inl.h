// Light in media along packets of rays: absorption, emission, and what the matter scatters of lights
// and sky. Theory: docs/theory/light.md. Included once for each SIMD target.
#if defined(BRUME_LIT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_LIT_INL_H
#undef BRUME_LIT_INL_H
#else
#define BRUME_LIT_INL_H
#endif

#include "Transport/fog_gaps-inl.h"
#include "Transport/shadow-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

#include "Transport/phase-inl.h"

HWY_INLINE Real transmittance_of(Real optical_depth)
{
  return hn::Exp(float_tag, hn::Neg(optical_depth));
}
HWY_INLINE Real mean_transmittance_of(Real x)
{
  return mean_transmittance(x, transmittance_of(x));
}
#include "Transport/fog-inl.h"
#include "Transport/exponential_integral-inl.h"
#include "Transport/lit_parts-inl.h"

/// Single: one grid of densities. Chromatic: its channels differ. Rich: there is more to it than
/// lights at infinity and one octave: lamps, octaves, sky, emission, powder. Foggy: there is fog. In
/// volumes it is one more of them, in front of, between and behind them it comes in closed form.
template <bool Single, bool Chromatic, bool Rich, bool Foggy = false>
class LitIntegrator
{
public:
  explicit LitIntegrator(const MarchTask& task)
    : Task(task)
    , Lit(*task.lit)
    , VolumeCount(Single ? 1 : static_cast<int>(task.volumes->size()))
    , PieceCount(VolumeCount + (Foggy ? 1 : 0))
    , LightCount(static_cast<int>(task.lit->lights.size()))
    , Depths(task)
    , Shadows(task.lit->lights.size() * (steps_at_once + 1) * 3)
    , FogDepths(Foggy ? task.lit->lights.size() * 2 : 0)
    , Lamps(Rich ? task.lit->lights.size() * (1 + 3 * lamp_points) : 0)
    , Phases(task.lit->lights.size() * PieceCount * most_octaves * (Rich ? lamp_points : 1))
    , Functions(field_functions(task.volumes->front().field))
  {
    for (const VolumeTask& volume : *task.volumes)
    {
      Volumes.emplace_back(volume, task.step);
      CanLeap = CanLeap || (volume.bricks && !Foggy);
    }
    if constexpr (Foggy)
    {
      Gaps = std::make_unique<FogGaps>(*task.fog, *task.fog_rays);
    }
    if (Rich)
    {
      for (const LitVolume& volume : Lit.volumes)
      {
        Temperatures.push_back(
          volume.black_body ? field_functions(volume.temperature) : FieldFunctions{});
      }
      for (const AmbientLight& light : Lit.ambient)
      {
        Ambients.push_back(field_functions(light.depth[0].field));
      }
    }
  }

  double depth_scale() const { return 1.0; }

  /// To be called for each packet, before and after its stretches.
  ///@{
  void begin_packet(const PacketRays& packet) requires Foggy { Gaps->begin(packet); }
  void end_packet(LitGathered& gathered, Mask& met) requires Foggy
  {
    gathered.coloured = Chromatic;
    HWY_ALIGN float left[lane_count], inside[lane_count];
    hn::Store(hn::IfThenElseZero(gathered.left, real(1.0f)), float_tag, left);
    add_gap(gathered, [&](const auto& through, FogGap& gap) { Gaps->after(left, through, gap); });
    for (int lane = 0; lane < lane_count; ++lane)
    {
      inside[lane] = Gaps->in_tile(lane) ? 1.0f : 0.0f;
    }
    met = hn::Load(float_tag, inside) > hn::Zero(float_tag);
  }
  ///@}

  std::uint64_t march(const Rays& rays, LitGathered& gathered)
  {
    begin(rays);
    gathered.coloured = Chromatic;
    if constexpr (Foggy)
    {
      add_gap(gathered, [&](const auto& through, FogGap& gap) { Gaps->before(rays, through, gap); });
    }
    const Real zero = hn::Zero(float_tag);
    const Real one = real(1.0f);
    Real end = rays.end;
    Real step = zero;
    bool fresh = true; // the light at the beginning of the step is not known
    bool empty = true; // nothing was met: look for bricks to leap over
    DepthBefore = DepthEarlier = zero;
    std::uint64_t samples = 0;
    for (;;)
    {
      Mask active = step < end;
      if (hn::AllFalse(float_tag, active))
      {
        return samples;
      }
      if (empty && CanLeap)
      {
        const Real way = leap(rays, (max(step, rays.start) + hn::Min(step + one, rays.end)) * real(0.5f));
        const Mask leaping = hn::And(active, way > zero);
        if (!hn::AllFalse(float_tag, leaping))
        {
          step = step + hn::IfThenElseZero(leaping, hn::Floor(way) + one);
          fresh = true;
          continue;
        }
      }
      Stretch stretches[steps_at_once];
      for (int i = 0; i < steps_at_once; ++i)
      {
        const Real from = step + real(static_cast<float>(i));
        const Real low = max(from, rays.start);
        const Real high = hn::Min(from + one, rays.end);
        stretches[i] = { low, high, (low + high) * real(0.5f), from < end };
      }
      Piece pieces[steps_at_once][most_pieces];
      empty = !look(rays, stretches, pieces, samples);
      if (empty)
      {
        step = step + real(static_cast<float>(steps_at_once));
        fresh = true;
        DepthBefore = DepthEarlier = zero;
        continue;
      }
      samples += find_shadows(stretches, fresh);
      if constexpr (Foggy)
      {
        find_fog_depths(rays, stretches[0]);
      }
      fresh = false;
      for (int i = 0; i < steps_at_once; ++i)
      {
        active = hn::And(stretches[i].active, step < end);
        if (hn::AllFalse(float_tag, active))
        {
          return samples;
        }
        pass(rays, stretches[i], active, pieces[i], i, gathered);
        const Mask leave = hn::And(active, gathered.transmittance < real(Task.leave_below));
        gathered.left = hn::Or(gathered.left, leave);
        end = hn::IfThenZeroElse(leave, end);
        step = step + one;
      }
    }
  }

private:
  static constexpr int steps_at_once = Single ? samples_between_leaps : 1;
  static constexpr int most_pieces = Single ? 1 : most_volumes + (Foggy ? 1 : 0);

  struct Stretch
  {
    Real low;
    Real high;
    Real middle;
    Mask active;
  };

  /// What one volume has in a stretch.
  struct Piece
  {
    Real depth;
    Real amount;
    Real length; ///< in the volume's data
    Mask inside;
    Matter matter;
  };

  /// Once for each stretch of a packet's rays: what is the same all along.
  void begin(const Rays& rays)
  {
    Depths.begin(rays.lines[0]);
    const Vec3<Real> along = multiply(Lit.world_from_index, 4, rays.lines[0].delta);
    Viewer = -(along * rsqrt_or_zero(dot(along, along)));
    if constexpr (Foggy)
    {
      const FogTask& fog = Lit.fog;
      const Vec3<Real> normal = broadcast3<Real>(fog.exponent);
      ExponentBegin = dot(normal, rays.lines[0].begin) + real(fog.exponent[3]);
      ExponentDelta = dot(normal, rays.lines[0].delta);
    }
    for (int l = 0; l < LightCount; ++l)
    {
      const LitLight& light = Lit.lights[l];
      if (!light.source.positional)
      {
        find_phases(l, broadcast3<Real>(light.source.direction));
      }
    }
  }

  /// Phase functions between a direction of travel and the viewer, octave by octave.
  HWY_INLINE void find_phases(int l, const Vec3<Real>& travel, int point = 0)
  {
    const Vec3<Real> apart = travel - Viewer;
    const Vec3<Real> together = travel + Viewer;
    const Real half = real(0.5f);
    const Real one_minus = dot(apart, apart) * half;
    const Real one_plus = dot(together, together) * half;
    for (int k = 0; k < PieceCount; ++k)
    {
      const LitVolume& volume = Lit.volumes[k];
      const std::size_t octaves = Rich ? volume.octaves.size() : 1;
      for (std::size_t m = 0; m < octaves && volume.lit; ++m)
      {
        Phases.set(phase_index(l, k, static_cast<int>(m), point),
          phase<Real>(volume.octaves[m].phase, one_minus, one_plus));
      }
    }
  }
  HWY_INLINE std::size_t phase_index(int l, int k, int m, int point = 0) const
  {
    constexpr int points = Rich ? lamp_points : 1;
    return ((static_cast<std::size_t>(l) * PieceCount + k) * most_octaves + m) * points + point;
  }

  /// Reads the volumes. Returns whether there is anything.
  HWY_INLINE bool look(const Rays& rays,
    const Stretch* stretches,
    Piece (*pieces)[most_pieces],
    std::uint64_t& samples) const
  {
    const Real zero = hn::Zero(float_tag);
    Mask any = hn::FirstN(float_tag, 0);
    if constexpr (Single)
    {
      const VolumeTask& volume = Task.volumes->front();
      Real positions[steps_at_once];
      Real values[steps_at_once];
      for (int i = 0; i < steps_at_once; ++i)
      {
        positions[i] = stretches[i].middle;
      }
      Functions.values(volume.field, rays.lines[0], positions, steps_at_once, values);
      const Real unit = real(static_cast<float>(Task.step)) * rays.scale[0];
      for (int i = 0; i < steps_at_once; ++i)
      {
        Piece& piece = pieces[i][0];
        const Mask active = stretches[i].active;
        samples += hn::CountTrue(float_tag, active);
        piece.length =
          hn::IfThenElseZero(active, (stretches[i].high - stretches[i].low) * unit);
        piece.amount =
          hn::Min(clamp(values[i], zero, real(1e30f)) * piece.length, real(1e30f));
        piece.depth = hn::Min(piece.amount * real(volume.extinction), real(1e30f));
        piece.inside = active;
        any = hn::Or(any, piece.amount > zero);
      }
    }
    else
    {
      const Stretch& stretch = stretches[0];
      for (int k = 0; k < VolumeCount; ++k)
      {
        Piece& piece = pieces[0][k];
        piece.inside = hn::And(stretch.active, rays.inside[k] > zero);
        piece.depth = piece.amount = piece.length = zero;
        if (hn::AllFalse(float_tag, piece.inside))
        {
          continue;
        }
        samples += hn::CountTrue(float_tag, piece.inside);
        const Real length = (stretch.high - stretch.low) * rays.scale[k];
        Volumes[k].look(rays.lines[k], stretch.middle, length, piece.inside, piece.matter);
        piece.length = length * real(static_cast<float>(Task.step));
        piece.depth = piece.matter.depth;
        piece.amount = piece.matter.amount;
        any = hn::Or(any, piece.amount > zero);
      }
      if constexpr (Foggy)
      {
        look_at_fog(rays, stretch, pieces[0][VolumeCount]);
        any = hn::Or(any, stretch.active);
      }
    }
    return !hn::AllFalse(float_tag, any);
  }

  /// e^−exponent at a position of the packet's rays.
  HWY_INLINE Real fog_exponent(Real position) const
  {
    return max(hn::MulAdd(position, ExponentDelta, ExponentBegin), real(FogTask::least_exponent));
  }

  /// The fog in a stretch, in closed form.
  HWY_INLINE void look_at_fog(const Rays& rays, const Stretch& stretch, Piece& piece) const
  {
    const Real zero = hn::Zero(float_tag);
    piece.inside = stretch.active;
    piece.length =
      hn::IfThenElseZero(stretch.active, (stretch.high - stretch.low) * rays.step_world);
    const Real low = fog_exponent(stretch.low);
    const Real high = fog_exponent(stretch.high);
    const Real column = fog_column<Real>(
      transmittance_of(low), transmittance_of(high), hn::Abs(high - low), piece.length);
    piece.depth = clamp(column * real(Lit.fog.extinction), zero, real(FogTask::deepest));
    piece.amount = piece.depth;
  }

  /// The fog's optical depths toward the lights where a stretch begins and ends, of a channel of 1.
  void find_fog_depths(const Rays& rays, const Stretch& stretch)
  {
    const Real ends[2] = { stretch.low, stretch.high };
    for (int i = 0; i < 2; ++i)
    {
      const Real exponent = fog_exponent(ends[i]);
      const Real profile = transmittance_of(exponent);
      for (int l = 0; l < LightCount; ++l)
      {
        const LitLight& light = Lit.lights[l];
        Real depth = light.fog_hides ? real(FogTask::deepest) : profile * real(light.fog_above);
        if (light.source.positional)
        {
          const Vec3<Real> way = lamp_offset(rays, ends[i], l);
          const Real there = real(light.fog_exponent);
          depth = real(Lit.fog.extinction) *
            fog_column<Real>(profile, transmittance_of(there), hn::Abs(exponent - there),
              hn::Sqrt(dot(way, way)));
        }
        FogDepths.set(2 * l + i, hn::Min(depth, real(FogTask::deepest)));
      }
    }
  }
  /// The fog's part of a depth toward a light.
  HWY_INLINE Real fog_depth(int l, int i, int c) const
  {
    return FogDepths.get(2 * l + i) * real(Lit.volumes[VolumeCount].channels[c]);
  }

  /// Takes what the packet meets in a gap: find(through, gap) finds it.
  template <class Find>
  void add_gap(LitGathered& gathered, const Find& find)
  {
    constexpr int channels = Chromatic ? 3 : 1;
    HWY_ALIGN float through[3][lane_count];
    for (int c = 0; c < 3; ++c)
    {
      hn::Store(gathered.through[Chromatic ? c : 0], float_tag, through[c]);
    }
    FogGap gap;
    find(through, gap);
    Real* radiance[3] = { &gathered.radiance.x, &gathered.radiance.y, &gathered.radiance.z };
    for (int c = 0; c < 3; ++c)
    {
      *radiance[c] = hn::MulAdd(gathered.through[Chromatic ? c : 0],
        hn::Load(float_tag, gap.radiance[c]), *radiance[c]);
    }
    for (int c = 0; c < channels; ++c)
    {
      const Real depth = hn::Load(float_tag, gap.depth[c]);
      gathered.depths[c].add(depth);
      gathered.through[c] = gathered.through[c] * transmittance_of(depth);
    }
    gathered.transmittance = largest_through(gathered);
    const Real place = hn::Load(float_tag, gap.half_way);
    const Mask here = hn::Load(float_tag, gap.here) > hn::Zero(float_tag);
    gathered.half_way = hn::IfThenElse(here, hn::Min(gathered.half_way, place), gathered.half_way);
  }

  static HWY_INLINE Real largest_through(const LitGathered& gathered)
  {
    return Chromatic
      ? max(gathered.through[0], max(gathered.through[1], gathered.through[2]))
      : gathered.through[0];
  }

  /// Optical depths toward the lights where the stretches begin and end. Those of place i of light l
  /// are at shadow_index(l, i).
  HWY_INLINE std::size_t shadow_index(int l, int i) const
  {
    return (static_cast<std::size_t>(l) * (steps_at_once + 1) + i) * 3;
  }
  HWY_INLINE std::uint64_t find_shadows(const Stretch* stretches, bool fresh)
  {
    std::uint64_t samples = 0;
    Real positions[steps_at_once + 1];
    positions[0] = stretches[0].low;
    for (int i = 0; i < steps_at_once; ++i)
    {
      // Beyond the ray's end nothing is asked for: its end serves as well as any place.
      positions[i + 1] = max(stretches[i].high, positions[0]);
    }
    for (int l = 0; l < LightCount; ++l)
    {
      Vec3<Real> depths[steps_at_once + 1];
      const int first = fresh ? 0 : 1;
      samples += Depths.get(l, positions + first, steps_at_once + 1 - first,
        stretches[0].active, depths + first);
      if (!fresh)
      {
        depths[0] = get_shadow(l, steps_at_once);
      }
      for (int i = 0; i <= steps_at_once; ++i)
      {
        Shadows.set(shadow_index(l, i), depths[i].x);
        if (Chromatic && Lit.maps == 3)
        {
          Shadows.set(shadow_index(l, i), depths[i]);
        }
      }
    }
    return samples;
  }
  HWY_INLINE Vec3<Real> get_shadow(int l, int i) const
  {
    const std::size_t at = shadow_index(l, i);
    const Real first = Shadows.get(at);
    if (Chromatic && Lit.maps == 3)
    {
      return { first, Shadows.get(at + 1), Shadows.get(at + 2) };
    }
    return { first, first, first };
  }

  /// The factor of channel c on all optical depths that one map gives.
  HWY_INLINE Real channel(int c) const { return real(Lit.channels[c]); }

  /// Takes a stretch.
  HWY_INLINE void pass(const Rays& rays,
    const Stretch& stretch,
    Mask active,
    const Piece* pieces,
    int number,
    LitGathered& gathered)
  {
    constexpr int channels = Chromatic ? 3 : 1;
    const Real zero = hn::Zero(float_tag);
    // What the view is dimmed by.
    Channels<Chromatic> dim;
    Real total = zero;
    for (int c = 0; c < channels; ++c)
    {
      dim[c] = zero;
    }
    for (int k = 0; k < VolumeCount; ++k)
    {
      total = total + pieces[k].depth;
      for (int c = 0; c < channels; ++c)
      {
        const Real part =
          Chromatic ? pieces[k].depth * real(Lit.volumes[k].channels[c]) : pieces[k].depth;
        dim[c] = dim[c] + part;
      }
    }
    if (!Single && Lit.components)
    {
      mix_components(pieces, dim);
    }
    estimate_error(total, gathered);
    Channels<Chromatic> passes;
    Channels<Chromatic> share; // the mean of what the stretch lets pass of its own light
    for (int c = 0; c < channels; ++c)
    {
      dim[c] = Lit.absorption ? hn::IfThenElseZero(active, dim[c]) : zero;
      if constexpr (Foggy)
      {
        const Piece& fog = pieces[VolumeCount];
        dim[c] = hn::MulAdd(hn::IfThenElseZero(active, fog.depth),
          real(Lit.volumes[VolumeCount].channels[c]), dim[c]);
      }
      passes[c] = hn::Exp(float_tag, hn::Neg(dim[c]));
      share[c] = mean_transmittance(dim[c], passes[c]);
    }

    if constexpr (Rich)
    {
      for (int l = 0; l < LightCount; ++l)
      {
        if (Lit.lights[l].source.positional)
        {
          find_lamp(rays, stretch, l);
        }
      }
    }
    Vec3<Real> sent{ zero, zero, zero }; // as the eye end of the stretch has it
    for (int k = 0; k < PieceCount; ++k)
    {
      if (!hn::AllFalse(float_tag, pieces[k].amount > zero))
      {
        add_piece(rays, stretch, k, pieces[k], number, dim, passes, share, sent);
      }
    }
    Real* radiance[3] = { &gathered.radiance.x, &gathered.radiance.y, &gathered.radiance.z };
    const Real light[3] = { sent.x, sent.y, sent.z };
    for (int c = 0; c < 3; ++c)
    {
      const Real through = gathered.through[Chromatic ? c : 0];
      *radiance[c] =
        hn::MulAdd(through, hn::IfThenElseZero(active, light[c]), *radiance[c]);
    }
    for (int c = 0; c < channels; ++c)
    {
      gathered.depths[c].add(dim[c]);
      // T − T (1 − e^−τ), so that what is sent and what passes add up.
      gathered.through[c] =
        hn::NegMulAdd(gathered.through[c], dim[c] * share[c], gathered.through[c]);
    }
    gathered.transmittance = largest_through(gathered);
    gathered.note_half_way(
      hn::And(active, gathered.transmittance < real(0.5f)), rays, stretch.middle);
  }

  /// See Mixture::Components: of extinctions that add up to Σ the sum of squares over Σ is taken.
  HWY_INLINE void mix_components(const Piece* pieces, Channels<Chromatic>& dim) const
  {
    for (int c = 0; c < (Chromatic ? 3 : 1); ++c)
    {
      Real squares = hn::Zero(float_tag);
      for (int k = 0; k < VolumeCount; ++k)
      {
        const Real part =
          Chromatic ? pieces[k].depth * real(Lit.volumes[k].channels[c]) : pieces[k].depth;
        squares = hn::MulAdd(part, part, squares);
      }
      dim[c] = DepthRays::mixed(dim[c], squares);
    }
  }

  /// Adds what one volume sends of a stretch.
  HWY_INLINE void add_piece(const Rays& rays,
    const Stretch& stretch,
    int k,
    const Piece& piece,
    int number,
    const Channels<Chromatic>& dim,
    const Channels<Chromatic>& passes,
    const Channels<Chromatic>& share,
    Vec3<Real>& sent)
  {
    const LitVolume& medium = Lit.volumes[k];
    // The fog is no grid: what follows does not look at one.
    const bool fog = Foggy && k == VolumeCount;
    const VolumeTask& volume = *(Task.volumes->data() + (fog ? 0 : k));
    Real* out[3] = { &sent.x, &sent.y, &sent.z };
    const bool classified = !Single && !fog && volume.meaning == ValueMeaning::Classified;
    Vec3<Real> colour{ real(1.0f), real(1.0f), real(1.0f) };
    Matter matter;
    if (classified)
    {
      matter = piece.matter;
      colour = Volumes[k].colour(rays.lines[k], stretch.middle, matter);
      if (volume.shade.enabled)
      {
        Volumes[k].find_gradient(rays.lines[k], stretch.middle, matter);
      }
    }
    if (!Single && !medium.lit)
    {
      if (classified) // emission and absorption
      {
        if (volume.shade.enabled)
        {
          const Vec3<Real> viewer = toward_viewer(volume.shade, rays.lines[k]);
          colour = shaded(
            volume.shade, rays.lines[k], viewer, stretch.middle, matter.gradient, colour);
        }
        const Real source[3] = { colour.x, colour.y, colour.z };
        for (int c = 0; c < 3; ++c)
        {
          *out[c] = hn::MulAdd(source[c] * piece.depth, share[c], *out[c]);
        }
      }
      return;
    }

    const Real tint[3] = { colour.x, colour.y, colour.z };
    Real scatter[3]; // scattering coefficient times length
    const Real powder = Rich && medium.powder
      ? powder_factor(rays, stretch, k, piece, classified)
      : real(1.0f);
    for (int c = 0; c < 3; ++c)
    {
      scatter[c] = piece.depth * real(medium.albedo[c]);
      if (Chromatic)
      {
        scatter[c] = scatter[c] * real(medium.channels[c]);
      }
      if (classified)
      {
        scatter[c] = scatter[c] * tint[c];
      }
      if (Rich)
      {
        scatter[c] = scatter[c] * powder;
      }
    }
    if (classified && volume.shade.enabled)
    {
      add_shading(rays, stretch, k, piece, number, matter, colour, dim, passes, share, sent);
    }
    else
    {
      for (int l = 0; l < LightCount; ++l)
      {
        Channels<Chromatic> light;
        if (Rich && Lit.lights[l].source.positional)
        {
          of_lamp(l, k, number, dim, light);
        }
        else
        {
          of_octaves(l, k, number, dim, passes, light);
        }
        for (int c = 0; c < 3; ++c)
        {
          *out[c] = hn::MulAdd(scatter[c] * real(Lit.lights[l].irradiance[c]), light[c], *out[c]);
        }
      }
    }
    if constexpr (Rich)
    {
      add_ambient(rays, stretch, scatter, share, sent);
      if (medium.emits)
      {
        add_emission(rays, stretch, k, piece, tint, share, sent);
      }
    }
  }

  /// Σ bᵐ p e^{−aᵐ τ}, averaged over the stretch as the eye sees it: τ runs evenly from its beginning
  /// to its end.
  HWY_INLINE void of_octaves(int l,
    int k,
    int number,
    const Channels<Chromatic>& dim,
    const Channels<Chromatic>& passes,
    Channels<Chromatic>& light) const
  {
    constexpr int channels = Chromatic ? 3 : 1;
    const Vec3<Real> low = get_shadow(l, number);
    const Vec3<Real> high = get_shadow(l, number + 1);
    const Real from[3] = { low.x, low.y, low.z };
    const Real to[3] = { high.x, high.y, high.z };
    const LitVolume& medium = Lit.volumes[k];
    const int octaves = Rich ? static_cast<int>(medium.octaves.size()) : 1;
    for (int c = 0; c < channels; ++c)
    {
      light[c] = hn::Zero(float_tag);
      for (int m = 0; m < octaves; ++m)
      {
        Real begin = from[c];
        Real end = to[c];
        if (Chromatic)
        {
          begin = begin * channel(c);
          end = end * channel(c);
        }
        Real factor = Phases.get(phase_index(l, k, m));
        if (m > 0)
        {
          begin = begin * real(medium.octaves[m].attenuation);
          end = end * real(medium.octaves[m].attenuation);
          factor = factor * real(medium.octaves[m].contribution);
        }
        if constexpr (Foggy)
        {
          begin = begin + fog_depth(l, 0, c);
          end = end + fog_depth(l, 1, c);
        }
        light[c] = hn::MulAdd(factor, mean_light(begin, end, dim[c], passes[c]), light[c]);
      }
    }
  }

  /// The mean over a stretch of e^{−τ} seen through what of the stretch lies before: τ runs evenly
  /// from `begin` to `end`, the depth of the stretch itself from 0 to `dim`.
  static HWY_INLINE Real mean_light(Real begin, Real end, Real dim, Real passes)
  {
    const Real first = hn::Exp(float_tag, hn::Neg(begin));
    const Real difference = dim + (end - begin);
    const Mask small = hn::Abs(difference) < real(0.5f);
    const Real series = first * mean_transmittance(hn::IfThenElseZero(small, difference), first);
    if (HWY_LIKELY(hn::AllTrue(float_tag, small)))
    {
      return series;
    }
    const Real last = passes * hn::Exp(float_tag, hn::Neg(end));
    return hn::IfThenElse(
      small, series, (first - last) / hn::IfThenElse(small, real(1.0f), difference));
  }

  HWY_INLINE Vec3<Real> world_place(const Rays& rays, Real position) const
  {
    return transform(Lit.world_from_index, rays.lines[0].at(position));
  }

  /// The way from a lamp to a place.
  HWY_INLINE Vec3<Real> lamp_offset(const Rays& rays, Real position, int l) const
  {
    return transform(Lit.lights[l].offset_from_index, rays.lines[0].at(position));
  }

  HWY_INLINE void find_lamp(const Rays& rays, const Stretch& stretch, int l)
  {
    LampStretch lamp;
    find_lamp_points(Lit.lights[l].source, lamp_offset(rays, stretch.middle, l), Viewer,
      (stretch.high - stretch.low) * rays.step_world, lamp);
    Lamps.set(lamp_index(l, 0), lamp.inverse_of_ends);
    for (int i = 0; i < lamp_points; ++i)
    {
      const LampPoint& point = lamp.points[i];
      Lamps.set(lamp_index(l, 1 + 3 * i), point.strength);
      Lamps.set(lamp_index(l, 2 + 3 * i), point.along);
      Lamps.set(lamp_index(l, 3 + 3 * i), point.further);
      find_phases(l, point.travel, i);
    }
  }
  HWY_INLINE std::size_t lamp_index(int l, int i) const
  {
    return static_cast<std::size_t>(l) * (1 + 3 * lamp_points) + i;
  }

  /// of_octaves() of a lamp, its strength included. Between the ends of the stretch optical depths
  /// run as the distance does in even matter.
  HWY_INLINE void of_lamp(
    int l, int k, int number, const Channels<Chromatic>& dim, Channels<Chromatic>& light) const
  {
    const Vec3<Real> low = get_shadow(l, number);
    const Vec3<Real> high = get_shadow(l, number + 1);
    const Real from[3] = { low.x, low.y, low.z };
    const Real to[3] = { high.x, high.y, high.z };
    const LitVolume& medium = Lit.volumes[k];
    const Real zero = hn::Zero(float_tag);
    for (int c = 0; c < (Chromatic ? 3 : 1); ++c)
    {
      const Real scale = Chromatic ? channel(c) : real(1.0f);
      light[c] = zero;
      for (int i = 0; i < lamp_points; ++i)
      {
        const Real along = Lamps.get(lamp_index(l, 2 + 3 * i));
        const Real bend = Lamps.get(lamp_index(l, 3 + 3 * i)) * Lamps.get(lamp_index(l, 0));
        const auto between = [&](Real a, Real b)
        { return max(hn::MulAdd(a + b, bend, lerp(a, b, along)), zero); };
        const Real depth = between(from[c] * scale, to[c] * scale);
        Real dimmed = dim[c] * along;
        if constexpr (Foggy)
        {
          dimmed = dimmed + between(fog_depth(l, 0, c), fog_depth(l, 1, c));
        }
        Real sum = zero;
        for (std::size_t m = 0; m < medium.octaves.size(); ++m)
        {
          const Real factor = Phases.get(phase_index(l, k, static_cast<int>(m), i)) *
            real(medium.octaves[m].contribution);
          const Real through = hn::MulAdd(depth, real(medium.octaves[m].attenuation), dimmed);
          sum = hn::MulAdd(factor, hn::Exp(float_tag, hn::Neg(through)), sum);
        }
        light[c] = hn::MulAdd(sum, Lamps.get(lamp_index(l, 1 + 3 * i)), light[c]);
      }
    }
  }

  HWY_INLINE void add_ambient(const Rays& rays,
    const Stretch& stretch,
    const Real* scatter,
    const Channels<Chromatic>& share,
    Vec3<Real>& sent) const
  {
    Real* out[3] = { &sent.x, &sent.y, &sent.z };
    Real fog = hn::Zero(float_tag); // above, of a channel of 1
    if constexpr (Foggy)
    {
      if (Lit.fog.falloff > 0.0f)
      {
        fog = transmittance_of(fog_exponent(stretch.middle)) *
          real(Lit.fog.extinction / Lit.fog.falloff);
      }
    }
    for (std::size_t i = 0; i < Lit.ambient.size(); ++i)
    {
      const AmbientLight& light = Lit.ambient[i];
      const float* node_from_index = light.depth[0].node_from_index;
      const Line line{ transform(node_from_index, rays.lines[0].begin),
        multiply(node_from_index, 4, rays.lines[0].delta) };
      Real depth = hn::Zero(float_tag);
      Real reaches = hn::Zero(float_tag);
      for (int c = 0; c < 3; ++c)
      {
        if (c < Lit.maps)
        {
          Ambients[i].values(light.depth[c].field, line, &stretch.middle, 1, &depth);
          depth = depth * real(light.depth[c].scale);
        }
        if (c == 0 || Chromatic)
        {
          Real whole = depth * real(Lit.channels[c]);
          if constexpr (Foggy)
          {
            if (light.from_above)
            {
              whole = hn::MulAdd(fog, real(Lit.volumes[VolumeCount].channels[c]), whole);
            }
          }
          reaches = second_exponential_integral(whole);
        }
        *out[c] =
          hn::MulAdd(scatter[c] * share[c], reaches * real(0.5f * light.radiance[c]), *out[c]);
      }
    }
  }

  HWY_INLINE void add_emission(const Rays& rays,
    const Stretch& stretch,
    int k,
    const Piece& piece,
    const Real* tint,
    const Channels<Chromatic>& share,
    Vec3<Real>& sent) const
  {
    const LitVolume& medium = Lit.volumes[k];
    Real* out[3] = { &sent.x, &sent.y, &sent.z };
    const VolumeTask& volume = Task.volumes->data()[k];
    const Real weight = real(volume.meaning == ValueMeaning::Density ? volume.weight : 1.0f);
    Vec3<Real> source = broadcast3<Real>(medium.emission);
    if (medium.black_body)
    {
      Real value;
      Temperatures[k].values(medium.temperature, rays.lines[k], &stretch.middle, 1, &value);
      source = source + black_body_of(medium, value);
    }
    source = source * weight;
    const Real emitted[3] = { source.x, source.y, source.z };
    for (int c = 0; c < 3; ++c)
    {
      *out[c] = hn::MulAdd(emitted[c] * tint[c] * piece.amount, share[c], *out[c]);
    }
  }

  /// See Powder.
  HWY_INLINE Real powder_factor(const Rays& rays,
    const Stretch& stretch,
    int k,
    const Piece& piece,
    bool classified) const
  {
    const LitVolume& medium = Lit.volumes[k];
    const Mask some = piece.length > hn::Zero(float_tag);
    const Real mean = piece.amount / hn::IfThenElse(some, piece.length, real(1.0f));
    const Real value =
      classified ? opacity_from_optical_depth(mean * real(medium.unit_distance)) : mean;
    const float normal[3] = { medium.height[0], medium.height[1], medium.height[2] };
    const Real height =
      dot(broadcast3<Real>(normal), rays.lines[k].at(stretch.middle)) + real(medium.height[3]);
    return powder_of(medium, value, height);
  }

  /// Surface-like shading, its lights dimmed by the matter on their way.
  HWY_INLINE void add_shading(const Rays& rays,
    const Stretch& stretch,
    int k,
    const Piece& piece,
    int number,
    const Matter& matter,
    const Vec3<Real>& colour,
    const Channels<Chromatic>& dim,
    const Channels<Chromatic>& passes,
    const Channels<Chromatic>& share,
    Vec3<Real>& sent) const
  {
    const Real zero = hn::Zero(float_tag);
    const ShadeModel& model = Task.volumes->data()[k].shade;
    const LitVolume& medium = Lit.volumes[k];
    const Vec3<Real> normal =
      surface_normal<Real>(model, world_gradient(model, matter.gradient), Viewer);
    const Vec3<Real> place = world_place(rays, stretch.middle);
    const Vec3<Real> tint = colour * broadcast3<Real>(medium.albedo);
    Real* out[3] = { &sent.x, &sent.y, &sent.z };
    const Vec3<Real> even = tint * broadcast3<Real>(model.ambient);
    const Real ambient[3] = { even.x, even.y, even.z };
    for (int c = 0; c < 3; ++c)
    {
      *out[c] = hn::MulAdd(ambient[c] * piece.depth, share[c], *out[c]);
    }
    for (int l = 0; l < LightCount; ++l)
    {
      Vec3<Real> diffuse{ zero, zero, zero };
      Vec3<Real> specular{ zero, zero, zero };
      add_light<Real>(model, model.lights[l], incidence<Real>(model.lights[l], place), normal,
        Viewer, diffuse, specular);
      const Vec3<Real> source = tint * diffuse + specular;
      const Real light[3] = { source.x, source.y, source.z };
      const Vec3<Real> low = get_shadow(l, number);
      const Vec3<Real> high = get_shadow(l, number + 1);
      const Real from[3] = { low.x, low.y, low.z };
      const Real to[3] = { high.x, high.y, high.z };
      Channels<Chromatic> reaches;
      for (int c = 0; c < (Chromatic ? 3 : 1); ++c)
      {
        const Real scale = Chromatic ? channel(c) : real(1.0f);
        Real begin = from[c] * scale;
        Real end = to[c] * scale;
        if constexpr (Foggy)
        {
          begin = begin + fog_depth(l, 0, c);
          end = end + fog_depth(l, 1, c);
        }
        reaches[c] = mean_light(begin, end, dim[c], passes[c]);
      }
      for (int c = 0; c < 3; ++c)
      {
        *out[c] = hn::MulAdd(light[c] * piece.depth, reaches[c], *out[c]);
      }
    }
  }

  /// As the other integrators: from the bend of the optical depth.
  HWY_INLINE void estimate_error(Real depth, LitGathered& gathered)
  {
    const Real off =
      hn::Abs(depth - DepthBefore - DepthBefore + DepthEarlier) * real(1.0f / 24.0f);
    gathered.error =
      hn::MulAdd(gathered.transmittance, hn::Min(off, real(1.0f)), gathered.error);
    DepthEarlier = DepthBefore;
    DepthBefore = depth;
  }

  /// Steps through which no volume can be seen.
  HWY_INLINE Real leap(const Rays& rays, Real position) const
  {
    return leap_all(*Task.volumes, rays, position);
  }

  const MarchTask& Task;
  const LitTask& Lit;
  int VolumeCount;
  int PieceCount; ///< volumes and fog
  int LightCount;
  std::vector<MatterVolume> Volumes;
  LightDepths Depths;
  PacketArray Shadows;
  PacketArray FogDepths;
  PacketArray Lamps; ///< lamp_index()
  PacketArray Phases;
  FieldFunctions Functions;
  std::vector<FieldFunctions> Temperatures;
  std::vector<FieldFunctions> Ambients;
  bool CanLeap = false;
  Vec3<Real> Viewer;
  Real DepthBefore;
  Real DepthEarlier;
  Real ExponentBegin; ///< of the fog's profile: at position 0, and from one step to the next
  Real ExponentDelta;
  std::unique_ptr<FogGaps> Gaps;
};

template <bool Single, bool Chromatic, bool Rich, bool Foggy>
struct RecordOf<LitIntegrator<Single, Chromatic, Rich, Foggy>>
{
  using type = LitGathered;
};

/// Takes the kernel compiled for what the scene has.
template <bool Single>
MarchCount march_lit(const MarchTask& task)
{
  if (task.lit->rich)
  {
    return task.lit->chromatic ? march_tile<LitIntegrator<Single, true, true>>(task)
                               : march_tile<LitIntegrator<Single, false, true>>(task);
  }
  return task.lit->chromatic ? march_tile<LitIntegrator<Single, true, false>>(task)
                             : march_tile<LitIntegrator<Single, false, false>>(task);
}

}
}
HWY_AFTER_NAMESPACE();

#endif
