#include "vtkBrumeVolumeMapper.h"
