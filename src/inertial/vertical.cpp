#include "inertial/vertical.h"

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

/// The mean of a vector of all samples.
template <class Samples, class Value>
Eigen::Vector3d meanOf(const Samples& samples, const Value& value) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& sample : samples) sum += value(sample);
  return sum / static_cast<double>(samples.size());
}

/// The root mean square distance from the mean.
template <class Samples, class Value>
double scatterOf(const Samples& samples, const Value& value) {
  const Eigen::Vector3d mean = meanOf(samples, value);
  double sum = 0.0;
  for (const auto& sample : samples) sum += (value(sample) - mean).squaredNorm();
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

const auto kRate = [](const auto& sample) { return sample.gyro.rate_rps; };
const auto kAcceleration = [](const auto& sample) { return sample.acceleration_mps2; };

}  // namespace

void Vertical::add(const GyroSample& gyro, const Eigen::Vector3d& acceleration_mps2) {
  if (!gyro.rate_rps.allFinite() || !acceleration_mps2.allFinite()) return;
  if (!samples_.empty() && gyro.stamp_ns <= samples_.back().gyro.stamp_ns) samples_.clear();
  samples_.push_back({gyro, acceleration_mps2});
  while (toSeconds(gyro.stamp_ns - samples_.front().gyro.stamp_ns) > kLength_s) {
    samples_.pop_front();
  }
}

bool Vertical::isComplete() const {
  return samples_.size() >= kMinSamples &&
         toSeconds(samples_.back().gyro.stamp_ns - samples_.front().gyro.stamp_ns) >=
             kMinSpan * kLength_s;
}

std::optional<std::string> Vertical::whyUnknown(std::int64_t stamp_ns) const {
  if (!isComplete()) return cv::format("there are no accelerations of %g s", kLength_s);
  const double apart_s = std::abs(toSeconds(stamp_ns - samples_.back().gyro.stamp_ns));
  if (apart_s > kLength_s) {
    return cv::format("the newest acceleration and the image are %.3g s apart", apart_s);
  }
  const double gravity_mps2 = meanOf(samples_, kAcceleration).norm();
  if (std::abs(gravity_mps2 - kGravity_mps2) > kMaxDifference * kGravity_mps2) {
    return cv::format(
        "the mean acceleration is %.3g m/s^2, but must be that of gravity, %g: the driver must not "
        "subtract it",
        gravity_mps2,
        kGravity_mps2);
  }
  const double rate_rps = scatterOf(samples_, kRate);
  const double scatter_mps2 = scatterOf(samples_, kAcceleration);
  if (rate_rps <= kMaxRate_rps && scatter_mps2 <= kMaxAcceleration_mps2) return std::nullopt;
  return "the robot is not at rest: angular velocities scatter by " +
         comparedText(rate_rps, kMaxRate_rps) +
         cv::format(" rad/s (at rest up to %g), accelerations by ", kMaxRate_rps) +
         comparedText(scatter_mps2, kMaxAcceleration_mps2) +
         cv::format(" m/s^2 (%g)", kMaxAcceleration_mps2);
}

Eigen::Vector3d Vertical::up() const {
  return meanOf(samples_, kAcceleration).normalized();
}

}  // namespace rotrocc
