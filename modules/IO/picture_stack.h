// Pictures, one a slice: TIFF files of several pages, and numbered TIFF and PNG files. Private to this
// module.
#pragma once

#include "file_series.h"
#include "voxel_reader.h"

#include <string>
#include <vector>

namespace brume::io
{

/// The header of a picture file, whose pages are the slices, or of several files of one page each. All
/// must be of one size and type. `path` is what the user named. ImageJ's description of a TIFF gives
/// the distance between slices, the unit and the volumes over time; TIFF's own resolution the size of
/// a pixel. Pictures are opened in a process of its own (guarded_process.h). Throws fail().
ScanHeader read_picture_header(const std::string& path, const std::vector<NumberedFile>& files);

/// How many pages a picture file has; throws fail() as above.
int count_pages(const std::string& path);

/// The TIFF or PNG files of a folder by the last numbers of their names; empty where there are none.
/// Throws fail() where there are both.
std::vector<NumberedFile> pictures_in(const std::string& folder);

/// How many of either there are, by their names.
std::size_t count_pictures(const std::string& folder);

/// Reads what read_picture_header() found, in a process of its own. As read_voxels().
void read_pictures(const ScanHeader& header, unsigned char* out, const Progress& progress);

}
