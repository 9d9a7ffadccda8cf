#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <boost/function.hpp>

namespace rotrocc {

/// NodeHandle::advertise(), but throws std::runtime_error if the process already has that topic
/// with another type, instead of returning a publisher that does not exist. There is none during
/// shutdown.
template <class Message>
ros::Publisher advertise(ros::NodeHandle& nh,
                         const std::string& topic,
                         std::uint32_t queue_size,
                         bool latch = false) {
  ros::Publisher publisher = nh.advertise<Message>(topic, queue_size, latch);
  if (publisher || ros::isShuttingDown()) return publisher;
  throw std::runtime_error(
      "cannot advertise " + nh.resolveName(topic) +
      ": this process already publishes it with another type; remap one of them");
}

/// The same for NodeHandle::advertiseService() and a service that the process already has.
template <class Service>
ros::ServiceServer advertiseService(
    ros::NodeHandle& nh,
    const std::string& name,
    const boost::function<bool(typename Service::Request&, typename Service::Response&)>&
        callback) {
  ros::ServiceServer server = nh.advertiseService(name, callback);
  if (server || ros::isShuttingDown()) return server;
  throw std::runtime_error("cannot advertise the service " + nh.resolveName(name) +
                           ": this process already has one of that name; remap one of them");
}

}  // namespace rotrocc
