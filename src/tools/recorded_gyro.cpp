#include "tools/recorded_gyro.h"

#include <cmath>
#include <cstdio>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>

namespace rotrocc {

Eigen::Matrix3d parseRotation(const std::string& quaternion) {
  std::istringstream text(quaternion);
  Eigen::Quaterniond q;
  std::string rest;
  const bool is_complete = (text >> q.x() >> q.y() >> q.z() >> q.w()) && !(text >> rest);
  if (!is_complete || !(std::abs(q.norm() - 1.0) < 0.01)) {
    throw std::invalid_argument("the rotation '" + quaternion +
                                "' is not a quaternion QX QY QZ QW of length 1");
  }
  return q.normalized().toRotationMatrix();
}

RecordedGyro::RecordedGyro(GyroRecording recording)
    : samples_(std::move(recording.samples)), predictor_(recording.R_camera_gyro) {}

std::optional<Eigen::Matrix3d> RecordedGyro::rotation(std::int64_t from_ns, std::int64_t to_ns) {
  // Up to the first sample that is not earlier than the image.
  while (next_ < samples_.size() && predictor_.history().newest_ns().value_or(to_ns - 1) < to_ns) {
    predictor_.add(samples_[next_++]);
  }
  const auto R_from_to = predictor_.rotation(from_ns, to_ns);
  if (!R_from_to) why_missed_ = *predictor_.whyNot();
  return R_from_to;
}

void RecordedGyro::printSummary(std::ostream& out) const {
  const GyroPredictor::Counts& counts = predictor_.counts();
  const Eigen::Vector3d& bias = predictor_.bias().bias_rps();
  char line[160];
  std::snprintf(
      line,
      sizeof(line),
      "gyroscope: %llu of %llu rotations predicted, bias %.4f %.4f %.4f (+- %.4f) rad/s\n",
      static_cast<unsigned long long>(counts.predicted),
      static_cast<unsigned long long>(counts.predicted + counts.missed),
      bias.x(),
      bias.y(),
      bias.z(),
      std::sqrt(predictor_.bias().covariance().trace()));
  out << line;
  if (counts.missed > 0) out << "  last one missed: " << why_missed_ << '\n';
  if (counts.refused > 0) out << "  " << counts.refused << " samples refused\n";
}

}  // namespace rotrocc
