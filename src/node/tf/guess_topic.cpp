#include "node/tf/guess_topic.h"

#include <utility>

#include <geometry_msgs/TransformStamped.h>
#include <ros/transport_hints.h>

#include "input/message_conversion.h"

namespace rotrocc {
namespace {

constexpr int kQueueSize = 100;  // as TfReceiver

}  // namespace

GuessTopic::GuessTopic(const ros::NodeHandle& nh,
                       const NodeParameters& parameters,
                       TfReceiver& tf,
                       Log log)
    : log_(std::move(log)),
      topic_(parameters.guess_topic),
      base_frame_(parameters.base_frame),
      tf_(tf) {
  subscriber_ = callbacks_.attach(nh).subscribe<nav_msgs::Odometry>(
      topic_,
      kQueueSize,
      [this](const nav_msgs::Odometry::ConstPtr& message) { receive(*message); },
      ros::VoidConstPtr(),
      ros::TransportHints().tcpNoDelay());
  callbacks_.start();
}

void GuessTopic::receive(const nav_msgs::Odometry& message) {
  const std::string body = withoutSlash(message.child_frame_id);
  if (!body.empty() && body != base_frame_) {
    if (!std::exchange(logged_, true)) {
      log_.warn("guess_topic " + topic_ + " has the motion of " + body + ", not of base_frame " +
                base_frame_ + ", and is not used: set base_frame to " + body);
    }
    return;
  }
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = message.header.stamp;
  transform.header.frame_id = kGuessFrame;
  transform.child_frame_id = kBaseFrame;
  const geometry_msgs::Pose& pose = message.pose.pose;
  transform.transform.translation.x = pose.position.x;
  transform.transform.translation.y = pose.position.y;
  transform.transform.translation.z = pose.position.z;
  transform.transform.rotation = pose.orientation;
  tf_.add(transform, false);
}

}  // namespace rotrocc
