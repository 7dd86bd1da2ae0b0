// A cloud of particles: emitted, carried by a wind, grown and faded; then voxels made of them.
#pragma once

#include "data-generators/flow.h"
#include "data-generators/sampling.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace brume
{

/// Where particles come from: a ball.
struct Emitter
{
  glm::dvec3 place{ 0.0 };              ///< its centre, metres
  double radius = 0.15;                 ///< metres, not below 0
  glm::dvec3 velocity{ 0.0, 0.0, 3.0 }; ///< of particles when they are born, metres a second
  double spread = 1.0;                  ///< how far that varies, metres a second, not below 0
  double rate = 1500.0;                 ///< particles a second, not below 0
  double start = 0.0;                   ///< seconds
  double stop = 1e9;                    ///< seconds
};

/// What cloud it is. Lengths in metres, times in seconds.
struct ParticleCloudOptions
{
  std::uint32_t seed = 1;
  std::vector<Emitter> emitters = std::vector<Emitter>(1);
  FlowOptions flow;
  /// Speed at which particles rise against the air, metres a second: they are lighter. Finite.
  double rise = 0.4;
  /// Time in which a particle takes on the speed of the air around it; above 0.
  double response = 0.5;
  /// How long particles live, seconds, each from 0.6 to 1 times that; above 0.
  double life = 5.0;
  /// Radius of a particle at its birth, metres, above 0; and how fast it grows, metres a second,
  /// not below 0.
  double radius = 0.12;
  double growth = 0.06;
  /// Density in the middle of a particle of its first radius; not below 0. It thins as it grows.
  double density = 0.1;
  /// Seconds of a step of the motion; above 0.
  double step = 0.04;
};

/// One particle: a ball of density peak (1 - d^2/radius^2)^2, d the distance from its centre. It
/// falls from the centre to 0 at the rim, with no kink there, and holds peak radius^3 32 pi/105 in
/// all.
struct Particle
{
  glm::dvec3 place{ 0.0 };
  double radius = 0.0;
  double peak = 0.0;
};

/// How much a particle holds.
double amount_of(const Particle& particle);

/// The particles of a moment.
///
/// Particle n of an emitter is born at start + (n + u)/rate, u in [0, 1) at random, somewhere in
/// the ball, with the emitter's velocity. From then on it moves by steps of equal length, the last
/// one as much shorter as need be: its velocity v nears that of the air,
///   v <- (v + r w)/(1 + r),  w = flow(x, t) + (0, 0, rise),  r = step/response,
/// which no step makes unstable, and its place x goes on by the mean of the old and the new v. So
/// where a particle is depends on seed, number and time alone: moments may be asked for in any
/// order, and the same moment is the same to the bit, on every machine and any number of threads.
/// Its radius grows evenly, its peak falls as 1/radius^3 (it keeps what it holds), times a fade: in
/// over the first tenth of its life, out over the last half.
class ParticleCloud
{
public:
  /// Throws std::invalid_argument for options out of their range, for more than 20 million
  /// particles alive at once, and for more than 10^10 steps: those alive times life/step.
  explicit ParticleCloud(const ParticleCloudOptions& options = {});

  /// Those alive at a time, ordered by emitter and number. Runs on all threads that TBB gives. A
  /// time that is not finite gives none, and so does a wish of `progress` to stop.
  std::vector<Particle> particles(double time, const Progress& progress = {}) const;

  const ParticleCloudOptions& options() const { return m_options; }

private:
  ParticleCloudOptions m_options;
  Flow m_flow;
};

/// The particle that voxels of a size can hold: one with a radius below `least_radius` gets that,
/// thinned so as to hold what it held. With 1.5 voxels no particle slips between them.
Particle widened(const Particle& particle, double least_radius);

/// Fills a block of a grid with the sum of the particles' densities at the voxels' centres, each
/// particle widened to 1.5 voxels at least.
///
/// The voxels are taken by bricks of 8^3. Particles are sorted into bricks first, in their order,
/// and each brick then gathers its own in double precision: no two threads write to one voxel, and
/// each voxel adds in the order of the particles, so bytes depend on neither the threads nor the
/// block. Spacing must be the same along all axes. What is not finite counts as no particle. For
/// the rest as sample().
bool deposit(const std::vector<Particle>& particles,
  const Lattice& grid,
  const Extent& extent,
  float* values,
  const Progress& progress = {});

/// The same density as a field, for sparse sampling: at voxels' centres it has the very bits that
/// deposit() gives with the same least radius. It keeps the particles of the moment that it was
/// asked for last, sorted into cells; any number of threads may ask, best all of them for one
/// moment.
class ParticleField : public Field
{
public:
  /// The cloud, the box that bounds() gives, and widened()'s least radius, metres, not below 0.
  /// Throws std::invalid_argument where there is no such cloud or box.
  ParticleField(const ParticleCloudOptions& options, const Box& box, double least_radius);
  ~ParticleField() override;

  Box bounds() const override { return m_box; }
  float value(const glm::dvec3& place, double time) const override;
  void values(const PlaceBlock& places, double time, float* out) const override;
  /// 0 where no particle reaches.
  FieldRange range_in(const Box& box, double time) const override;

  /// Moves the particles to a moment, on all threads that TBB gives and with progress. Who asks for
  /// values without it waits for one thread to do that. False where `progress` asked to stop.
  bool prepare(double time, const Progress& progress = {}) const;

  /// The particles of a moment, widened, that reach into the box.
  std::shared_ptr<const std::vector<Particle>> particles(double time) const;

private:
  struct Moment;
  std::shared_ptr<const Moment> moment(double time, const Progress& progress = {}) const;

  ParticleCloud m_cloud;
  Box m_box;
  double m_least_radius;
  mutable std::mutex m_mutex; ///< of the next
  mutable std::shared_ptr<const Moment> m_moment;
};

}
