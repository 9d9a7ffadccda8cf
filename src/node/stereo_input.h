#pragma once

#include <image_transport/image_transport.h>
#include <image_transport/subscriber.h>
#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "input/clock_watch.h"
#include "input/stereo_intake.h"
#include "rotrocc/parameters.h"

namespace rotrocc {

/// Subscribes to left/image_rect, left/camera_info, right/image_rect and right/camera_info for an
/// intake; with the parameter rectify to left/image_raw and right/image_raw. Its callbacks must not
/// run at the same time: take a handle of one queue and thread.
class StereoInput {
 public:
  StereoInput(ros::NodeHandle& nh,
              const NodeParameters& parameters,
              DropLog& drops,
              StereoIntake::PairHandler on_pair,
              Log log);

  /// Call in the thread of the callbacks.
  InputReport report();

 private:
  void onLeftImage(const sensor_msgs::Image::ConstPtr& image);
  void onRightImage(const sensor_msgs::Image::ConstPtr& image);
  void onLeftInfo(const sensor_msgs::CameraInfo::ConstPtr& info);
  void onRightInfo(const sensor_msgs::CameraInfo::ConstPtr& info);

  StereoIntake intake_;
  ClockWatch clock_;

  // Last, so that callbacks end before the other members are destroyed.
  image_transport::Subscriber left_image_subscriber_;
  image_transport::Subscriber right_image_subscriber_;
  ros::Subscriber left_info_subscriber_;
  ros::Subscriber right_info_subscriber_;
};

}  // namespace rotrocc
