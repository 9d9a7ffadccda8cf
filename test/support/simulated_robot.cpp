#include "support/simulated_robot.h"

#include <stdexcept>

#include <cv_bridge/cv_bridge.h>
#include <geometry_msgs/TransformStamped.h>
#include <ros/init.h>
#include <sensor_msgs/image_encodings.h>
#include <boost/make_shared.hpp>

#include "input/camera_calibration.h"
#include "input/message_conversion.h"

namespace rotrocc {
namespace {

using sensor_msgs::image_encodings::MONO8;

const char* const kCameraFrame = "camera_left";
constexpr int kQueueSize = 50;

}  // namespace

SimulatedRobot::SimulatedRobot(std::uint32_t odometries) {
  ros::NodeHandle nh;
  left_image_publisher_ = nh.advertise<sensor_msgs::Image>("left/image_rect", kQueueSize);
  right_image_publisher_ = nh.advertise<sensor_msgs::Image>("right/image_rect", kQueueSize);
  left_info_publisher_ = nh.advertise<sensor_msgs::CameraInfo>("left/camera_info", kQueueSize);
  right_info_publisher_ = nh.advertise<sensor_msgs::CameraInfo>("right/camera_info", kQueueSize);
  odom_subscriber_ = nh.subscribe<nav_msgs::Odometry>(
      "odom", kQueueSize, [this](const nav_msgs::Odometry::ConstPtr& message) {
        keep(*message, odometry_);
      });
  status_subscriber_ = nh.subscribe<OdometryStatus>(
      "status", kQueueSize, [this](const OdometryStatus::ConstPtr& message) {
        keep(*message, status_);
        const std::lock_guard<std::mutex> lock(mutex_);
        last_status_ = *message;
        received_.notify_all();
      });
  const bool connected = waitUntil([&] {
    for (const ros::Publisher* publisher : {&left_image_publisher_,
                                            &right_image_publisher_,
                                            &left_info_publisher_,
                                            &right_info_publisher_}) {
      if (publisher->getNumSubscribers() < odometries) return false;
    }
    return odom_subscriber_.getNumPublishers() > 0 && status_subscriber_.getNumPublishers() > 0;
  });
  if (!connected) throw std::runtime_error("there is no odometry");
}

void SimulatedRobot::publishInfos(const std::function<void(sensor_msgs::CameraInfo&)>& change) {
  auto [left, right] = toCameraInfos(rectifiedCalibration(scene_.camera()));
  left.header.frame_id = right.header.frame_id = kCameraFrame;
  if (change) {
    change(left);
    change(right);
  }
  left_info_publisher_.publish(left);
  right_info_publisher_.publish(right);
}

void SimulatedRobot::publishMount() {
  geometry_msgs::TransformStamped mount;
  mount.header.frame_id = "base_link";
  mount.child_frame_id = kCameraFrame;
  mount.transform.translation.x = 1.0;
  mount.transform.translation.z = 1.2;
  // x right, y down, z forward in axes of the base: forward, left, up.
  mount.transform.rotation.x = -0.5;
  mount.transform.rotation.y = 0.5;
  mount.transform.rotation.z = -0.5;
  mount.transform.rotation.w = 0.5;
  tf_broadcaster_.sendTransform(mount);
}

ros::Time SimulatedRobot::drive(const std::function<void(sensor_msgs::Image&)>& change) {
  auto [left, right] = see();
  const ros::Time stamp = left.header.stamp;
  if (change) {
    change(left);
    change(right);
  }
  publish(left, right);
  return stamp;
}

std::pair<sensor_msgs::Image, sensor_msgs::Image> SimulatedRobot::see() {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.translation().z() = way_m_;
  T_world_camera.rotate(Eigen::AngleAxisd(-left_rad_, Eigen::Vector3d::UnitY()));
  const StereoPair pair = scene_.render(T_world_camera, toNanoseconds(stamp_));
  std_msgs::Header header;
  header.stamp = stamp_;
  header.frame_id = kCameraFrame;
  way_m_ += kStep_m;
  stamp_ += ros::Duration(kPeriod_s);
  return {*cv_bridge::CvImage(header, MONO8, pair.left).toImageMsg(),
          *cv_bridge::CvImage(header, MONO8, pair.right).toImageMsg()};
}

void SimulatedRobot::publish(const sensor_msgs::Image& left, const sensor_msgs::Image& right) {
  left_image_publisher_.publish(boost::make_shared<sensor_msgs::Image>(left));
  right_image_publisher_.publish(boost::make_shared<sensor_msgs::Image>(right));
}

std::optional<nav_msgs::Odometry> SimulatedRobot::odometryOf(const ros::Time& stamp,
                                                             std::chrono::milliseconds timeout) {
  return waitFor(stamp, odometry_, timeout);
}

std::optional<OdometryStatus> SimulatedRobot::statusOf(const ros::Time& stamp,
                                                       std::chrono::milliseconds timeout) {
  return waitFor(stamp, status_, timeout);
}

std::optional<nav_msgs::Odometry> SimulatedRobot::odometryFrom(const ros::Time& stamp) {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto there = [&] { return odometry_.lower_bound(stamp) != odometry_.end(); };
  if (!received_.wait_for(lock, kHangLimit, there)) return std::nullopt;
  return odometry_.lower_bound(stamp)->second;
}

std::optional<OdometryStatus> SimulatedRobot::statusThat(
    const std::function<bool(const OdometryStatus&)>& fits, std::chrono::milliseconds timeout) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!received_.wait_for(lock, timeout, [&] { return fits(last_status_); })) return std::nullopt;
  return last_status_;
}

std::optional<OdometryStatus> SimulatedRobot::statusWith(std::uint8_t state,
                                                         const std::string& reason,
                                                         std::chrono::milliseconds timeout) {
  const auto fits = [&](const OdometryStatus& status) {
    return status.state == state && status.reason.find(reason) != std::string::npos;
  };
  return statusThat(fits, timeout);
}

template <class Message>
void SimulatedRobot::keep(const Message& message, std::map<ros::Time, Message>& messages) {
  const std::lock_guard<std::mutex> lock(mutex_);
  messages[message.header.stamp] = message;
  received_.notify_all();
}

template <class Message>
std::optional<Message> SimulatedRobot::waitFor(const ros::Time& stamp,
                                               const std::map<ros::Time, Message>& messages,
                                               std::chrono::milliseconds timeout) {
  std::unique_lock<std::mutex> lock(mutex_);
  const bool there = received_.wait_for(lock, timeout, [&] { return messages.count(stamp) > 0; });
  if (!there) return std::nullopt;
  return messages.at(stamp);
}

}  // namespace rotrocc
