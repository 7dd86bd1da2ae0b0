// Whether an output can be written, asked before the work that makes it.
#pragma once

#include <string>
#include <vector>

namespace brume::app
{

/// Throws Failure when a file cannot be written at `path`: its folder is missing or may not be
/// written, or a folder has that name. BadCall when `path` is the input itself, or one of `others`
/// (further outputs of the same call). Changes nothing; an empty path is passed over.
void check_output(
  const std::string& path, const std::string& input, const std::vector<std::string>& others = {});

}
