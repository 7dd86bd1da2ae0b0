// Compressed pixels of DICOM files. Private to this module.
#pragma once

#include "voxel_reader.h" // for Progress

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace brume::io
{

/// Whether GDCM, with which vtk-dicom is built, has a decoder for a transfer syntax.
bool can_decode(const std::string& transfer_syntax);

/// All pictures of a file, in its order, as plain numbers of this machine: `bytes` in all. The
/// decoders (GDCM and what it stands on) trust what they read, so they run in a process of their own,
/// which a damaged file may bring down or keep busy (guarded_process.h): it is given a second,
/// and one more for each 4 MB.
/// `owner` and `path` are as in file_length(). `progress` is asked now and then, with 0. Throws fail() where
/// they cannot be decoded, and where `progress` says so.
std::vector<unsigned char> decode_dicom(const std::string& owner, const std::string& path,
  std::uint64_t bytes, int scalar_size, std::uint64_t frames, const Progress& progress = {});

/// What this takes in memory for a file of so many bytes of pixels, the decoder's own and the pixels that it
/// hands over.
double decoding_need(double bytes);

}
