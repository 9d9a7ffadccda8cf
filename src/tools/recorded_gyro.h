#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "inertial/gyro_predictor.h"
#include "sequences/stereo_sequence.h"

namespace rotrocc {

/// The rotation of a quaternion "QX QY QZ QW". Throws std::invalid_argument if it is none.
Eigen::Matrix3d parseRotation(const std::string& quaternion);

/// Predicts rotations from a recording, as GyroPredictor does while the samples arrive.
class RecordedGyro {
 public:
  explicit RecordedGyro(GyroRecording recording);

  std::optional<Eigen::Matrix3d> rotation(std::int64_t from_ns, std::int64_t to_ns);
  void observe(const OdometryResult& result) { predictor_.observe(result); }

  /// How many rotations were predicted, and the bias.
  void printSummary(std::ostream& out) const;

 private:
  std::vector<GyroSample> samples_;
  std::size_t next_ = 0;
  GyroPredictor predictor_;
  std::string why_missed_;  // the last one that was
};

}  // namespace rotrocc
