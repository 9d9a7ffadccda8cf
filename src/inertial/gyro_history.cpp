#include "inertial/gyro_history.h"

#include <algorithm>
#include <iterator>

#include <opencv2/core.hpp>

#include "common/compared_text.h"
#include "common/to_seconds.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

Eigen::Vector3d rateAt(const GyroSample& before, const GyroSample& after, std::int64_t stamp_ns) {
  const double t =
      toSeconds(stamp_ns - before.stamp_ns) / toSeconds(after.stamp_ns - before.stamp_ns);
  return (1.0 - t) * before.rate_rps + t * after.rate_rps;
}

void append(const Eigen::Vector3d& angle_rad, double dt_s, GyroRotation& rotation) {
  const Eigen::Matrix3d R = expRotation(angle_rad);
  rotation.R_from_to = rotation.R_from_to * R;
  rotation.by_bias_s = R.transpose() * rotation.by_bias_s + dt_s * leftJacobian(-angle_rad);
  rotation.turned_rad += angle_rad.norm();
}

}  // namespace

std::optional<std::string> GyroHistory::add(const GyroSample& sample) {
  if (!sample.rate_rps.allFinite()) return "the angular velocity is not a number";
  if (!samples_.empty() && sample.stamp_ns <= samples_.back().stamp_ns) {
    const double back_s = toSeconds(samples_.back().stamp_ns - sample.stamp_ns);
    if (back_s <= kJump_s) {
      return cv::format("the timestamp is %.3g s before that of the previous sample", back_s);
    }
    samples_.clear();
  }
  samples_.push_back(sample);
  while (toSeconds(sample.stamp_ns - samples_.front().stamp_ns) > kLength_s) {
    samples_.pop_front();
  }
  return std::nullopt;
}

std::optional<std::int64_t> GyroHistory::newest_ns() const {
  if (samples_.empty()) return std::nullopt;
  return samples_.back().stamp_ns;
}

/// The last sample that is not later than `stamp_ns`; the end if there is none.
GyroHistory::Samples::const_iterator GyroHistory::lastUpTo(std::int64_t stamp_ns) const {
  const auto after = std::upper_bound(
      samples_.begin(), samples_.end(), stamp_ns, [](std::int64_t stamp, const GyroSample& sample) {
        return stamp < sample.stamp_ns;
      });
  return after == samples_.begin() ? samples_.end() : std::prev(after);
}

std::optional<std::string> GyroHistory::whyUnknown(std::int64_t from_ns, std::int64_t to_ns) const {
  if (samples_.empty()) return "there is no sample";
  const double late_s = toSeconds(to_ns - samples_.back().stamp_ns);
  if (late_s > 0.0) {
    return cv::format(
        "the newest sample is %.3g s older than the image: it is late, has stopped or has another "
        "clock",
        late_s);
  }
  auto sample = lastUpTo(from_ns);
  if (sample == samples_.end()) {
    return cv::format("the oldest sample is %.3g s newer than the image before",
                      toSeconds(samples_.front().stamp_ns - from_ns));
  }
  for (; sample->stamp_ns < to_ns; ++sample) {
    const double gap_s = toSeconds(std::next(sample)->stamp_ns - sample->stamp_ns);
    if (gap_s <= kMaxGap_s) continue;
    return "two samples are " + comparedText(gap_s, kMaxGap_s) +
           cv::format(" s apart, more than %g s", kMaxGap_s);
  }
  return std::nullopt;
}

GyroRotation GyroHistory::rotation(std::int64_t from_ns,
                                   std::int64_t to_ns,
                                   const Eigen::Vector3d& bias_rps) const {
  GyroRotation rotation;
  for (auto before = lastUpTo(from_ns); before->stamp_ns < to_ns; ++before) {
    const GyroSample& after = *std::next(before);
    const std::int64_t begin_ns = std::max(from_ns, before->stamp_ns);
    const std::int64_t end_ns = std::min(to_ns, after.stamp_ns);
    const double dt_s = toSeconds(end_ns - begin_ns);
    const Eigen::Vector3d mean_rps =
        0.5 * (rateAt(*before, after, begin_ns) + rateAt(*before, after, end_ns));
    append(dt_s * (mean_rps - bias_rps), dt_s, rotation);
  }
  return rotation;
}

}  // namespace rotrocc
