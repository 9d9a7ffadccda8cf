#include "node/odometry_services.h"

#include <exception>

#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "node/advertise.h"
#include "node/odometry_messages.h"
#include "rotrocc/SaveTrajectory.h"
#include "rotrocc/SetPose.h"

namespace rotrocc {
namespace {

/// A service whose response is the sentence that `action` returns for a request, or its error.
template <class Service, class Action>
ros::ServiceServer serve(ros::NodeHandle& nh,
                         const std::string& name,
                         const Log& log,
                         const Action& action) {
  return advertiseService<Service>(nh, name, [=](auto& request, auto& response) {
    try {
      response.message = action(request);
      response.success = true;
      log.info(name + ": " + response.message);
    } catch (const std::exception& error) {
      response.message = error.what();
      response.success = false;
      log.warn(name + " rejected: " + response.message);
    }
    return true;
  });
}

}  // namespace

OdometryServices::OdometryServices(ros::NodeHandle& private_nh,
                                   PairProcessor& processor,
                                   OdometryHealth& health,
                                   const Save& save,
                                   const std::string& odom_frame,
                                   const Log& log) {
  servers_.push_back(serve<std_srvs::Trigger>(private_nh, "reset", log, [&](const auto&) {
    processor.requestReset();
    return "the odometry restarts at the initial pose with the next pair";
  }));
  servers_.push_back(
      serve<SetPose>(private_nh, "set_pose", log, [&, odom_frame](const auto& request) {
        processor.requestPose(toPose(request.pose, odom_frame));
        return "the odometry continues from the given pose";
      }));
  servers_.push_back(serve<std_srvs::SetBool>(private_nh, "pause", log, [&](const auto& request) {
    if (health.paused() && !request.data) processor.requestRestart();
    health.setPaused(request.data);
    return request.data ? "paused: pairs are dropped, the pose is held"
                        : "resumed at the last pose, moved by guess_frame or guess_topic if set";
  }));
  ros::NodeHandle save_nh = save_callbacks_.attach(private_nh);
  servers_.push_back(
      serve<SaveTrajectory>(save_nh, "save_trajectory", log, [save](const auto& request) {
        return save(request.path, request.format);
      }));
  save_callbacks_.start();
}

}  // namespace rotrocc
