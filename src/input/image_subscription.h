#pragma once

#include <cstdint>
#include <string>

#include <image_transport/subscriber.h>
#include <ros/node_handle.h>
#include <sensor_msgs/Image.h>
#include <boost/function.hpp>

namespace rotrocc {

/// Subscribes to the images of a name, which may be remapped, through an image transport, whose own
/// parameters are in the namespace of `transport_nh`. Throws std::runtime_error if this machine
/// does not have the transport.
image_transport::Subscriber subscribeImages(
    const ros::NodeHandle& nh,
    const std::string& name,
    const std::string& transport,
    const ros::NodeHandle& transport_nh,
    std::uint32_t queue_size,
    const boost::function<void(const sensor_msgs::Image::ConstPtr&)>& callback);

}  // namespace rotrocc
