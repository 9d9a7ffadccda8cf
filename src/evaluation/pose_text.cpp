#include "evaluation/pose_text.h"

#include <cmath>

#include <opencv2/core.hpp>

namespace rotrocc {
namespace {

constexpr double kMaxRoundingError = 1e-3;  // of four digits

}  // namespace

std::string whyNoRotation(const Eigen::Matrix3d& matrix) {
  const Eigen::Matrix3d deviation = matrix * matrix.transpose() - Eigen::Matrix3d::Identity();
  const double error = deviation.cwiseAbs().maxCoeff();
  if (!(error <= kMaxRoundingError)) return cv::format("off orthonormality by %g", error);
  return matrix.determinant() < 0.0 ? "a reflection" : "";
}

Eigen::Isometry3d quaternionPose(const TextLine& line, bool w_first) {
  const std::size_t x = w_first ? 5 : 4;
  const Eigen::Quaterniond quaternion(
      line.number(w_first ? 4 : 7), line.number(x), line.number(x + 1), line.number(x + 2));
  if (!(std::abs(quaternion.norm() - 1.0) < 10.0 * kMaxRoundingError)) {
    line.fail(cv::format("the quaternion has the length %f instead of 1", quaternion.norm()));
  }
  Eigen::Isometry3d pose(quaternion.normalized());
  pose.translation() = Eigen::Vector3d(line.number(1), line.number(2), line.number(3));
  return pose;
}

void requireLater(const TextLine& line, std::int64_t stamp_ns, std::int64_t previous_ns) {
  if (stamp_ns > previous_ns) return;
  line.fail("the time " + line.words.front() +
            " is not later than the one before it: sort the file by time");
}

}  // namespace rotrocc
