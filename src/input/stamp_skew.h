#pragma once

#include <optional>

#include "input/stamp_series.h"

namespace rotrocc {

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
