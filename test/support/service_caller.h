#pragma once

#include <map>
#include <string>
#include <utility>

#include <ros/node_handle.h>
#include <ros/service_client.h>

#include "support/wait_until.h"

namespace rotrocc {

/// Calls the services of a node once they are available. Connections are kept: roscpp may confuse
/// the end of one with that of the next, which has the same file descriptor, so that with a
/// connection per call about one call in a thousand fails.
class ServiceCaller {
 public:
  explicit ServiceCaller(std::string node) : node_(std::move(node)) {}

  template <class Service>
  bool call(const std::string& name, Service& service) {
    ros::ServiceClient& client = clients_[name];
    waitUntil([&] {
      if (!client.isValid()) client = nh_.serviceClient<Service>(node_ + "/" + name, true);
      return client.isValid();
    });
    return client.call(service);
  }

 private:
  std::string node_;
  ros::NodeHandle nh_;
  std::map<std::string, ros::ServiceClient> clients_;
};

}  // namespace rotrocc
