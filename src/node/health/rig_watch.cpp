#include "node/health/rig_watch.h"

#include <cmath>

#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Rigs are rarely better calibrated; the correction is right on average only, and leaves more of a
/// larger bias.
constexpr double kLargeBias_px = 0.5;
/// More than a good rectification leaves, and more than the matching of small windows tolerates.
constexpr double kRowsApart_px = 0.5;
/// Standard deviations of a fault that is beyond doubt.
constexpr double kSigmas = 4.0;

}  // namespace

std::string RigWatch::observe(const OdometryStatus& status) {
  const auto lasts = [&status](bool is_fault, int& pairs) {
    const bool has_motion =
        status.state == OdometryStatus::OK || status.state == OdometryStatus::DEGRADED;
    if (has_motion) pairs = is_fault ? pairs + 1 : 0;
    return pairs >= kPairs;
  };
  std::string what;
  const bool is_biased = std::abs(status.disparity_bias_applied) >= kLargeBias_px &&
                         std::abs(status.disparity_bias) >= kSigmas * status.disparity_bias_sigma;
  if (lasts(is_biased, bias_)) {
    what = "disparities have a bias of " + hundredths(-status.disparity_bias) + " px (+- " +
           hundredths(status.disparity_bias_sigma) + "), which is corrected";
  }
  if (lasts(status.row_difference >= kRowsApart_px, rows_)) {
    what += (what.empty() ? "" : "; ") + std::string("rows of left and right differ by ") +
            hundredths(status.row_difference) + " px, with a median offset of " +
            hundredths(status.row_offset) + " px (+- " + hundredths(status.row_offset_sigma) + ")" +
            (status.row_offset_applied != 0.0f ? ", which is corrected" : "");
  }
  if (!what.empty()) what += ": recalibrate the stereo rig";
  return what;
}

}  // namespace rotrocc
