#pragma once

#include <optional>
#include <string>

namespace rotrocc {

/// Whether the rotations of a gyroscope agree with those of the images.
class GyroTrust {
 public:
  /// Angles of one motion [rad].
  struct Comparison {
    double difference_rad;   ///< between the two rotations
    double uncertainty_rad;  ///< standard deviation of this difference
    double gyro_rad;         ///< all angles of the gyroscope added up
    double vision_rad;
  };

  /// Whether the two rotations agree, up to what is usual.
  bool compare(const Comparison& comparison);

  /// Why the gyroscope is not to be used, in one sentence with a remedy; none if it is.
  const std::optional<std::string>& whyNot() const { return why_not_; }

 private:
  void refuse();

  int disagreeing_ = 0;  // in a row
  int agreeing_ = 0;     // in a row, since it was refused
  double gyro_rad_ = 0.0, vision_rad_ = 0.0, difference_rad_ = 0.0;  // of the disagreeing ones
  std::optional<std::string> why_not_;
};

}  // namespace rotrocc
