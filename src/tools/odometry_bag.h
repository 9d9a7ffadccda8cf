#pragma once

#include <cstdint>
#include <string>

#include <rosbag/bag.h>
#include <Eigen/Geometry>

#include "node/base/base_odometry.h"
#include "rotrocc/parameters.h"

namespace rotrocc {

/// Bag with the messages that the node would publish for each pair, by stamp:
///   /stereo/odom    nav_msgs/Odometry
///   /tf             odom_frame -> base_frame
class OdometryBag {
 public:
  /// `start_ns` is added to all stamps: KITTI sequences start at 0, which ROS does not accept.
  /// Throws std::runtime_error if `path` cannot be written.
  OdometryBag(const std::string& path,
              const Eigen::Isometry3d& T_base_camera,
              const Parameters& parameters,
              std::int64_t start_ns);

  void write(const OdometryResult& result);

 private:
  NodeParameters parameters_;
  std::int64_t start_ns_;
  Eigen::Isometry3d T_base_camera_;
  BaseOdometry odometry_;
  rosbag::Bag bag_;
};

}  // namespace rotrocc
