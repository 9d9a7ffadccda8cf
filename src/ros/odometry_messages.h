#pragma once

#include <cstdint>
#include <string>

#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>
#include <opencv2/core.hpp>

#include "base_odometry.h"
#include "rotrocc/OdometryStatus.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// What happened to the input since the start.
struct InputCounters {
  std::uint64_t pairs_processed = 0;
  std::uint64_t pairs_dropped = 0;
  std::uint64_t pairs_lost = 0;
  std::uint64_t images_unmatched = 0;
  std::uint64_t inputs_rejected = 0;
};

nav_msgs::Odometry toOdometry(const BaseState& state,
                              const std::string& odom_frame,
                              const std::string& base_frame);

/// The transform from the frame of an odometry to its child frame.
geometry_msgs::TransformStamped toTransform(const nav_msgs::Odometry& odometry);

/// `latency_ms`: since the arrival of the pair.
OdometryStatus toStatus(const OdometryResult& result,
                        const InputCounters& counters,
                        double latency_ms,
                        const std::string& camera_frame);

/// The points of the features in `set`, in the frame of the header, which must be the left
/// camera's: x, y, z [m] and the intensity of the image there, all FLOAT32.
sensor_msgs::PointCloud2 toPointCloud(const Correspondences& features,
                                      const FeatureSet& set,
                                      const cv::Mat& left_image,
                                      const std_msgs::Header& header);

}  // namespace rotrocc
