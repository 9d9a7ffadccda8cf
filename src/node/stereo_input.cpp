#include "node/stereo_input.h"

#include <stdexcept>
#include <string>
#include <utility>

#include <image_transport/image_transport.h>
#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <boost/algorithm/string/join.hpp>

#include "input/camera_calibration.h"
#include "input/message_conversion.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

constexpr int kImageQueueSize = 5;

using Side = StereoIntake::Side;

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
                         const Log& log)
    : log_(log),
      silence_(parameters.no_input_warning_s, std::chrono::steady_clock::now(), log),
      intake_(
          parameters,
          drops,
          [this, &drops, on_pair = std::move(on_pair)](ReceivedPair pair) {
            const std::int64_t stamp_ns = toNanoseconds(pair.images.left->header.stamp);
            silence_.onPair(stamp_ns, pair.stamp_age_s, totalOf(drops.counts()), now().time);
            on_pair(std::move(pair));
          },
          log),
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
  // Not in the private namespace, where unknown parameters are errors.
  const ros::NodeHandle transport_nh(nh, name);
  const std::string& transport = parameters.image_transport;
  std::string topic = name + (parameters.rectify ? "/image_raw" : "/image_rect");
  // image_transport appends the transport to a name that it does not resolve, so remappings would
  // not be found. A raw topic is resolved only once: left and right may be remapped to each other.
  if (transport != "raw") topic = nh.resolveName(topic);
  image_transport::ImageTransport images(nh);
  try {
    subscribers.image =
        images.subscribe(topic,
                         kImageQueueSize,
                         [this, side](const sensor_msgs::Image::ConstPtr& image) {
                           intake_.addImage(side, image, now());
                         },
                         ros::VoidPtr(),
                         {transport, ros::TransportHints().tcpNoDelay(), transport_nh});
  } catch (const image_transport::TransportLoadException& error) {
    throw std::runtime_error("image_transport is " + transport + ", but this machine only has " +
                             boost::algorithm::join(images.getLoadableTransports(), " ") +
                             ": install its plugin, or set another one (" + error.what() + ")");
  }
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
  silence_.onTick(report, asked);
  logOnce(report);
  return report;
}

/// What only the user knows to be right.
void StereoInput::logOnce(const InputReport& report) {
  const std::string& topic = report.left_image.topic;
  if (report.has_raw_infos && !isRectifiedByName(topic) &&
      !std::exchange(logged_raw_infos_, true)) {
    log_.warn(topic + " is taken as rectified, but is not named image_rect, and " +
              report.left_info.topic + " is of raw images: set rectify if they are raw");
  }
  if (isOfAnotherClock(report) && !std::exchange(logged_clock_, true)) {
    log_.warn("the stamps of " + topic + " are from another clock, " +
              fixedText(std::abs(*report.stamp_age_s), 0) +
              (*report.stamp_age_s > 0.0 ? " s behind" : " s ahead of") +
              " that of this machine, and so are odometry and tf: synchronize the clocks, or play "
              "bags with --clock and use_sim_time");
  }
}

}  // namespace rotrocc
