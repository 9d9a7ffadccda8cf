#pragma once

#include <memory>
#include <string>
#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <tf2_eigen/tf2_eigen.h>
#include <Eigen/Geometry>

#include "node/tf/tf_feed.h"

namespace rotrocc {

/// tf without a ROS master: a test sends transforms to those that listen. What is sent to nobody
/// is lost, except the static transforms.
class TfRecording {
 public:
  TfFeed feed() {
    return [this](tf2::BufferCore& buffer) {
      ++listeners_started_;
      buffer_ = &buffer;
      for (const auto& transform : static_) buffer.setTransform(transform, "test", true);
      const auto stop = [this](int* listener) {
        buffer_ = nullptr;
        delete listener;
      };
      return std::shared_ptr<void>(std::shared_ptr<int>(new int, stop));
    };
  }

  void send(const std::string& parent,
            const std::string& child,
            double stamp_s,
            const Eigen::Isometry3d& T_parent_child) {
    if (buffer_) buffer_->setTransform(make(parent, child, stamp_s, T_parent_child), "test");
  }

  void sendStatic(const std::string& parent,
                  const std::string& child,
                  const Eigen::Isometry3d& T_parent_child,
                  double quaternion_length = 1.0) {
    static_.push_back(make(parent, child, 0.0, T_parent_child));
    geometry_msgs::Quaternion& q = static_.back().transform.rotation;
    for (double* value : {&q.w, &q.x, &q.y, &q.z}) *value *= quaternion_length;
    if (buffer_) buffer_->setTransform(static_.back(), "test", true);
  }

  bool hasListener() const { return buffer_ != nullptr; }
  int listenersStarted() const { return listeners_started_; }

 private:
  static geometry_msgs::TransformStamped make(const std::string& parent,
                                              const std::string& child,
                                              double stamp_s,
                                              const Eigen::Isometry3d& T_parent_child) {
    geometry_msgs::TransformStamped transform = tf2::eigenToTransform(T_parent_child);
    transform.header.stamp = ros::Time(stamp_s);
    transform.header.frame_id = parent;
    transform.child_frame_id = child;
    return transform;
  }

  tf2::BufferCore* buffer_ = nullptr;
  std::vector<geometry_msgs::TransformStamped> static_;
  int listeners_started_ = 0;
};

}  // namespace rotrocc
