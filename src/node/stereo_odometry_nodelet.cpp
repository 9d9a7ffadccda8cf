#include <exception>
#include <memory>
#include <stdexcept>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "input/log.h"
#include "node/node_parameters.h"
#include "node/stereo_odometry.h"

namespace rotrocc {

/// StereoOdometry as a nodelet.
class StereoOdometryNodelet : public nodelet::Nodelet {
 private:
  void onInit() override;

  std::unique_ptr<StereoOdometry> odometry_;
};

/// Throws std::exception, after a fatal log, if the odometry cannot start.
void StereoOdometryNodelet::onInit() {
  // The loader destroys the callback queues of a nodelet that fails before the nodelet itself, so
  // that a publisher, subscriber or timer left in it would be removed from a queue that is gone.
  // It catches std::exception only.
  try {
    const Parameters parameters = readParameters(getPrivateNodeHandle(), Log(getName()));
    odometry_ = std::make_unique<StereoOdometry>(
        getNodeHandle(), getPrivateNodeHandle(), getName(), parameters);
  } catch (const std::exception& error) {
    Log(getName()).fatal(error.what());
    throw;
  } catch (...) {
    Log(getName()).fatal("unknown error");
    throw std::runtime_error("unknown error");
  }
}

}  // namespace rotrocc

PLUGINLIB_EXPORT_CLASS(rotrocc::StereoOdometryNodelet, nodelet::Nodelet)
