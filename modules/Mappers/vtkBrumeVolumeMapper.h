#ifndef vtkBrumeVolumeMapper_h
#define vtkBrumeVolumeMapper_h

#include "vtkBrumeMappersModule.h"
#include "vtkVolumeMapper.h"

class VTKBRUMEMAPPERS_EXPORT vtkBrumeVolumeMapper : public vtkVolumeMapper
{
public:
  vtkTypeMacro(vtkBrumeVolumeMapper, vtkVolumeMapper);

protected:
  vtkBrumeVolumeMapper() = default;
  ~vtkBrumeVolumeMapper() override = default;
};

#endif
