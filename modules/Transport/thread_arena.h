// Where parallel work is done with so many threads.
#pragma once

#include <tbb/task_arena.h>

namespace brume
{

/// The arena of that many threads; 0 or less: as many as processors. Made when it is first asked
/// for, and kept until the program ends: oneTBB 2021.8 does not give back some 7 KB of each arena
/// that is made, and a window makes hundreds of pictures a minute. May be used from within
/// itself. Of several threads that use it at once one may have its work done by another's thread, where its
/// progress is not asked, and wait for the other's.
tbb::task_arena& thread_arena(int threads);

}
