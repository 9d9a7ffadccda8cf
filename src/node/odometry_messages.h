#pragma once

#include <string>

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>
#include <opencv2/core.hpp>

#include "input/message_conversion.h"
#include "node/base/base_odometry.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

nav_msgs::Odometry toOdometry(const BaseState& state,
                              const std::string& odom_frame,
                              const std::string& base_frame);

geometry_msgs::TwistWithCovarianceStamped toTwist(const StepVelocity& velocity,
                                                  const std::string& base_frame);

/// T_odom_base from a message. Throws std::invalid_argument with one sentence if its frame is not
/// odom_frame or empty, or it is not a pose with a covariance.
UncertainTransform toPose(const geometry_msgs::PoseWithCovarianceStamped& message,
                          const std::string& odom_frame);

/// The points of the features in `set`, in the frame of the header, which must be the left
/// camera's: x, y, z [m] and the intensity of the image there, all FLOAT32.
sensor_msgs::PointCloud2 toPointCloud(const Correspondences& features,
                                      const FeatureSet& set,
                                      const cv::Mat& left_image,
                                      const std_msgs::Header& header);

}  // namespace rotrocc
