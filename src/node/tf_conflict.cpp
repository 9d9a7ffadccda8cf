#include "node/tf_conflict.h"

#include <ros/console.h>
#include <ros/this_node.h>

namespace rotrocc {
namespace {

constexpr std::uint32_t kQueueSize = 100;

std::string withoutSlash(const std::string& frame) {
  return frame.compare(0, 1, "/") == 0 ? frame.substr(1) : frame;
}

}  // namespace

std::string describeConflict(const geometry_msgs::TransformStamped& transform,
                             const std::string& publisher,
                             const std::string& own_node,
                             const std::string& own_parent,
                             const std::string& child) {
  if (withoutSlash(transform.child_frame_id) != child) return "";
  const std::string parent = withoutSlash(transform.header.frame_id);
  if (publisher == own_node && parent == own_parent) return "";
  return "node " + publisher + " publishes tf " + parent + " -> " + child +
         ", and this node publishes " + own_parent + " -> " + child +
         ", but a frame has only one parent: set publish_tf to false if that node is a filter that "
         "uses this odometry, set guess_frame to " +
         parent + " if it is another odometry, or stop it";
}

TfConflict::TfConflict(ros::NodeHandle& nh, const std::string& own_parent, const std::string& child)
    : own_parent_(own_parent), child_(child) {
  tf_subscriber_ = nh.subscribe("/tf", kQueueSize, &TfConflict::onTf, this);
  static_tf_subscriber_ = nh.subscribe("/tf_static", kQueueSize, &TfConflict::onTf, this);
}

void TfConflict::onTf(const ros::MessageEvent<tf2_msgs::TFMessage const>& event) {
  for (const auto& transform : event.getConstMessage()->transforms) {
    const std::string conflict = describeConflict(
        transform, event.getPublisherName(), ros::this_node::getName(), own_parent_, child_);
    if (conflict.empty() || conflict == description_) continue;
    description_ = conflict;
    ROS_WARN_STREAM(conflict);
  }
}

}  // namespace rotrocc
