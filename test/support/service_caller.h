#pragma once

#include <future>
#include <iostream>
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

  /// Returns false, after a message, if there is no service or no reply within kHangLimit: roscpp
  /// may lose a reply, and would wait for it forever.
  template <class Service>
  bool call(const std::string& name, Service& service) {
    const std::string full_name = node_ + "/" + name;
    ros::ServiceClient& client = clients_[name];
    const bool there = waitUntil([&] {
      if (!client.isValid()) client = nh_.serviceClient<Service>(full_name, true);
      return client.isValid();
    });
    if (!there) return fail("there is no service " + full_name);
    std::future<bool> reply = std::async(std::launch::async, [&] { return client.call(service); });
    if (reply.wait_for(kHangLimit) == std::future_status::ready) return reply.get();
    client.shutdown();  // ends the call, and the next one connects anew
    reply.wait();
    return fail("no reply of the service " + full_name);
  }

 private:
  static bool fail(const std::string& why) {
    std::cerr << why << std::endl;
    return false;
  }

  std::string node_;
  ros::NodeHandle nh_;
  std::map<std::string, ros::ServiceClient> clients_;
};

}  // namespace rotrocc
