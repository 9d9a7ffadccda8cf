#include <algorithm>

#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>

#include "kernels/sad_kernels.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {
namespace {

/// A row of a window, with the pixels beyond it masked out.
using Bytes = cv::v_uint8x16;
constexpr int kWindow = SadSearch::kWindow;

Bytes loadRow(const std::uint8_t* pixels) {
  alignas(16) static constexpr std::uint8_t kMask[16] = {
      255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255};
  return cv::v_load(pixels) & cv::v_load_aligned(kMask);
}

/// Loads rows k and k + 1 of the part that is compared first.
Bytes loadPair(const std::uint8_t* pixels, std::ptrdiff_t step, int k) {
  return cv::v_load_halves(pixels + kPartRows[k] * step + kPartEdge,
                           pixels + kPartRows[k + 1] * step + kPartEdge);
}

/// Sums of differences to one left window.
class Differences {
 public:
  explicit Differences(const SadSearch& search) : search_(search) {
    for (int i = 0; i < kWindow; ++i) rows_[i] = loadRow(search.left + i * search.left_step);
    for (int i = 0; i < 2; ++i) pairs_[i] = loadPair(search.left, search.left_step, 2 * i);
  }

  int ofPart(int k) const {
    unsigned sum = 0;
    for (int i = 0; i < 2; ++i) {
      sum += cv::v_reduce_sad(pairs_[i], loadPair(search_.right + k, search_.right_step, 2 * i));
    }
    return static_cast<int>(sum);
  }

  /// Returns kHigh if the sum over the first half of the rows already exceeds `limit`.
  int ofWhole(int k, int limit) const {
    const std::uint8_t* pixels = search_.right + k;
    unsigned sum = 0;
    for (int i = 0; i < kWindow; ++i, pixels += search_.right_step) {
      sum += cv::v_reduce_sad(rows_[i], loadRow(pixels));
      if (i == kWindow / 2 && sum > static_cast<unsigned>(limit)) return SadSearch::kHigh;
    }
    return static_cast<int>(sum);
  }

 private:
  const SadSearch& search_;
  Bytes rows_[kWindow];
  Bytes pairs_[2];
};

}  // namespace

void sadCosts(const SadSearch& search, std::int16_t* costs) {
  const Differences differences(search);
  int likely = 0;
  for (int k = 0; k < search.count; ++k) {
    costs[k] = static_cast<std::int16_t>(differences.ofPart(k));
    if (costs[k] < costs[likely]) likely = k;
  }
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
  return Differences(search).ofWhole(k, SadSearch::kHigh);
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
