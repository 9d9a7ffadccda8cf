#include "node/odometry_services.h"

#include <exception>
#include <utility>

#include "node/advertise.h"

namespace rotrocc {
namespace {

/// Fills a response with the sentence that `action` returns, or with its error.
template <class Response, class Action>
bool answer(const Log& log, const std::string& service, Response& response, Action action) {
  try {
    response.message = action();
    response.success = true;
    log.info(service + ": " + response.message);
  } catch (const std::exception& error) {
    response.message = error.what();
    response.success = false;
    log.warn(service + " refused: " + response.message);
  }
  return true;
}

ros::NodeHandle withQueue(ros::NodeHandle nh, ros::CallbackQueue& queue) {
  nh.setCallbackQueue(&queue);
  return nh;
}

}  // namespace

OdometryServices::OdometryServices(ros::NodeHandle& private_nh, Actions actions, Log log)
    : actions_(std::move(actions)),
      log_(std::move(log)),
      reset_(advertiseService(private_nh, "reset", &OdometryServices::onReset, this)),
      set_pose_(advertiseService(private_nh, "set_pose", &OdometryServices::onSetPose, this)),
      pause_(advertiseService(private_nh, "pause", &OdometryServices::onPause, this)) {
  ros::NodeHandle save_nh = withQueue(private_nh, save_queue_);
  save_trajectory_ =
      advertiseService(save_nh, "save_trajectory", &OdometryServices::onSaveTrajectory, this);
  save_spinner_.start();
}

bool OdometryServices::onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  return answer(log_, "reset", response, [&] {
    actions_.reset();
    return "the odometry restarts at the initial pose with the next pair";
  });
}

bool OdometryServices::onSetPose(SetPose::Request& request, SetPose::Response& response) {
  return answer(log_, "set_pose", response, [&] {
    actions_.set_pose(request.pose);
    return "the odometry continues from the given pose";
  });
}

bool OdometryServices::onPause(std_srvs::SetBool::Request& request,
                               std_srvs::SetBool::Response& response) {
  return answer(log_, "pause", response, [&] {
    actions_.pause(request.data);
    return request.data ? "paused: pairs are dropped, the pose is held"
                        : "resumed at the last pose";
  });
}

bool OdometryServices::onSaveTrajectory(SaveTrajectory::Request& request,
                                        SaveTrajectory::Response& response) {
  return answer(log_, "save_trajectory", response, [&] {
    return actions_.save_trajectory(request.path, request.format);
  });
}

}  // namespace rotrocc
