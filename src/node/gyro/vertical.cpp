#include "node/gyro/vertical.h"

#include <cmath>
#include <cstdlib>

#include <opencv2/core.hpp>

#include "common/compared_text.h"
#include "common/to_seconds.h"

namespace rotrocc {
namespace {

constexpr double kGravity_mps2 = 9.81;
/// Part by which the mean acceleration may differ from it: bias and scale of cheap accelerometers.
constexpr double kMaxDifference = 0.1;
/// Part of the length that the samples must span, as the last one is not at its very end.
constexpr double kMinSpan = 0.9;
constexpr std::size_t kMinSamples = 10;

/// The root mean square distance of columns from their mean.
double scatterOf(const Eigen::Ref<const Eigen::Matrix3Xd>& columns) {
  const Eigen::Vector3d mean = columns.rowwise().mean();
  return std::sqrt((columns.colwise() - mean).colwise().squaredNorm().mean());
}

}  // namespace

void Vertical::add(const GyroSample& gyro, const Eigen::Vector3d& acceleration_mps2) {
  Sample sample = {gyro.stamp_ns, {}};
  sample.measured << gyro.rate_rps, acceleration_mps2;
  if (!sample.measured.allFinite()) return;
  if (!samples_.empty() && sample.stamp_ns <= samples_.back().stamp_ns) samples_.clear();
  samples_.push_back(sample);
  while (toSeconds(sample.stamp_ns - samples_.front().stamp_ns) > kLength_s) samples_.pop_front();
}

bool Vertical::isComplete() const {
  return samples_.size() >= kMinSamples &&
         toSeconds(samples_.back().stamp_ns - samples_.front().stamp_ns) >= kMinSpan * kLength_s;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> Vertical::columns() const {
  Eigen::Matrix<double, 6, Eigen::Dynamic> columns(6, samples_.size());
  for (std::size_t i = 0; i < samples_.size(); ++i) columns.col(i) = samples_[i].measured;
  return columns;
}

std::optional<std::string> Vertical::whyUnknown(std::int64_t stamp_ns) const {
  if (!isComplete()) return cv::format("there are no accelerations of %g s", kLength_s);
  const double apart_s = std::abs(toSeconds(stamp_ns - samples_.back().stamp_ns));
  if (apart_s > kLength_s) {
    return cv::format("the newest acceleration and the image are %.3g s apart", apart_s);
  }
  const auto measured = columns();
  const double gravity_mps2 = measured.bottomRows<3>().rowwise().mean().norm();
  if (std::abs(gravity_mps2 - kGravity_mps2) > kMaxDifference * kGravity_mps2) {
    return cv::format(
        "the mean acceleration is %.3g m/s^2, but must be that of gravity, %g: the driver must not "
        "subtract it",
        gravity_mps2,
        kGravity_mps2);
  }
  const double rate_rps = scatterOf(measured.topRows<3>());
  const double scatter_mps2 = scatterOf(measured.bottomRows<3>());
  if (rate_rps <= kMaxRate_rps && scatter_mps2 <= kMaxAcceleration_mps2) return std::nullopt;
  return "the robot is not at rest: angular velocities scatter by " +
         comparedText(rate_rps, kMaxRate_rps) +
         cv::format(" rad/s (at rest up to %g), accelerations by ", kMaxRate_rps) +
         comparedText(scatter_mps2, kMaxAcceleration_mps2) +
         cv::format(" m/s^2 (%g)", kMaxAcceleration_mps2);
}

Eigen::Vector3d Vertical::up() const {
  return columns().bottomRows<3>().rowwise().mean().normalized();
}

}  // namespace rotrocc
