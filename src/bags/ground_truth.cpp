#include "bags/ground_truth.h"

#include <tf2_eigen/tf2_eigen.h>

#include "input/message_conversion.h"

namespace rotrocc {

nav_msgs::Path groundTruthPath(const Trajectory& recorded,
                               const Eigen::Isometry3d& T_base_body,
                               const std::string& odom_frame) {
  nav_msgs::Path path;
  path.header.frame_id = odom_frame;
  if (recorded.empty()) return path;

  const Eigen::Isometry3d T_first_world = recorded.front().T_world_body.inverse();
  for (const StampedPose& pose : recorded) {
    const Eigen::Isometry3d T_first_body = T_first_world * pose.T_world_body;
    geometry_msgs::PoseStamped message;
    message.header.frame_id = odom_frame;
    message.header.stamp = toRosTime(pose.stamp_ns);
    message.pose = tf2::toMsg(T_base_body * T_first_body * T_base_body.inverse());
    path.poses.push_back(message);
  }
  path.header.stamp = path.poses.front().header.stamp;
  return path;
}

void writeGroundTruth(const std::string& file,
                      const nav_msgs::Path& path_of_base,
                      const Eigen::Isometry3d& T_base_camera) {
  TrajectoryWriter writer(file, TrajectoryFormat::kTum);
  for (const geometry_msgs::PoseStamped& pose : path_of_base.poses) {
    Eigen::Isometry3d T_first_base;
    tf2::fromMsg(pose.pose, T_first_base);
    writer.write(
        {toNanoseconds(pose.header.stamp), T_base_camera.inverse() * T_first_base * T_base_camera});
  }
}

}  // namespace rotrocc
