#include "node/stereo_input.h"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <ros/time.h>

#include "input/message_conversion.h"

namespace rotrocc {
namespace {

constexpr int kImageQueueSize = 5;

using Side = StereoIntake::Side;

/// "raw theora" for "image_transport/raw" and "image_transport/theora".
std::string listOf(const std::vector<std::string>& transports) {
  std::string list;
  for (const std::string& transport : transports) {
    list += (list.empty() ? "" : " ") + transport.substr(transport.rfind('/') + 1);
  }
  return list;
}

/// image_transport appends the transport to a name that it does not resolve, so remappings of the
/// name would not be found. A raw topic is resolved where it is subscribed, and only once: left and
/// right may be remapped to each other.
std::string topicOf(const ros::NodeHandle& nh,
                    const std::string& name,
                    const std::string& transport) {
  return transport == "raw" ? name : nh.resolveName(name);
}

/// Transports have parameters of their own: in the namespace of the topic, not in the private
/// namespace, where unknown names are errors.
image_transport::Subscriber subscribe(
    const ros::NodeHandle& nh,
    const std::string& side,
    const NodeParameters& parameters,
    void (StereoInput::*callback)(const sensor_msgs::Image::ConstPtr&),
    StereoInput* object) {
  const std::string& transport = parameters.image_transport;
  const std::string name = side + (parameters.rectify ? "/image_raw" : "/image_rect");
  const image_transport::TransportHints hints(
      transport, ros::TransportHints().tcpNoDelay(), ros::NodeHandle(nh, side));
  image_transport::ImageTransport images(nh);
  try {
    const std::string topic = topicOf(nh, name, transport);
    return images.subscribe(topic, kImageQueueSize, callback, object, hints);
  } catch (const image_transport::TransportLoadException& error) {
    throw std::runtime_error("image_transport is " + transport + ", but this machine only has " +
                             listOf(images.getLoadableTransports()) +
                             ": install its plugin, or set another one (" + error.what() + ")");
  }
}

Arrival now() {
  return {std::chrono::steady_clock::now(), toNanoseconds(ros::Time::now())};
}

}  // namespace

StereoInput::StereoInput(ros::NodeHandle& nh,
                         const NodeParameters& parameters,
                         DropLog& drops,
                         StereoIntake::PairHandler on_pair,
                         Log log)
    : intake_(parameters, drops, std::move(on_pair), std::move(log)) {
  left_info_subscriber_ =
      nh.subscribe("left/camera_info", kImageQueueSize, &StereoInput::onLeftInfo, this);
  right_info_subscriber_ =
      nh.subscribe("right/camera_info", kImageQueueSize, &StereoInput::onRightInfo, this);
  left_image_subscriber_ = subscribe(nh, "left", parameters, &StereoInput::onLeftImage, this);
  right_image_subscriber_ = subscribe(nh, "right", parameters, &StereoInput::onRightImage, this);
}

void StereoInput::onLeftImage(const sensor_msgs::Image::ConstPtr& image) {
  intake_.addImage(Side::kLeft, image, now());
}

void StereoInput::onRightImage(const sensor_msgs::Image::ConstPtr& image) {
  intake_.addImage(Side::kRight, image, now());
}

void StereoInput::onLeftInfo(const sensor_msgs::CameraInfo::ConstPtr& info) {
  intake_.addInfo(Side::kLeft, info, now());
}

void StereoInput::onRightInfo(const sensor_msgs::CameraInfo::ConstPtr& info) {
  intake_.addInfo(Side::kRight, info, now());
}

InputReport StereoInput::report() {
  const Arrival asked = now();
  InputReport report = intake_.report(asked.time);
  report.left_image.topic = left_image_subscriber_.getTopic();
  report.left_image.publishers = left_image_subscriber_.getNumPublishers();
  report.right_image.topic = right_image_subscriber_.getTopic();
  report.right_image.publishers = right_image_subscriber_.getNumPublishers();
  report.left_info.topic = left_info_subscriber_.getTopic();
  report.left_info.publishers = left_info_subscriber_.getNumPublishers();
  report.right_info.topic = right_info_subscriber_.getTopic();
  report.right_info.publishers = right_info_subscriber_.getNumPublishers();
  report.clock_missing = ros::Time::isSimTime() && asked.clock_ns == 0;
  report.clock_stands = clock_.standsStill(asked.clock_ns, asked.time);
  return report;
}

}  // namespace rotrocc
