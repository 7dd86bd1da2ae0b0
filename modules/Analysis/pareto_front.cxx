#include "pareto_front.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brume
{

std::vector<std::size_t> pareto_front(const std::vector<Cost>& costs)
{
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < costs.size(); ++i)
  {
    if (std::isfinite(costs[i].seconds) && std::isfinite(costs[i].error))
    {
      order.push_back(i);
    }
  }
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b)
    {
      return costs[a].seconds < costs[b].seconds ||
        (costs[a].seconds == costs[b].seconds && costs[a].error < costs[b].error);
    });
  std::vector<std::size_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order)
  {
    if (costs[i].error < least)
    {
      front.push_back(i);
      least = costs[i].error;
    }
  }
  return front;
}

}
