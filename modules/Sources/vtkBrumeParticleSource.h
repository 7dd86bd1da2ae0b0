/**
 * @class   vtkBrumeParticleSource
 * @brief   a cloud of particles that moves: emitted, carried by a turbulent wind, faded
 *
 * Gives the density of a puffing fountain of mist as a vtkImageData of floats, at any moment. Point
 * scalars are named "density", without a unit, 0 where nothing is: multiply by an extinction (some
 * per metre for the default sizes) to get the medium's extinction.
 *
 * World units are metres and seconds: the volume fills a box of Width x Width x Width, x and y
 * around 0, z up from 0. Emitters stand on a ring at a tenth of the Width above the ground. What
 * moves and how: data-generators/particles.h and flow.h.
 *
 * Time: the source has TIME_STEPS (NumberOfTimeSteps of them, from StartTime to EndTime) and a
 * TIME_RANGE, and makes whatever moment the pipeline asks for (UPDATE_TIME_STEP), not only those;
 * if it asks for none, that of Time. A moment is the same to the bit whichever was asked for
 * before.
 *
 * The source makes the pieces that it is asked for; together they equal the whole, to the bit. The
 * same settings give the same bytes on every machine and with any number of threads. It reports
 * progress, and stops soon after AbortExecute is set: the output is then empty, and the next update
 * starts over. A setting that is not a number, or asks for more than 20 million particles at once,
 * is an error, and gives an empty output.
 *
 * @sa vtkBrumeSmokeSource
 */
#ifndef vtkBrumeParticleSource_h
#define vtkBrumeParticleSource_h

#include "vtkBrumeSourcesModule.h" // for the export macro
#include "vtkImageAlgorithm.h"

#include <memory> // for the particles that are kept

namespace brume
{
struct ParticleCloudOptions;
}

class VTKBRUMESOURCES_EXPORT vtkBrumeParticleSource : public vtkImageAlgorithm
{
public:
  static vtkBrumeParticleSource* New();
  vtkTypeMacro(vtkBrumeParticleSource, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Voxels along each side of the volume. Voxels are cubes. Default 128, range 2 to 2048; outside
   * it the nearest end.
   */
  vtkSetClampMacro(Size, int, 2, 2048);
  vtkGetMacro(Size, int);
  ///@}

  ///@{
  /**
   * Which cloud. Default 1, any value.
   */
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * The moment that is made where the pipeline asks for none, in seconds since the emitters began.
   * Default 5, any finite value; nothing is there before 0.
   */
  vtkSetMacro(Time, double);
  vtkGetMacro(Time, double);
  ///@}

  ///@{
  /**
   * The moments that the pipeline is told of: so many, evenly from StartTime to EndTime, in
   * seconds. Default 101 from 0 to 10; the number from 1 to 1e6, outside it the nearest end. An
   * EndTime that is not after StartTime leaves StartTime alone.
   */
  vtkSetMacro(StartTime, double);
  vtkGetMacro(StartTime, double);
  vtkSetMacro(EndTime, double);
  vtkGetMacro(EndTime, double);
  vtkSetClampMacro(NumberOfTimeSteps, int, 1, 1000000);
  vtkGetMacro(NumberOfTimeSteps, int);
  ///@}

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
   * How many emitters there are. One stands in the middle of the box's floor, more stand evenly on
   * a ring of a quarter of the Width. Default 1, range 1 to 64; outside it the nearest end.
   */
  vtkSetClampMacro(NumberOfEmitters, int, 1, 64);
  vtkGetMacro(NumberOfEmitters, int);
  ///@}

  ///@{
  /**
   * Radius of an emitter, metres (default 0.15, not below 0), how many particles a second it emits
   * (default 1500, not below 0), and their speed upwards at first, metres a second (default 3, any
   * finite value).
   */
  vtkSetMacro(EmitterRadius, double);
  vtkGetMacro(EmitterRadius, double);
  vtkSetMacro(Rate, double);
  vtkGetMacro(Rate, double);
  vtkSetMacro(Speed, double);
  vtkGetMacro(Speed, double);
  vtkSetMacro(Spread, double);
  vtkGetMacro(Spread, double);
  ///@}

  ///@{
  /**
   * How long a particle lives, seconds: each from 0.6 to 1 times that. Default 5, above 0.
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

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int Size = 128;
  int Seed = 1;
  double Time = 5.0;
  double StartTime = 0.0;
  double EndTime = 10.0;
  int NumberOfTimeSteps = 101;
  double Width = 6.0;
  int NumberOfEmitters = 1;
  double EmitterRadius = 0.15;
  double Rate = 1500.0;
  double Speed = 3.0;
  double Spread = 1.0;
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

  struct Moment;
  std::unique_ptr<Moment> Kept; // the particles of the last moment, for its other pieces
};

#endif
