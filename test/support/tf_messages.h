#pragma once

#include <string>

#include <geometry_msgs/TransformStamped.h>
#include <tf2/buffer_core.h>
#include <tf2_eigen/tf2_eigen.h>
#include <Eigen/Geometry>

namespace rotrocc {

/// Adds a transform to a buffer; stamp 0 is static.
inline void sendTf(const std::string& parent,
                   const std::string& child,
                   double stamp_s,
                   const Eigen::Isometry3d& T_parent_child,
                   tf2::BufferCore& buffer,
                   double quaternion_length = 1.0) {
  geometry_msgs::TransformStamped transform = tf2::eigenToTransform(T_parent_child);
  transform.header.stamp = ros::Time(stamp_s);
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  geometry_msgs::Quaternion& q = transform.transform.rotation;
  for (double* value : {&q.w, &q.x, &q.y, &q.z}) *value *= quaternion_length;
  buffer.setTransform(transform, "test", stamp_s == 0.0);
}

}  // namespace rotrocc
