#include "node/tf/tf_receiver.h"

#include <string>
#include <utility>

#include <ros/node_handle.h>
#include <ros/transport_hints.h>

namespace rotrocc {
TfReceiver::TfReceiver(Observer observer)
    : observer_(std::move(observer)),
      subscriber_(subscribe("/tf", false)),
      static_subscriber_(subscribe("/tf_static", true)) {
  callbacks_.start();
}

ros::Subscriber TfReceiver::subscribe(const std::string& topic, bool is_static) {
  // Like the handle of a broadcaster: tf is not remapped for a nodelet.
  ros::NodeHandle nh = callbacks_.attach(ros::NodeHandle());
  return nh.subscribe<tf2_msgs::TFMessage const, const Event&>(
      topic,
      100,  // as tf2_ros::TransformListener
      [this, is_static](const Event& event) {
        for (const auto& transform : event.getConstMessage()->transforms) {
          add(transform, is_static);
        }
        if (observer_) observer_(event, is_static);
      },
      ros::VoidConstPtr(),
      ros::TransportHints().tcpNoDelay());
}

void TfReceiver::follow(std::int64_t stamp_ns) {
  if (stamp_ns < last_stamp_ns_) buffer_.clear();  // static ones stay
  last_stamp_ns_ = stamp_ns;
}

}  // namespace rotrocc
