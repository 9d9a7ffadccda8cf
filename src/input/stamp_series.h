#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace rotrocc {

/// The latest stamps of the images of one camera, and their period.
class StampSeries {
 public:
  /// Number of stamps that are kept.
  static constexpr std::size_t kLength = 32;

  void add(std::int64_t stamp_ns);

  const std::deque<std::int64_t>& stamps_ns() const { return stamps_ns_; }

  /// The lower quartile of the steps forward: less than a quarter of them must be shorter than the
  /// period, but most images may be lost. None before there is a step.
  std::optional<std::int64_t> period_ns() const { return period_ns_; }

 private:
  std::deque<std::int64_t> stamps_ns_;
  std::optional<std::int64_t> period_ns_;
};

/// The shorter period of two cameras, as far as it is known.
std::optional<std::int64_t> commonPeriod_ns(const StampSeries& left, const StampSeries& right);

}  // namespace rotrocc
