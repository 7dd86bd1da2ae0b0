// A scene in words and numbers, for reports.
#pragma once

#include "Analysis/comparison.h"

namespace brume::app
{

struct VolumeScene;

/// What is drawn, with this step (world units), and what is the same for all mappers.
SceneDescription describe(const VolumeScene& scene, double step);

}
