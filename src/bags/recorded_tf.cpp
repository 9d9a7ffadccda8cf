#include "bags/recorded_tf.h"

#include <algorithm>

#include <rosbag/view.h>
#include <tf2/buffer_core.h>
#include <tf2_eigen/tf2_eigen.h>

#include "bags/bag_reading.h"
#include "bags/ground_truth.h"
#include "input/message_conversion.h"

namespace rotrocc {
namespace {

/// Frame of kitti2bag's ground truth of odometry sequences; its images have another one.
const char* const kKitti2bagCamera = "camera_left";

std::vector<geometry_msgs::TransformStamped> readTransforms(const rosbag::Bag& bag,
                                                            const std::string& topic) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{topic, "/" + topic}));
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = readMessage<tf2_msgs::TFMessage>(instance);
    transforms.insert(transforms.end(), message->transforms.begin(), message->transforms.end());
  }
  for (geometry_msgs::TransformStamped& transform : transforms) {
    transform.header.frame_id = withoutSlash(transform.header.frame_id);
    transform.child_frame_id = withoutSlash(transform.child_frame_id);
  }
  return transforms;
}

std::string nameOf(const geometry_msgs::TransformStamped& transform) {
  return transform.header.frame_id + " -> " + transform.child_frame_id;
}

}  // namespace

RecordedTf::RecordedTf(const rosbag::Bag& bag,
                       const std::string& base_frame,
                       const std::string& camera_frame)
    : base_frame_(withoutSlash(base_frame)), camera_frame_(withoutSlash(camera_frame)) {
  const Transforms fixed = readTransforms(bag, "tf_static");
  const Transforms moving = readTransforms(bag, "tf");
  added_kitti_mount_ = !findMount(fixed, moving);
  for (const auto& transform : fixed) addStatic(transform);
  if (added_kitti_mount_) addKittiMount();
  buildTrajectory(moving);
}

bool RecordedTf::isTrajectory(const geometry_msgs::TransformStamped& transform) const {
  const std::string child = withoutSlash(transform.child_frame_id);
  if (child == base_frame_) return true;
  return added_kitti_mount_ && (child == camera_frame_ || child == kKitti2bagCamera);
}

bool RecordedTf::findMount(const Transforms& fixed, const Transforms& moving) {
  tf2::BufferCore buffer;
  for (const Transforms* transforms : {&fixed, &moving}) {
    for (const auto& transform : *transforms) {
      const bool is_mount = transform.child_frame_id != base_frame_;
      if (is_mount) buffer.setTransform(transform, "bag", true);
    }
  }
  if (!buffer.canTransform(base_frame_, camera_frame_, ros::Time())) return false;
  T_base_camera_ =
      tf2::transformToEigen(buffer.lookupTransform(base_frame_, camera_frame_, ros::Time()));
  return true;
}

void RecordedTf::addStatic(const geometry_msgs::TransformStamped& transform) {
  if (isTrajectory(transform)) return;
  auto& transforms = static_transforms_.transforms;
  const auto known = std::find_if(transforms.begin(), transforms.end(), [&](const auto& other) {
    return other.child_frame_id == transform.child_frame_id;
  });
  if (known == transforms.end()) {
    transforms.push_back(transform);
  } else {
    *known = transform;
  }
}

void RecordedTf::addKittiMount() {
  geometry_msgs::TransformStamped mount = tf2::eigenToTransform(T_base_camera_);
  mount.header.frame_id = base_frame_;
  mount.child_frame_id = camera_frame_;
  static_transforms_.transforms.push_back(mount);
}

tf2_msgs::TFMessage RecordedTf::transformsToPlay(const tf2_msgs::TFMessage& message) const {
  tf2_msgs::TFMessage kept;
  for (const auto& transform : message.transforms) {
    if (!isTrajectory(transform)) kept.transforms.push_back(transform);
  }
  return kept;
}

void RecordedTf::buildTrajectory(const Transforms& moving) {
  Trajectory recorded;
  bool of_base = false;
  for (const auto& transform : moving) {
    if (!isTrajectory(transform)) continue;
    if (recorded.empty()) {
      trajectory_name_ = nameOf(transform);
      of_base = transform.child_frame_id == base_frame_;
    }
    if (nameOf(transform) != trajectory_name_) continue;
    recorded.push_back({toNanoseconds(transform.header.stamp), tf2::transformToEigen(transform)});
  }
  const Eigen::Isometry3d T_base_body =
      of_base ? Eigen::Isometry3d(Eigen::Isometry3d::Identity()) : T_base_camera_;
  trajectory_ = groundTruthPath(recorded, T_base_body, "odom");
}

}  // namespace rotrocc
