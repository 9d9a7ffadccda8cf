#pragma once

#include <memory>

#include <nodelet/nodelet.h>

#include "node/stereo_odometry.h"

namespace rotrocc {

/// StereoOdometry as a nodelet.
class StereoOdometryNodelet : public nodelet::Nodelet {
 private:
  /// Throws std::exception, after a fatal log, if the odometry cannot start.
  void onInit() override;

  std::unique_ptr<StereoOdometry> odometry_;
};

}  // namespace rotrocc
