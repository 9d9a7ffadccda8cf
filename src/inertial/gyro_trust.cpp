#include "inertial/gyro_trust.h"

#include <cmath>

#include <opencv2/core.hpp>

namespace rotrocc {
namespace {

/// Number of motions in a row after which the opinion changes. One may be wrong in the images.
constexpr int kEnough = 5;

/// Largest usual difference: stamps of the sensors that differ by 10 ms at an angular acceleration
/// of 100 deg/s^2, and axes that are known to 5 degrees.
constexpr double kUsual_rad = 0.02;
constexpr double kUsualShare = 0.1;
constexpr double kSigmas = 3.0;

/// A rotation of this angle shows that the gyroscope is right, if it explains most of it.
constexpr double kTelling_rad = 0.01;
constexpr double kExplained = 0.5;

constexpr double kDegreesPerRadian = 180.0 / M_PI;

}  // namespace

bool GyroTrust::compare(const Comparison& c) {
  const double usual_rad = kUsual_rad + kUsualShare * c.vision_rad + kSigmas * c.uncertainty_rad;
  if (c.difference_rad > usual_rad) {
    agreeing_ = 0;
    ++disagreeing_;
    gyro_rad_ += c.gyro_rad;
    vision_rad_ += c.vision_rad;
    difference_rad_ += c.difference_rad;
    if (disagreeing_ >= kEnough) refuse();
    return false;
  }
  disagreeing_ = 0;
  gyro_rad_ = vision_rad_ = difference_rad_ = 0.0;
  if (!why_not_) return true;
  const bool is_telling = c.vision_rad > kTelling_rad;
  if (is_telling && c.difference_rad < kExplained * c.vision_rad) ++agreeing_;
  if (agreeing_ >= kEnough) why_not_.reset();
  return true;
}

void GyroTrust::refuse() {
  if (why_not_) return;
  agreeing_ = 0;
  const double ratio = gyro_rad_ / vision_rad_;
  if (ratio > kDegreesPerRadian / 1.5 && ratio < kDegreesPerRadian * 1.5) {
    why_not_ = cv::format(
        "its rotations are %.3g times those of the images: it seems to be in deg/s, but must "
        "be in rad/s",
        ratio);
    return;
  }
  why_not_ = cv::format(
      "its rotations differ from those of the images by %.2g deg per pair: check the tf "
      "from its frame to the camera's, and its stamps",
      kDegreesPerRadian * difference_rad_ / disagreeing_);
}

}  // namespace rotrocc
