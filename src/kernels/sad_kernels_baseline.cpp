#include <algorithm>

#include <opencv2/core.hpp>

#include "kernels/sad_kernels.h"
#include "kernels/window_differences.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {

void sadCosts(const SadSearch& search, std::int16_t* costs) {
  const WindowDifferences differences(search);
  differences.ofParts(costs);
  const auto likely = static_cast<int>(std::min_element(costs, costs + search.count) - costs);
  const int part_limit = partLimit(costs[likely]);
  // Windows with a higher cost are neither the best match nor its rival.
  const auto limitOf = [&](int best) {
    return cvCeil(std::min<double>(best, search.most) / search.uniqueness);
  };
  int least = SadSearch::kHigh;
  int limit = limitOf(differences.ofWhole(likely, least));
  for (int k = 0; k < search.count; ++k) {
    const bool compare = costs[k] <= part_limit;
    costs[k] =
        static_cast<std::int16_t>(compare ? differences.ofWhole(k, limit) : SadSearch::kHigh);
    if (costs[k] >= least) continue;
    least = costs[k];
    limit = std::min(limit, limitOf(least));
  }
}

int sadCost(const SadSearch& search, int k) {
  return WindowDifferences(search).ofWhole(k, SadSearch::kHigh);
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
