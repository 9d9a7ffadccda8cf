#pragma once

#include <map>
#include <string>
#include <utility>

#include <ros/node_handle.h>
#include <ros/service_client.h>

#include "support/wait_until.h"

namespace rotrocc {

/// Calls the services of a node, as soon as they are there. Connections stay: roscpp may take the
/// end of one for that of the next, which has the same file descriptor, so that of a thousand calls
/// with a connection each about one fails.
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
