#pragma once

#include <string>

#include <geometry_msgs/TransformStamped.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <tf2_msgs/TFMessage.h>

namespace rotrocc {

/// Who else gives a frame a parent: tf allows one. `publisher` is the node a transform comes from,
/// `own_node` ours, which publishes `own_parent` -> `child`. A sentence with both nodes and what to
/// change; empty if the transform is ours or another one.
std::string describeConflict(const geometry_msgs::TransformStamped& transform,
                             const std::string& publisher,
                             const std::string& own_node,
                             const std::string& own_parent,
                             const std::string& child);

/// Watches tf for another parent of the frame that we give one.
class TfConflict {
 public:
  TfConflict(ros::NodeHandle& nh, const std::string& own_parent, const std::string& child);

  /// The last conflict seen, as describeConflict(); empty if there was none. In the thread of the
  /// callbacks.
  const std::string& description() const { return description_; }

 private:
  void onTf(const ros::MessageEvent<tf2_msgs::TFMessage const>& event);

  std::string own_parent_;
  std::string child_;
  std::string description_;
  ros::Subscriber tf_subscriber_;
  ros::Subscriber static_tf_subscriber_;
};

}  // namespace rotrocc
