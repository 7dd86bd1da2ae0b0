// What VTK's objects ask for and the mappers do not do, by name. Internal to Mappers.
#ifndef ignored_settings_h
#define ignored_settings_h

#include <string>
#include <vector>

class vtkVolume;

namespace brume
{
struct MaskSettings;

/// Settings of the mask and of the volume's property that are not followed, as they stand now:
/// only those that ask for something else than is drawn.
std::vector<std::string> ignored_settings(
  vtkVolume* volume, const MaskSettings& mask, int components);

}

#endif
