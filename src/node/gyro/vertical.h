#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "inertial/gyro_history.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {

/// The vertical from the accelerations of an IMU at rest, in its own axes.
class Vertical {
 public:
  static constexpr double kLength_s = 1.0;  ///< of the samples that it is the mean of
  /// Scatters, as root mean squares, up to which the robot counts as at rest: engines may run.
  static constexpr double kMaxRate_rps = 0.05;
  static constexpr double kMaxAcceleration_mps2 = 0.5;

  /// Samples that are no numbers are ignored; one that is not later than the previous one begins
  /// again.
  void add(const GyroSample& gyro, const Eigen::Vector3d& acceleration_mps2);

  /// Whether there are samples of that length.
  bool isComplete() const;

  /// Why it is not known at that time, in one sentence; none if it is.
  std::optional<std::string> whyUnknown(std::int64_t stamp_ns) const;

  /// The unit vector up, which must be known.
  Eigen::Vector3d up() const;

 private:
  struct Sample {
    std::int64_t stamp_ns;
    Vector6d measured;  ///< angular velocity [rad/s] and acceleration [m/s^2]
  };
  Eigen::Matrix<double, 6, Eigen::Dynamic> columns() const;

  std::deque<Sample> samples_;
};

}  // namespace rotrocc
