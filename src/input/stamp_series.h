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

/// Largest difference between a left stamp and the nearest right one [s], without those whose
/// partner is lost: they have none within half a period. None if a side has no stamps.
std::optional<double> greatestStampDifference(const StampSeries& left, const StampSeries& right);

/// Median of the right stamps minus the nearest left ones [s], without lost partners; none if there
/// are few.
std::optional<double> medianSkew(const StampSeries& left, const StampSeries& right);

/// A skew of about a period [s], as of a camera whose stamps are late: right minus left stamps of
/// the same time. Then the nearest stamps are those of neighbours. It is identified by the jitter,
/// which images of the same time have in common; none if there is no such skew or no jitter.
std::optional<double> skewOfAPeriod(const StampSeries& left, const StampSeries& right);

}  // namespace rotrocc
