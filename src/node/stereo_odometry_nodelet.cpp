#include <exception>
#include <memory>
#include <stdexcept>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "input/callback_thread.h"
#include "input/log.h"
#include "node/node_parameters.h"
#include "node/stereo_odometry.h"

namespace rotrocc {

/// StereoOdometry as a nodelet.
class StereoOdometryNodelet : public nodelet::Nodelet {
 public:
  ~StereoOdometryNodelet() override { callbacks_.stop(); }

 private:
  void onInit() override;

  CallbackThread callbacks_;
  std::unique_ptr<StereoOdometry> odometry_;
};

/// Throws std::exception, after a fatal log, if the odometry cannot start.
void StereoOdometryNodelet::onInit() {
  try {
    ros::NodeHandle nh = callbacks_.attach(getNodeHandle());
    ros::NodeHandle private_nh = callbacks_.attach(getPrivateNodeHandle());
    const Parameters parameters = readParameters(private_nh);
    odometry_ = std::make_unique<StereoOdometry>(nh, private_nh, getName(), parameters);
    callbacks_.start();
  } catch (const std::exception& error) {
    Log(getName()).fatal(error.what());
    throw;
  } catch (...) {  // the loader catches std::exception only
    Log(getName()).fatal("unknown error");
    throw std::runtime_error("unknown error");
  }
}

}  // namespace rotrocc

PLUGINLIB_EXPORT_CLASS(rotrocc::StereoOdometryNodelet, nodelet::Nodelet)
