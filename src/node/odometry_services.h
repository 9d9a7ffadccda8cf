#pragma once

#include <functional>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include "input/callback_thread.h"
#include "input/log.h"
#include "node/base/pair_processor.h"
#include "node/health/odometry_health.h"

namespace rotrocc {

/// The services ~reset, ~set_pose, ~pause and ~save_trajectory. What fails gives a
/// response without success; no exception leaves the callback. Saving takes its time in a thread of
/// its own; the others run in the queue of the handle.
class OdometryServices {
 public:
  /// Returns a description of what was written.
  using Save = std::function<std::string(const std::string& path, const std::string& format)>;

  /// `processor` and `health` must outlive this. Poses that are set must be in `odom_frame`.
  OdometryServices(ros::NodeHandle& private_nh,
                   PairProcessor& processor,
                   OdometryHealth& health,
                   const Save& save,
                   const std::string& odom_frame,
                   const Log& log = Log());
  ~OdometryServices() { save_callbacks_.stop(); }

 private:
  CallbackThread save_callbacks_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace rotrocc
