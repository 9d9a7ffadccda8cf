#pragma once

#include <string>

#include <geometry_msgs/TransformStamped.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <tf2_msgs/TFMessage.h>

namespace rotrocc {

/// Describes another publisher of a frame's parent; tf allows only one. `publisher` is the node of
/// a transform, `own_node` this node, which publishes `own_parent` -> `child`. Returns one sentence
/// with both nodes and a remedy; empty if the transform is this node's or of another child.
std::string describeConflict(const geometry_msgs::TransformStamped& transform,
                             const std::string& publisher,
                             const std::string& own_node,
                             const std::string& own_parent,
                             const std::string& child);

/// Watches tf for another parent of the frame that this node publishes.
class TfConflict {
 public:
  TfConflict(ros::NodeHandle& nh, const std::string& own_parent, const std::string& child);

  /// The last conflict, as from describeConflict(); empty if none. Call in the thread of the
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
