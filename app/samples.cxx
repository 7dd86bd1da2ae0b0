// The table of samples.
#include "input.h"

namespace brume::app
{

const std::vector<Sample>& samples()
{
  static const std::vector<Sample> table{};
  return table;
}

}
