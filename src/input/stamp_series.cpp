#include "input/stamp_series.h"

#include <algorithm>
#include <array>

namespace rotrocc {

void StampSeries::add(std::int64_t stamp_ns) {
  stamps_ns_.push_back(stamp_ns);
  if (stamps_ns_.size() > kLength) stamps_ns_.pop_front();
  std::array<std::int64_t, kLength> steps_ns;
  std::size_t count = 0;
  for (std::size_t i = 1; i < stamps_ns_.size(); ++i) {
    const std::int64_t step_ns = stamps_ns_[i] - stamps_ns_[i - 1];
    if (step_ns > 0) steps_ns[count++] = step_ns;
  }
  if (count == 0) return;
  const auto quartile = steps_ns.begin() + (count - 1) / 4;
  std::nth_element(steps_ns.begin(), quartile, steps_ns.begin() + count);
  period_ns_ = *quartile;
}

std::optional<std::int64_t> commonPeriod_ns(const StampSeries& left, const StampSeries& right) {
  if (!left.period_ns() || !right.period_ns()) {
    return left.period_ns() ? left.period_ns() : right.period_ns();
  }
  return std::min(*left.period_ns(), *right.period_ns());
}

}  // namespace rotrocc
