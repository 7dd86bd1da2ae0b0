// What OpenImageIO does to whole pictures.
#pragma once

#include "picture.h"

namespace brume
{

/// The share of pixels, in [0, 1], at which an eye tells two pictures apart, by OpenImageIO's
/// compare_Yee (Yee, Pattanaik and Greenberg 2001, as in Yee's perceptual image difference): white at
/// 100 cd/m², 40 pixels to a degree of the eye's field, as of a screen on a desk. Values below 0 count as
/// 0. It weighs contrasts by their fineness: the brightness of a flat area in a flat surrounding it does not
/// judge. A pixel that is not finite in either is told apart. Throws std::invalid_argument as measure() does.
VTKBRUMEANALYSIS_EXPORT double perceptual_difference(const Picture& test, const Picture& truth);

/// The picture in another size, by OpenImageIO's resize: linear between the centres of pixels where it
/// grows.
/// Throws std::invalid_argument for a width or height that is not positive.
VTKBRUMEANALYSIS_EXPORT Picture scaled(const Picture& picture, int width, int height);

}
