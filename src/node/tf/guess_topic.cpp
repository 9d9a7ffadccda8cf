#include "node/tf/guess_topic.h"

#include <stdexcept>

#include <geometry_msgs/TransformStamped.h>
#include <ros/transport_hints.h>

#include "input/message_conversion.h"

namespace rotrocc {
namespace {

constexpr int kQueueSize = 100;  // as TfReceiver

}  // namespace

GuessTopic::GuessTopic(const ros::NodeHandle& nh, const NodeParameters& parameters, TfReceiver& tf)
    : base_frame_(parameters.base_frame), tf_(tf) {
  const std::string& topic = parameters.guess_topic;
  if (nh.resolveName(topic) == nh.resolveName("odom")) {
    throw std::invalid_argument("parameter guess_topic is " + topic +
                                ", the output of this odometry: name the topic of another one");
  }
  subscriber_ = callbacks_.attach(nh).subscribe<nav_msgs::Odometry>(
      topic,
      kQueueSize,
      [this](const nav_msgs::Odometry::ConstPtr& message) { receive(*message); },
      ros::VoidConstPtr(),
      ros::TransportHints().tcpNoDelay());
  callbacks_.start();
}

std::string GuessTopic::whyNot() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return why_not_;
}

void GuessTopic::receive(const nav_msgs::Odometry& message) {
  const std::string body = withoutSlash(message.child_frame_id);
  std::string why_not;
  if (!body.empty() && body != base_frame_) {
    why_not = "it has the motion of " + body + ", not of base_frame " + base_frame_ +
              ": set base_frame to " + body + ", or guess_frame if that odometry sends tf";
  } else if (!add(message)) {
    why_not = "its last pose is invalid: correct that odometry";
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  why_not_ = why_not;
}

bool GuessTopic::add(const nav_msgs::Odometry& message) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = message.header.stamp;
  transform.header.frame_id = kGuessFrame;
  transform.child_frame_id = kBaseFrame;
  const geometry_msgs::Pose& pose = message.pose.pose;
  transform.transform.translation.x = pose.position.x;
  transform.transform.translation.y = pose.position.y;
  transform.transform.translation.z = pose.position.z;
  transform.transform.rotation = pose.orientation;
  return tf_.add(transform, false);
}

}  // namespace rotrocc
