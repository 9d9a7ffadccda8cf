#include "bags/recorded_tf.h"

#include <map>
#include <optional>
#include <vector>

#include <tf2/buffer_core.h>
#include <tf2_eigen/tf2_eigen.h>

#include "bags/recording.h"
#include "input/message_conversion.h"
#include "sequences/kitti_mount.h"

namespace rotrocc {
namespace {

using Transforms = std::vector<geometry_msgs::TransformStamped>;

/// Frame of kitti2bag's ground truth of odometry sequences; its images have another one.
const char* const kKitti2bagCamera = "camera_left";

Transforms readTransforms(const Bags& bags, const std::string& topic) {
  Transforms transforms;
  for (const rosbag::MessageInstance& instance : BagView(bags, {topic, "/" + topic})) {
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

bool isTrajectory(const geometry_msgs::TransformStamped& transform, const RecordedTf& tf) {
  const std::string child = withoutSlash(transform.child_frame_id);
  if (child == tf.base_frame) return true;
  return tf.assumes_mount && (child == tf.camera_frame || child == kKitti2bagCamera);
}

/// T_base_camera, if transforms connect them.
std::optional<Eigen::Isometry3d> findMount(const RecordedTf& tf,
                                           const Transforms& fixed,
                                           const Transforms& moving) {
  tf2::BufferCore buffer;
  for (const Transforms* transforms : {&fixed, &moving}) {
    for (const auto& transform : *transforms) {
      const bool is_mount = transform.child_frame_id != tf.base_frame;
      if (is_mount) buffer.setTransform(transform, "bag", true);
    }
  }
  if (!buffer.canTransform(tf.base_frame, tf.camera_frame, ros::Time())) return std::nullopt;
  return tf2::transformToEigen(buffer.lookupTransform(tf.base_frame, tf.camera_frame, ros::Time()));
}

bool isOfKitti2bag(const RecordedTf& tf) {
  return tf.camera_frame == "camera_gray_left" || tf.camera_frame == "camera_color_left";
}

void buildTrajectory(const Transforms& moving, RecordedTf& tf) {
  Trajectory recorded;
  bool of_base = false;
  for (const auto& transform : moving) {
    if (!isTrajectory(transform, tf)) continue;
    if (recorded.empty()) {
      tf.trajectory_name = nameOf(transform);
      of_base = transform.child_frame_id == tf.base_frame;
    }
    if (nameOf(transform) != tf.trajectory_name) continue;
    recorded.push_back({toNanoseconds(transform.header.stamp), tf2::transformToEigen(transform)});
  }
  tf.trajectory = pathOfBase(
      recorded, of_base ? Eigen::Isometry3d(Eigen::Isometry3d::Identity()) : tf.T_base_camera);
}

}  // namespace

tf2_msgs::TFMessage RecordedTf::transformsToPlay(const tf2_msgs::TFMessage& message) const {
  tf2_msgs::TFMessage kept;
  for (const auto& transform : message.transforms) {
    if (!isTrajectory(transform, *this)) kept.transforms.push_back(transform);
  }
  return kept;
}

std::string RecordedTf::note() const {
  if (!assumes_mount) return "";
  const std::string place =
      isOfKitti2bag(*this) ? "on the road below it, as for KITTI's car" : "there";
  return "no tf connects " + base_frame + " and the left camera, " + camera_frame + ": " +
         base_frame + " is taken to be " + place + ", with x forward and z up";
}

RecordedTf readTf(const Bags& bags,
                  const std::string& base_frame,
                  const std::string& camera_frame) {
  RecordedTf tf;
  tf.base_frame = withoutSlash(base_frame);
  tf.camera_frame = withoutSlash(camera_frame);
  const Transforms fixed = readTransforms(bags, "tf_static");
  const Transforms moving = readTransforms(bags, "tf");
  const auto T_base_camera = findMount(tf, fixed, moving);
  tf.assumes_mount = !T_base_camera;
  tf.T_base_camera = T_base_camera       ? *T_base_camera
                     : isOfKitti2bag(tf) ? kittiMount()
                                         : mountAtCamera();
  std::map<std::string, geometry_msgs::TransformStamped> latest;
  for (const auto& transform : fixed) {
    if (!isTrajectory(transform, tf)) latest[transform.child_frame_id] = transform;
  }
  for (const auto& [child, transform] : latest)
    tf.static_transforms.transforms.push_back(transform);
  if (tf.assumes_mount) {
    tf.static_transforms.transforms.push_back(
        toTransform(tf.T_base_camera, 0, tf.base_frame, tf.camera_frame));
  }
  buildTrajectory(moving, tf);
  return tf;
}

}  // namespace rotrocc
