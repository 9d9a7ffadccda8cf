#include "node/health/exposure_watch.h"

#include <algorithm>

#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Ratio of contrasts that causes a hint: one stop. On real clips, right images with half of their
/// contrast cost nothing.
constexpr double kApart = 2.0;
/// Of the pairs, dropped at either end: single pairs may be wrong.
constexpr double kDropped = 0.1;

constexpr const char* kRemedy = ": couple the exposures of the cameras";

}  // namespace

std::string ExposureWatch::observe(const OdometryResult& result) {
  if (result.hasMotion()) gains_.add(result.exposure_gain);
  if (gains_.size() < kLeastPairs) return "";
  const double least = gains_.quantile(kDropped);
  const double most = gains_.quantile(1.0 - kDropped);
  if (most > kApart * least) {
    return "the right camera's contrast moves between " + hundredths(least) + " and " +
           hundredths(most) + " times the left one's" + kRemedy;
  }
  const double typical = gains_.quantile(0.5);
  if (std::max(typical, 1.0 / typical) <= kApart) return "";
  return "the right camera's contrast is " + hundredths(typical) + " times the left one's" +
         kRemedy;
}

}  // namespace rotrocc
