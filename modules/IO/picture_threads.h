// Internal to IO.
#pragma once

namespace brume::io
{

/// To be called before anything opens or writes a picture: keeps OpenImageIO and OpenEXR from starting threads,
/// which a copy of this process (guarded_process.h) would wait for and not have. A program that has
/// OpenEXR's threads started by itself gets "takes too long to read" for its environment maps in .exr.
void keep_picture_threads_out();

}
