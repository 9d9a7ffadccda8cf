#pragma once

#include <string>

#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include "input/callback_thread.h"
#include "input/log.h"
#include "node/tf/tf_receiver.h"
#include "rotrocc/parameters.h"

namespace rotrocc {

/// Puts the poses of guess_topic into the received tf, for an odometry that sends no tf itself.
class GuessTopic {
 public:
  /// Frames that only this has: the real ones may have other parents.
  static constexpr char kGuessFrame[] = "guess_topic";
  static constexpr char kBaseFrame[] = "guess_topic_base";

  /// Subscribes.
  GuessTopic(const ros::NodeHandle& nh, const NodeParameters& parameters, TfReceiver& tf, Log log);

 private:
  void receive(const nav_msgs::Odometry& message);

  Log log_;
  std::string topic_, base_frame_;
  TfReceiver& tf_;
  bool logged_ = false;  // that it is of another frame
  CallbackThread callbacks_;
  ros::Subscriber subscriber_;  // last, so that callbacks end before
};

}  // namespace rotrocc
