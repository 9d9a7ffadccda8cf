#pragma once

#include <utility>
#include <vector>

#include "check/pair_check.h"

namespace rotrocc {

/// Disparities against the motion: their bias, and where in the image they disagree.
class DisparityCheck {
 public:
  void observe(const CheckedPair& pair);

  /// Adds the section disparities, the map of errors and the course of the bias.
  void report(const Windows& windows, RigReport& report) const;

  /// Of the last pair.
  const DisparityBias& bias() const { return bias_; }

  /// The yaw of the right camera [rad] whose shape the errors of disparities have; of infinite
  /// deviation if that is not known.
  Estimate keystone_rad() const;

 private:
  struct Error {
    float x_px, y_px;
    float x_right;        ///< normalized coordinate in the right image
    float correction_px;  ///< makes the disparity agree with the motion
    float sigma_px;
  };

  void measure(const CheckedPair& pair, std::size_t feature);
  std::pair<double, double> motionOfBias() const;
  void addMap(RigReport& report) const;

  StereoCamera camera_;
  DisparityBias bias_;
  std::vector<TimedValue> biases_px_;
  std::vector<double> bias_sigmas_px_;
  std::vector<Error> errors_;
  std::vector<double> disparities_px_;  // above infinity
};

}  // namespace rotrocc
