// Pictures to and from files: linear light as OpenEXR and Radiance HDR, what a screen shows as PNG.
#pragma once

#include "vtkBrumeIOModule.h" // the export macro alone

#include "Transport/film.h"

#include <map>
#include <string>
#include <vector>

namespace brume
{

/// What stands between linear light and the 8 bits of a screen. It comes last, and never touches
/// an EXR.
struct Display
{
  enum class Curve
  {
    None, ///< the value is written as it is, as VTK's own frames are
    SRGB  ///< the value is linear light and is encoded by the curve of IEC 61966-2-1
  };
  double exposure = 0;        ///< stops: the value is multiplied by 2^exposure first; any finite number
  Curve curve = Curve::None;
};

/// The byte that a display makes of a value: exposed, clamped to [0, 1], encoded, rounded to the
/// nearest. NaN gives 0, +infinity 255.
VTKBRUMEIO_EXPORT unsigned char display_byte(float value, const Display& display);

/// Writes a film as OpenEXR, 32-bit float: `R G B` the linear radiance with nothing behind,
/// `A` = 1 − the mean of the three transmittances, `transmittance.R`, `.G`, `.B`, and `Z` the depth
/// (+infinity where there is none), and `error` the film's estimate of each pixel's error, as a
/// fraction of white. Values are stored bit for bit (a NaN too). `metadata` becomes string attributes of the file, beside `Software`.
/// The file appears whole or not at all (atomic_file.h).
/// Throws std::runtime_error, "PATH: what is wrong: what to do": an ending other than .exr, an empty
/// film or one whose planes are of the wrong size, a folder that is missing or may not be written, a
/// full disk.
VTKBRUMEIO_EXPORT void write_exr(const Film& film, const std::string& path,
  const std::map<std::string, std::string>& metadata = {});

/// Reads what write_exr() wrote, bit for bit. An EXR of another maker needs R,
/// G and B: without `transmittance.*` they are 1 − A, without A too they are 0 (opaque); without Z
/// the depth is +infinity, without `error` the error is 0. Throws as write_exr() does.
VTKBRUMEIO_EXPORT Film read_exr(const std::string& path);

/// Writes a picture as PNG, 8 bits each of R, G, B. `rgb` is interleaved, rows from the bottom up,
/// 3 · width · height floats, as over_background() gives. Throws as write_exr() does, with .png.
VTKBRUMEIO_EXPORT void write_png(const std::vector<float>& rgb, int width, int height,
  const std::string& path, const Display& display = {});

/// The same of a film over a background of one colour (linear R, G, B).
VTKBRUMEIO_EXPORT void write_png(const Film& film, const double background[3],
  const std::string& path, const Display& display = {});

/// Writes a picture as Radiance HDR: linear light, R, G, B with one exponent, within 1/256 of the
/// largest of the three. `rgb` as for write_png(); what is negative or no number becomes 0. Throws
/// as write_exr() does, with .hdr.
VTKBRUMEIO_EXPORT void write_hdr(
  const std::vector<float>& rgb, int width, int height, const std::string& path);

/// Throws std::runtime_error, "PATH: what is wrong: what to do", unless the path ends in .png, .exr or
/// .hdr (any case): for a call that should fail before the work and not after it.
VTKBRUMEIO_EXPORT void check_picture_path(const std::string& path);

}
