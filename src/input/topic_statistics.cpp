#include "input/topic_statistics.h"

#include <algorithm>

namespace rotrocc {
namespace {

constexpr std::size_t kMaxArrivals = 2000;  // bounds the memory

}  // namespace

void TopicStatistics::add(Time now) {
  if (total_ == 0 || now - arrivals_.back() > kLongestStep) start_of_run_ = now;
  ++total_;
  arrivals_.push_back(now);
  while (arrivals_.size() > kMaxArrivals || arrivals_.front() < now - kWindow) {
    arrivals_.pop_front();
  }
}

std::optional<double> TopicStatistics::silent_s(Time now) const {
  if (total_ == 0) return std::nullopt;
  return std::chrono::duration<double>(now - arrivals_.back()).count();
}

std::size_t TopicStatistics::since(Time begin) const {
  const auto first = std::lower_bound(arrivals_.begin(), arrivals_.end(), begin);
  return static_cast<std::size_t>(arrivals_.end() - first);
}

double TopicStatistics::rate_hz(Time now) const {
  const std::size_t count = recent(now);
  if (count < 2) return 0.0;
  const Time first = arrivals_[arrivals_.size() - count];
  const double length_s = std::chrono::duration<double>(arrivals_.back() - first).count();
  return length_s > 0.0 ? static_cast<double>(count - 1) / length_s : 0.0;
}

}  // namespace rotrocc
