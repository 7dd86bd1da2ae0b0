// What a vtkBrumeFog keeps, which volume mappers that draw it must know. Internal to Mappers.
#ifndef fog_internals_h
#define fog_internals_h

#include "vtkBrumeFilmBlender.h"
#include "vtkBrumeFog.h"
#include "volume_group.h"

#include "Transport/film.h"
#include "Transport/medium.h"

#include "vtkBrumeSky.h"

#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <vector>

struct vtkBrumeFog::Internals
{
  std::vector<brume::PhaseLobe> Lobes;
  vtkSmartPointer<vtkBrumeSky> Sky;
  brume::DrawnWithOthers Drawn; ///< with volumes
  vtkNew<vtkBrumeFilmBlender> Blender;
  brume::Film Film;
};

#endif
