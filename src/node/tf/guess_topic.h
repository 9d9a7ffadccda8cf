#pragma once

#include <mutex>
#include <string>

#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include "input/callback_thread.h"
#include "node/tf/tf_receiver.h"
#include "rotrocc/parameters.h"

namespace rotrocc {

/// Puts the poses of guess_topic into the received tf, for an odometry that sends no tf itself.
class GuessTopic {
 public:
  /// Frames that only this has: the real ones may have other parents.
  static constexpr char kGuessFrame[] = "guess_topic";
  static constexpr char kBaseFrame[] = "guess_topic_base";

  /// Subscribes. Throws std::invalid_argument if it is the own output.
  GuessTopic(const ros::NodeHandle& nh, const NodeParameters& parameters, TfReceiver& tf);

  /// Why the last message was not used, in one sentence with a remedy; empty if it was.
  std::string whyNot() const;

 private:
  void receive(const nav_msgs::Odometry& message);
  bool add(const nav_msgs::Odometry& message);

  std::string base_frame_;
  TfReceiver& tf_;
  mutable std::mutex mutex_;
  std::string why_not_;  // of the last message
  CallbackThread callbacks_;
  ros::Subscriber subscriber_;  // last, so that callbacks end before
};

}  // namespace rotrocc
