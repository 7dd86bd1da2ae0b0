/**
 * @class   vtkBrumeFieldSource
 * @brief   a density that is a function of place and time, sampled dense or sparse
 *
 * What the sources of clouds, fog, particles and smoke have in common beyond vtkBrumeSampledSource:
 * which one of its kind, and when. They give a density without a unit, named "density": multiply by
 * an extinction per metre to get the medium's extinction. World units are metres and seconds, z is
 * up.
 *
 * Time: the source has TIME_STEPS (NumberOfTimeSteps of them, from StartTime to EndTime) and a
 * TIME_RANGE. Any moment can be asked for by UPDATE_TIME_STEP, not those of the steps alone; where
 * none is asked for it is Time. The output carries the moment in DATA_TIME_STEP.
 */
#ifndef vtkBrumeFieldSource_h
#define vtkBrumeFieldSource_h

#include "vtkBrumeSampledSource.h"
#include "vtkBrumeSourcesModule.h" // for the export macro

class VTKBRUMESOURCES_EXPORT vtkBrumeFieldSource : public vtkBrumeSampledSource
{
public:
  vtkTypeMacro(vtkBrumeFieldSource, vtkBrumeSampledSource);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Which one of its kind. Default 1, any value.
   */
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * The moment, in seconds, where the pipeline asks for none: the wind has blown for so long.
   * Default 0, any finite value.
   */
  vtkSetMacro(Time, double);
  vtkGetMacro(Time, double);
  ///@}

  ///@{
  /**
   * The moments that the pipeline is told of: so many, evenly from StartTime to EndTime, in
   * seconds. Default 101 from 0 to 100; the number from 1 to 1e6, outside it the nearest end. An
   * EndTime that is not after StartTime leaves StartTime alone.
   */
  vtkSetMacro(StartTime, double);
  vtkGetMacro(StartTime, double);
  vtkSetMacro(EndTime, double);
  vtkGetMacro(EndTime, double);
  vtkSetClampMacro(NumberOfTimeSteps, int, 1, 1000000);
  vtkGetMacro(NumberOfTimeSteps, int);
  ///@}

protected:
  vtkBrumeFieldSource();
  ~vtkBrumeFieldSource() override;

  void DescribeTime(vtkInformation* info) override;
  double GetMoment(vtkInformation* info) override;

  int Seed = 1;
  double Time = 0.0;
  double StartTime = 0.0;
  double EndTime = 100.0;
  int NumberOfTimeSteps = 101;

private:
  vtkBrumeFieldSource(const vtkBrumeFieldSource&) = delete;
  void operator=(const vtkBrumeFieldSource&) = delete;
};

#endif
