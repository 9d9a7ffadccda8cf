#include "support/kitti2bag_writer.h"

#include <cv_bridge/cv_bridge.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_msgs/TFMessage.h>
#include <opencv2/imgproc.hpp>

#include "input/message_conversion.h"
#include "sequences/kitti_mount.h"

namespace rotrocc {
namespace {

constexpr std::int64_t kStart_ns = 1317042145000000000;  // 2011-09-26

/// Which of a pair's images a camera took.
struct Camera {
  bool right;
  bool color;
};

ros::Time stampOf(const StereoSequence& sequence, int index, double delay_ms = 0.0) {
  const auto delay_ns = static_cast<std::int64_t>(1e6 * delay_ms);
  return toRosTime(kStart_ns + sequence.stamp_ns(index) + delay_ns);
}

/// How much later than the left image the right one is: anything from 0 to 7 ms.
double skew_ms(int index) {
  return 0.1 * (37 * index % 71);
}

void writeTransform(rosbag::Bag& bag,
                    const std::string& topic,
                    const ros::Time& stamp,
                    const std::string& parent,
                    const std::string& child,
                    const Eigen::Isometry3d& T_parent_child) {
  tf2_msgs::TFMessage message;
  message.transforms.push_back(tf2::eigenToTransform(T_parent_child));
  message.transforms.front().header.stamp = stamp;
  message.transforms.front().header.frame_id = parent;
  message.transforms.front().child_frame_id = child;
  bag.write(topic, stamp, message);
}

sensor_msgs::CameraInfo projectionOnly(const StereoSequence& sequence, bool right) {
  const StereoCamera& camera = sequence.calibration.rectified;
  const double cx = right ? camera.cx_right : camera.cx;
  const double tx = right ? -camera.fx * camera.baseline_m : 0.0;
  sensor_msgs::CameraInfo info;
  info.width = camera.width;
  info.height = camera.height;
  info.P = {camera.fx, 0, cx, tx, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0};
  return info;
}

/// K, D and R are rounded from calib_cam_to_cam.txt of the drives of 2011-09-26.
sensor_msgs::CameraInfo withUnrectifiedCalibration(sensor_msgs::CameraInfo info) {
  info.distortion_model = "plumb_bob";
  info.D = {-0.373, 0.205, 0.00133, 0.000512, -0.0751};
  info.K = {984.2, 0, 690, 0, 980.8, 233.2, 0, 0, 1};
  info.R = {0.99994, 0.0098, -0.0074, -0.0099, 0.99994, -0.0043, 0.0074, 0.0044, 0.99996};
  return info;
}

/// Writes the images and infos of a camera; those of raw drives have the calibration and the delays
/// of unsynchronized cameras.
void writeCamera(const StereoSequence& sequence,
                 const Camera& camera,
                 const std::string& image_topic,
                 bool raw,
                 rosbag::Bag& bag) {
  const std::string name = std::string(camera.color ? "camera_color" : "camera_gray") +
                           (camera.right ? "_right" : "_left");
  sensor_msgs::CameraInfo info = projectionOnly(sequence, camera.right);
  if (raw) info = withUnrectifiedCalibration(info);
  info.header.frame_id = name;
  for (int index = 0; index < sequence.size(); ++index) {
    info.header.stamp = stampOf(sequence, index, raw && camera.right ? skew_ms(index) : 0.0);
    cv::Mat pixels = camera.right ? sequence.read(index).right : sequence.read(index).left;
    if (camera.color) cv::cvtColor(pixels, pixels, cv::COLOR_GRAY2BGR);
    bag.write(
        "/kitti/" + name + "/" + image_topic,
        info.header.stamp,
        *cv_bridge::CvImage(info.header, camera.color ? "bgr8" : "mono8", pixels).toImageMsg());
    bag.write("/kitti/" + name + "/camera_info", info.header.stamp, info);
  }
}

Eigen::Isometry3d translation(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

void writeMounts(rosbag::Bag& bag, const ros::Time& stamp) {
  const Eigen::Isometry3d T_base_imu = translation(-2.71 / 2.0 - 0.05, 0.32, 0.93);
  writeTransform(bag, "/tf_static", stamp, "base_link", "imu_link", T_base_imu);
  const Eigen::Isometry3d T_imu_camera = translation(1.08, -0.32, -0.93) * kittiMount();
  writeTransform(bag, "/tf_static", stamp, "imu_link", "camera_gray_left", T_imu_camera);
}

/// A vehicle that does not start at the origin of the world.
Eigen::Isometry3d poseInWorld(const StampedPose& pose) {
  const Eigen::Isometry3d T_world_first =
      translation(100.0, -50.0, 3.0) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ());
  const Eigen::Isometry3d T_base_camera = translation(-0.325, 0.0, 0.0) * kittiMount();
  return T_world_first * T_base_camera * pose.T_world_body * T_base_camera.inverse();
}

}  // namespace

void writeKitti2bagRaw(const StereoSequence& sequence, const std::string& path) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  for (int index = 0; index < sequence.size(); ++index) {
    const ros::Time stamp = stampOf(sequence, index);
    writeMounts(bag, stamp);
    if (sequence.ground_truth.empty()) continue;
    const Eigen::Isometry3d T_world_base = poseInWorld(sequence.ground_truth[index]);
    writeTransform(bag, "/tf", stamp, "world", "base_link", T_world_base);
  }
  for (const bool color : {false, true}) {
    for (const bool right : {false, true}) {
      writeCamera(sequence, {right, color}, "image_raw", true, bag);
    }
  }
}

void writeKitti2bagOdometry(const StereoSequence& sequence, const std::string& path) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  for (std::size_t index = 0; index < sequence.ground_truth.size(); ++index) {
    const ros::Time stamp = stampOf(sequence, static_cast<int>(index));
    const Eigen::Isometry3d& T_world_camera = sequence.ground_truth[index].T_world_body;
    writeTransform(bag, "/tf", stamp, "world", "camera_left", T_world_camera);
  }
  for (const bool right : {false, true}) {
    writeCamera(sequence, {right, false}, "image_rect", false, bag);
  }
}

}  // namespace rotrocc
