#include "vtkBrumeVolumeMapper.h"
#include "Transport/film.h"
