#include "input/image_subscription.h"

#include <stdexcept>

#include <image_transport/image_transport.h>
#include <boost/algorithm/string/join.hpp>

namespace rotrocc {
namespace {

/// image_transport appends the transport to a name that it does not resolve, so remappings of the
/// name would not be found. A raw topic is resolved where it is subscribed, and only once: left and
/// right may be remapped to each other.
std::string topicOf(const ros::NodeHandle& nh,
                    const std::string& name,
                    const std::string& transport) {
  return transport == "raw" ? name : nh.resolveName(name);
}

}  // namespace

image_transport::Subscriber subscribeImages(
    const ros::NodeHandle& nh,
    const std::string& name,
    const std::string& transport,
    const ros::NodeHandle& transport_nh,
    std::uint32_t queue_size,
    const boost::function<void(const sensor_msgs::Image::ConstPtr&)>& callback) {
  const image_transport::TransportHints hints(
      transport, ros::TransportHints().tcpNoDelay(), transport_nh);
  image_transport::ImageTransport images(nh);
  try {
    const std::string topic = topicOf(nh, name, transport);
    return images.subscribe(topic, queue_size, callback, ros::VoidPtr(), hints);
  } catch (const image_transport::TransportLoadException& error) {
    throw std::runtime_error("image_transport is " + transport + ", but this machine only has " +
                             boost::algorithm::join(images.getLoadableTransports(), " ") +
                             ": install its plugin, or set another one (" + error.what() + ")");
  }
}

}  // namespace rotrocc
