#pragma once

#include <functional>
#include <string>

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/spinner.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "input/log.h"
#include "rotrocc/SaveTrajectory.h"
#include "rotrocc/SetPose.h"

namespace rotrocc {

/// The services ~reset, ~set_pose, ~pause and ~save_trajectory. An exception of an action gives a
/// response without success; it does not leave the callback. Saving takes its time in a thread of
/// its own; the others run in the queue of the handle.
class OdometryServices {
 public:
  struct Actions {
    std::function<void()> reset;
    std::function<void(const geometry_msgs::PoseWithCovarianceStamped&)> set_pose;
    std::function<void(bool)> pause;
    /// Returns a description of what was written.
    std::function<std::string(const std::string& path, const std::string& format)> save_trajectory;
  };

  OdometryServices(ros::NodeHandle& private_nh, Actions actions, Log log = Log());

 private:
  bool onReset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onSetPose(SetPose::Request& request, SetPose::Response& response);
  bool onPause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool onSaveTrajectory(SaveTrajectory::Request& request, SaveTrajectory::Response& response);

  Actions actions_;
  Log log_;
  ros::ServiceServer reset_, set_pose_, pause_;
  ros::CallbackQueue save_queue_;
  ros::ServiceServer save_trajectory_;
  ros::AsyncSpinner save_spinner_{1, &save_queue_};
};

}  // namespace rotrocc
