// Raw voxels with a JSON file that says what they are. Private to this module.
#pragma once

#include "scan_header.h"

namespace brume::io
{

/// The sidecar of a file: its name with ".json" behind it; empty where there is none.
std::string sidecar_of(const std::string& path);

/// How to write one, for messages.
std::string raw_advice(const std::string& path);

/// `path` is the sidecar, or the voxels with a sidecar beside them. Throws fail().
ScanHeader read_raw_header(const std::string& path);

}
