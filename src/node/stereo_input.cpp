#include "node/stereo_input.h"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

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
image_transport::Subscriber subscribeImages(
    const ros::NodeHandle& nh,
    const std::string& side,
    const NodeParameters& parameters,
    const boost::function<void(const sensor_msgs::Image::ConstPtr&)>& callback) {
  const std::string& transport = parameters.image_transport;
  const std::string name = side + (parameters.rectify ? "/image_raw" : "/image_rect");
  const image_transport::TransportHints hints(
      transport, ros::TransportHints().tcpNoDelay(), ros::NodeHandle(nh, side));
  image_transport::ImageTransport images(nh);
  try {
    const std::string topic = topicOf(nh, name, transport);
    return images.subscribe(topic, kImageQueueSize, callback, ros::VoidPtr(), hints);
  } catch (const image_transport::TransportLoadException& error) {
    throw std::runtime_error("image_transport is " + transport + ", but this machine only has " +
                             listOf(images.getLoadableTransports()) +
                             ": install its plugin, or set another one (" + error.what() + ")");
  }
}

Arrival now() {
  return {std::chrono::steady_clock::now(), toNanoseconds(ros::Time::now())};
}

template <class Subscriber>
void addTopic(const Subscriber& subscriber, TopicReport& report) {
  report.topic = subscriber.getTopic();
  report.publishers = subscriber.getNumPublishers();
}

}  // namespace

StereoInput::StereoInput(ros::NodeHandle& nh,
                         const NodeParameters& parameters,
                         DropLog& drops,
                         StereoIntake::PairHandler on_pair,
                         Log log)
    : intake_(parameters, drops, std::move(on_pair), std::move(log)),
      left_(subscribe(nh, parameters, Side::kLeft)),
      right_(subscribe(nh, parameters, Side::kRight)) {}

StereoInput::Subscribers StereoInput::subscribe(ros::NodeHandle& nh,
                                                const NodeParameters& parameters,
                                                Side side) {
  const std::string name = side == Side::kLeft ? "left" : "right";
  Subscribers subscribers;
  subscribers.info = nh.subscribe<sensor_msgs::CameraInfo>(
      name + "/camera_info",
      kImageQueueSize,
      [this, side](const sensor_msgs::CameraInfo::ConstPtr& info) {
        intake_.addInfo(side, info, now());
      });
  subscribers.image = subscribeImages(
      nh, name, parameters, [this, side](const sensor_msgs::Image::ConstPtr& image) {
        intake_.addImage(side, image, now());
      });
  return subscribers;
}

InputReport StereoInput::report() {
  const Arrival asked = now();
  InputReport report = intake_.report(asked.time);
  addTopic(left_.image, report.left_image);
  addTopic(right_.image, report.right_image);
  addTopic(left_.info, report.left_info);
  addTopic(right_.info, report.right_info);
  report.clock_missing = ros::Time::isSimTime() && asked.clock_ns == 0;
  report.clock_stands = clock_.standsStill(asked.clock_ns, asked.time);
  return report;
}

}  // namespace rotrocc
