#include "stereo_input.h"

#include <utility>

#include <ros/console.h>

#include "message_conversion.h"

namespace rotrocc {
namespace {

constexpr int kQueueSize = 5;
constexpr double kSmallBaseline_m = 0.005;
constexpr double kGreatBaseline_m = 10.0;

/// Transports keep settings on the parameter server: not in our private namespace, where an unknown
/// name is an error, but beside the topic.
image_transport::Subscriber subscribe(
    const ros::NodeHandle& nh,
    const std::string& side,
    const std::string& transport,
    void (StereoInput::*callback)(const sensor_msgs::Image::ConstPtr&),
    StereoInput* object) {
  const image_transport::TransportHints hints(
      transport, ros::TransportHints().tcpNoDelay(), ros::NodeHandle(nh, side));
  return image_transport::ImageTransport(nh).subscribe(
      side + "/image_rect", kQueueSize, callback, object, hints);
}

}  // namespace

StereoInput::StereoInput(ros::NodeHandle& nh, const NodeParameters& parameters, PairHandler on_pair)
    : on_pair_(std::move(on_pair)),
      synchronizer_(parameters.max_stamp_difference_s,
                    static_cast<std::size_t>(parameters.queue_size)) {
  left_info_subscriber_ =
      nh.subscribe("left/camera_info", kQueueSize, &StereoInput::onLeftInfo, this);
  right_info_subscriber_ =
      nh.subscribe("right/camera_info", kQueueSize, &StereoInput::onRightInfo, this);
  const std::string& transport = parameters.image_transport;
  left_image_subscriber_ = subscribe(nh, "left", transport, &StereoInput::onLeftImage, this);
  right_image_subscriber_ = subscribe(nh, "right", transport, &StereoInput::onRightImage, this);
}

void StereoInput::onLeftImage(const sensor_msgs::Image::ConstPtr& image) {
  takePair(synchronizer_.addLeft(image));
}

void StereoInput::onRightImage(const sensor_msgs::Image::ConstPtr& image) {
  takePair(synchronizer_.addRight(image));
}

void StereoInput::onLeftInfo(const sensor_msgs::CameraInfo::ConstPtr& info) {
  left_info_ = info;
  updateCamera();
}

void StereoInput::onRightInfo(const sensor_msgs::CameraInfo::ConstPtr& info) {
  right_info_ = info;
  updateCamera();
}

void StereoInput::takePair(const std::optional<StereoImages>& images) {
  unmatched_images_ = synchronizer_.unmatched();
  if (!images) return;
  if (waiting_) {
    ++rejected_;
    if (warning_.pass()) ROS_WARN_STREAM("images wait for " << missingInfo());
  }
  waiting_ = ReceivedPair{*images, {}, std::chrono::steady_clock::now()};
  handOver();
}

void StereoInput::updateCamera() {
  if (!left_info_ || !right_info_) return;
  try {
    setCamera(toStereoCamera(*left_info_, *right_info_));
  } catch (const std::exception& error) {
    ++rejected_;
    camera_.reset();
    if (camera_error_ != error.what()) ROS_ERROR_STREAM(error.what());
    camera_error_ = error.what();
  }
  handOver();
}

void StereoInput::setCamera(const StereoCamera& camera) {
  if (camera_ == camera) return;
  camera_ = camera;
  camera_error_.clear();
  ROS_INFO_STREAM("stereo camera of P: " << camera.width << "x" << camera.height << " px, fx "
                                         << camera.fx << " px, baseline " << camera.baseline_m
                                         << " m");
  if (camera.baseline_m < kSmallBaseline_m || camera.baseline_m > kGreatBaseline_m) {
    ROS_WARN_STREAM("a baseline of " << camera.baseline_m
                                     << " m is unusual: is P[3] of camera_info in metres?");
  }
}

void StereoInput::handOver() {
  if (!waiting_ || !camera_) return;
  waiting_->camera = *camera_;
  on_pair_(std::move(*waiting_));
  waiting_.reset();
}

std::string StereoInput::missingInfo() const {
  if (!left_info_) return left_info_subscriber_.getTopic();
  if (!right_info_) return right_info_subscriber_.getTopic();
  return "a valid camera_info";
}

}  // namespace rotrocc
