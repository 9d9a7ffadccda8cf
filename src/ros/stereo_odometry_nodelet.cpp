#include "stereo_odometry_nodelet.h"

#include <exception>
#include <utility>

#include <ros/init.h>
#include <pluginlib/class_list_macros.hpp>

#include "message_conversion.h"
#include "node_parameters.h"

namespace rotrocc {
namespace {

/// How often the worker looks for the end of the process, which may come without a call of the
/// destructor.
constexpr std::chrono::milliseconds kIdlePoll(100);
/// How often it looks for tf while a pair waits for it.
constexpr std::chrono::milliseconds kTfPoll(10);

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

/// The frame of an image, as tf2 knows it: older drivers lead it with a slash.
std::string frameOf(const sensor_msgs::Image& image) {
  const std::string& frame = image.header.frame_id;
  return frame.compare(0, 1, "/") == 0 ? frame.substr(1) : frame;
}

}  // namespace

StereoOdometryNodelet::~StereoOdometryNodelet() {
  mailbox_.close();
  if (worker_.joinable()) worker_.join();
}

void StereoOdometryNodelet::onInit() {
  try {
    start(readParameters(getPrivateNodeHandle()));
  } catch (const std::exception& error) {
    NODELET_FATAL_STREAM(error.what());
    throw;  // the loader says that it could not load us, and lives on
  }
}

void StereoOdometryNodelet::start(const Parameters& parameters) {
  parameters_ = parameters.node;
  if (!parameters_.trajectory_file.empty()) {
    trajectory_.emplace(parameters_.trajectory_file,
                        trajectoryFormat(parameters_.trajectory_format));
  }
  odometry_.emplace(parameters.odometry);
  mount_.emplace(parameters_.base_frame);
  publisher_.emplace(getNodeHandle(), parameters_);
  input_.emplace(
      getNodeHandle(), parameters_, [this](ReceivedPair pair) { mailbox_.put(std::move(pair)); });
  worker_ = std::thread(&StereoOdometryNodelet::work, this);
}

void StereoOdometryNodelet::work() {
  std::optional<ReceivedPair> pair;
  while (ros::ok() && !mailbox_.closed()) {
    if (auto newer = mailbox_.take(pair ? kTfPoll : kIdlePoll)) {
      if (pair) ++counters_.pairs_dropped;
      pair = std::move(newer);
    }
    if (!pair) continue;
    const auto& T_base_camera = mount_->find(frameOf(*pair->images.left));
    if (!T_base_camera) continue;
    processSafely(*pair, *T_base_camera);
    pair.reset();
  }
}

void StereoOdometryNodelet::processSafely(const ReceivedPair& received,
                                          const Eigen::Isometry3d& T_base_camera) {
  try {
    process(received, T_base_camera);
  } catch (const std::exception& error) {
    ++counters_.inputs_rejected;
    if (rejected_warning_.pass()) NODELET_WARN_STREAM("pair not processed: " << error.what());
  }
}

void StereoOdometryNodelet::process(const ReceivedPair& received,
                                    const Eigen::Isometry3d& T_base_camera) {
  const StereoPair pair = converter_.convert(*received.images.left, *received.images.right);
  requireSize(pair, received.camera);
  restartIfTimeWentBack(pair.stamp_ns);
  if (!base_odometry_) {
    base_odometry_.emplace(
        T_base_camera, parameters_.lost_speed_sigma_mps, parameters_.lost_turn_rate_sigma_rps);
  }

  const OdometryResult result = odometry_->process(pair, received.camera);
  const BaseState state = base_odometry_->add(result);
  ++counters_.pairs_processed;
  if (result.state == State::kLost) ++counters_.pairs_lost;
  logState(result);
  writeTrajectory(state);

  const std::string camera_frame = frameOf(*received.images.left);
  publisher_->publishMotion(
      toStatus(result, countInputs(), millisecondsSince(received.arrival), camera_frame), state);
  publisher_->publishPictures(pair.left, *odometry_, result, camera_frame);
}

/// A bag that begins anew, or a simulation: the robot goes on from where it is.
void StereoOdometryNodelet::restartIfTimeWentBack(std::int64_t stamp_ns) {
  if (last_stamp_ns_ && stamp_ns < *last_stamp_ns_) {
    NODELET_WARN_STREAM("time went back from " << toRosTime(*last_stamp_ns_) << " to "
                                               << toRosTime(stamp_ns)
                                               << ": starting anew at the last pose");
    odometry_->reset();
  }
  last_stamp_ns_ = stamp_ns;
}

InputCounters StereoOdometryNodelet::countInputs() const {
  InputCounters counters = counters_;
  counters.pairs_dropped += mailbox_.replaced();
  counters.images_unmatched = input_->unmatchedImages();
  counters.inputs_rejected += input_->rejected();
  return counters;
}

void StereoOdometryNodelet::logState(const OdometryResult& result) {
  const State before = std::exchange(last_state_, result.state);
  if (result.state == State::kLost) {
    if (lost_warning_.pass()) NODELET_WARN_STREAM("lost: " << result.reason);
  } else if (before == State::kLost) {
    NODELET_INFO_STREAM("no longer lost: " << toString(result.state));
  }
}

void StereoOdometryNodelet::writeTrajectory(const BaseState& state) {
  if (!trajectory_) return;
  try {
    trajectory_->write({state.stamp_ns, state.T_first_camera});
  } catch (const std::exception& error) {
    NODELET_ERROR_STREAM("the trajectory ends here: " << error.what());
    trajectory_.reset();
  }
}

}  // namespace rotrocc

PLUGINLIB_EXPORT_CLASS(rotrocc::StereoOdometryNodelet, nodelet::Nodelet)
