/**
 * @class   vtkBrumeParticleSource
 * @brief   a cloud of particles that moves: emitted, carried by a turbulent wind, faded
 *
 * Gives the density of fountains of mist at any moment: not below 0, without a unit, and above 1
 * where many particles meet. Multiply by an extinction (10 per metre for the default sizes) to get
 * the medium's extinction. Dense or sparse output, time steps, size and seed are the superclass's,
 * with other defaults: Size 128, time steps from 0 to 10.
 *
 * World units are metres and seconds: the volume fills a box of Width x Width x Width, x and y
 * around 0, z up from 0. Emitters stand at a tenth of the Width above the ground. What moves and
 * how: data-generators/particles.h and flow.h. A moment is the same to the bit whichever was asked
 * for before. More than 20 million particles at once are an error.
 *
 * @sa vtkBrumeSmokeSource
 */
#ifndef vtkBrumeParticleSource_h
#define vtkBrumeParticleSource_h

#include "vtkBrumeFieldSource.h"

namespace brume
{
struct ParticleCloudOptions;
}

class VTKBRUMESOURCES_EXPORT vtkBrumeParticleSource : public vtkBrumeFieldSource
{
public:
  static vtkBrumeParticleSource* New();
  vtkTypeMacro(vtkBrumeParticleSource, vtkBrumeFieldSource);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Width of the box, in metres. Default 6, range 0.01 to 1e6; outside it the nearest end. Nothing
   * else grows with it.
   */
  vtkSetClampMacro(Width, double, 0.01, 1e6);
  vtkGetMacro(Width, double);
  ///@}

  ///@{
  /**
   * How many emitters there are. One stands in the middle of x and y, more stand evenly on a ring
   * with a radius of a quarter of the Width; all of them 0.1 Width above the box's floor. Default
   * 1, range 1 to 64; outside it the nearest end.
   */
  vtkSetClampMacro(NumberOfEmitters, int, 1, 64);
  vtkGetMacro(NumberOfEmitters, int);
  ///@}

  ///@{
  /**
   * Radius of an emitter, metres (default 0.15, not below 0), and how many particles a second it
   * emits (default 1500, not below 0).
   */
  vtkSetMacro(EmitterRadius, double);
  vtkGetMacro(EmitterRadius, double);
  vtkSetMacro(Rate, double);
  vtkGetMacro(Rate, double);
  ///@}

  ///@{
  /**
   * The particles' speed upwards at first, metres a second (default 3, any finite value), and the
   * spread of their first velocities: each differs from that by a vector drawn evenly from a ball
   * of this radius, metres a second (default 1, not below 0).
   */
  vtkSetMacro(Speed, double);
  vtkGetMacro(Speed, double);
  vtkSetMacro(Spread, double);
  vtkGetMacro(Spread, double);
  ///@}

  ///@{
  /**
   * How long the emitters have been at work at time 0, seconds; nothing is there before. Default 5,
   * any finite value.
   */
  vtkSetMacro(WarmUp, double);
  vtkGetMacro(WarmUp, double);
  ///@}

  ///@{
  /**
   * How long a particle lives, seconds: each from 0.6 to 1 times that. Default 5, above 0. Too
   * long a life is an error: emitters * Rate * Life may be 2e7 at most (those alive at once), and
   * that times the number of time steps in a life 1e10.
   */
  vtkSetMacro(Life, double);
  vtkGetMacro(Life, double);
  ///@}

  ///@{
  /**
   * A particle's first radius, metres (default 0.12, above 0), how fast it grows, metres a second
   * (default 0.06, not below 0), and the density in its middle at first, without a unit (default
   * 0.1, not below 0). It thins as it grows.
   */
  vtkSetMacro(ParticleRadius, double);
  vtkGetMacro(ParticleRadius, double);
  vtkSetMacro(Growth, double);
  vtkGetMacro(Growth, double);
  vtkSetMacro(Density, double);
  vtkGetMacro(Density, double);
  ///@}

  ///@{
  /**
   * The steady wind, metres a second along x, y and z (default 0.5, 0.15, 0), the speed at which
   * particles rise in it (default 0.4), both any finite value, and the time in which they take on
   * its speed, seconds (default 0.5, above 0).
   */
  vtkSetVector3Macro(Wind, double);
  vtkGetVector3Macro(Wind, double);
  vtkSetMacro(Rise, double);
  vtkGetMacro(Rise, double);
  vtkSetMacro(Response, double);
  vtkGetMacro(Response, double);
  ///@}

  ///@{
  /**
   * Eddies: their speed, metres a second, root mean square (default 0.8, not below 0), and the size
   * of the largest, metres (default 1, above 0).
   */
  vtkSetMacro(Turbulence, double);
  vtkGetMacro(Turbulence, double);
  vtkSetMacro(EddySize, double);
  vtkGetMacro(EddySize, double);
  ///@}

protected:
  vtkBrumeParticleSource();
  ~vtkBrumeParticleSource() override;

  std::shared_ptr<const brume::Field> MakeField() override;
  bool Prepare(const brume::Field& field, double time) override;
  double GetPreparedShare() const override;
  bool FillImage(vtkImageData* image,
    const brume::Field& field,
    const brume::Lattice& grid,
    double time) override;

  double Width = 6.0;
  int NumberOfEmitters = 1;
  double EmitterRadius = 0.15;
  double Rate = 1500.0;
  double Speed = 3.0;
  double Spread = 1.0;
  double WarmUp = 5.0;
  double Life = 5.0;
  double ParticleRadius = 0.12;
  double Growth = 0.06;
  double Density = 0.1;
  double Wind[3] = { 0.5, 0.15, 0.0 };
  double Rise = 0.4;
  double Response = 0.5;
  double Turbulence = 0.8;
  double EddySize = 1.0;

private:
  vtkBrumeParticleSource(const vtkBrumeParticleSource&) = delete;
  void operator=(const vtkBrumeParticleSource&) = delete;

  brume::ParticleCloudOptions GetOptions() const;
};

#endif
