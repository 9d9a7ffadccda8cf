#include "node/base/pair_processor.h"

#include <utility>

#include "common/stage_timer.h"
#include "common/to_seconds.h"
#include "input/image_validation.h"
#include "input/message_conversion.h"
#include "input/to_text.h"

namespace rotrocc {

PairProcessor::PairProcessor(const Parameters& parameters, Log log)
    : log_(std::move(log)),
      parameters_(parameters.node),
      systematic_error_(parameters.odometry.systematic_error),
      converter_(parameters.node.max_image_pixels),
      rectifier_(parameters.odometry.threads),
      odometry_(parameters.odometry),
      inspector_(parameters.odometry.correspondence_finder, parameters.node.rectify) {}

PairAnswer PairProcessor::process(const ReceivedPair& received,
                                  const Eigen::Isometry3d& T_base_camera,
                                  const MotionSource& expected,
                                  const RotationSource& measured_rotation) {
  configureIfAsked();
  PairAnswer answer;
  {
    const StageTimer timer(answer.conversion_ms);
    answer.pair = convert(received);
  }
  const bool asked = restartIfAsked();
  const bool went_back = restartIfTimeWentBack(answer.pair.stamp_ns);
  const bool gave_up = restartIfLostForLong(answer.pair.stamp_ns);
  answer.starts_trajectory = asked || went_back || gave_up;
  if (!base_odometry_) base_odometry_.emplace(parameters_, systematic_error_);
  setPoseIfAsked();
  move(received.camera, T_base_camera, expected, measured_rotation, answer);
  last_stamp_ns_ = answer.pair.stamp_ns;
  return answer;
}

std::string PairProcessor::inspect(const PairAnswer& answer, const StereoCamera& camera) {
  return inspector_.inspect(answer.pair, camera, answer.result);
}

StereoPair PairProcessor::convert(const ReceivedPair& received) {
  const StereoPair pair = converter_.convert(*received.images.left, *received.images.right);
  validateSize(*received.images.left, received.camera);
  return received.calibration ? rectifier_.rectify(pair, received.calibration) : pair;
}

void PairProcessor::configureIfAsked() {
  std::optional<VisualOdometry::Config> config;
  {
    const std::lock_guard<std::mutex> lock(requests_mutex_);
    config.swap(requests_.config);
  }
  if (!config) return;
  odometry_.configure(*config);
  rectifier_.setThreads(config->threads);
  inspector_.configure(config->correspondence_finder);
  systematic_error_ = config->systematic_error;
  if (base_odometry_) base_odometry_->setSystematicError(systematic_error_);
}

/// Returns whether a new trajectory starts.
bool PairProcessor::restartIfAsked() {
  const std::lock_guard<std::mutex> lock(requests_mutex_);
  if (requests_.reset || requests_.restart) odometry_.reset();
  if (requests_.reset) base_odometry_.reset();
  requests_.restart = false;
  return std::exchange(requests_.reset, false);
}

/// A looping bag, or a restarted simulation.
bool PairProcessor::restartIfTimeWentBack(std::int64_t stamp_ns) {
  if (!last_stamp_ns_ || stamp_ns >= *last_stamp_ns_) return false;
  const bool keep = parameters_.pose_after_time_jump == "keep";
  log_.warn("time jumped back from " + stampText(*last_stamp_ns_) + " to " + stampText(stamp_ns) +
            " s: restarting at " + (keep ? "the last pose" : "initial_pose") +
            " (pose_after_time_jump)");
  odometry_.reset();
  if (!keep) base_odometry_.reset();
  return true;
}

/// Whether a new trajectory starts.
bool PairProcessor::restartIfLostForLong(std::int64_t stamp_ns) {
  if (!lost_since_ns_ || parameters_.reset_after_lost_s <= 0.0) return false;
  const double lost_s = toSeconds(stamp_ns - *lost_since_ns_);
  if (lost_s < parameters_.reset_after_lost_s) return false;
  const bool keep = parameters_.pose_after_lost == "keep";
  log_.warn("lost for " + toText(lost_s) +
            " s, reset_after_lost_s = " + toText(parameters_.reset_after_lost_s) +
            ": restarting at " + (keep ? "the last pose" : "initial_pose") + " (pose_after_lost)");
  odometry_.reset();
  if (!keep) base_odometry_.reset();
  return !keep;
}

/// A pose that is set while lost would be lost again if the next pair were compared with one from
/// before the loss.
void PairProcessor::setPoseIfAsked() {
  const std::lock_guard<std::mutex> lock(requests_mutex_);
  if (!requests_.T_odom_base) return;
  base_odometry_->setPose(*requests_.T_odom_base);
  if (lost_since_ns_) odometry_.reset();
  requests_.T_odom_base.reset();
}

void PairProcessor::move(const StereoCamera& camera,
                         const Eigen::Isometry3d& T_base_camera,
                         const MotionSource& expected,
                         const RotationSource& measured_rotation,
                         PairAnswer& answer) {
  const std::int64_t stamp_ns = answer.pair.stamp_ns;
  std::optional<Eigen::Isometry3d> T_last_base, T_known_base, T_known_camera;
  if (expected && last_stamp_ns_ && stamp_ns > *last_stamp_ns_) {
    T_last_base = expected(*last_stamp_ns_, stamp_ns);
  }
  if (T_last_base && T_known_last_) {
    T_known_base = *T_known_last_ * *T_last_base;
    T_known_camera = T_base_camera_known_.inverse() * *T_known_base * T_base_camera;
  }
  answer.result = odometry_.process(answer.pair, camera, T_known_camera, measured_rotation);
  answer.state = base_odometry_->add(answer.result, T_base_camera, T_last_base);
  if (answer.result.state == State::kLost) {
    if (!lost_since_ns_) lost_since_ns_ = stamp_ns;
    T_known_last_ = T_known_base;
  } else {
    lost_since_ns_.reset();
    T_known_last_ = Eigen::Isometry3d::Identity();
    T_base_camera_known_ = T_base_camera;
  }
}

void PairProcessor::requestReset() {
  const std::lock_guard<std::mutex> lock(requests_mutex_);
  requests_.reset = true;
  requests_.T_odom_base.reset();
}

void PairProcessor::requestRestart() {
  const std::lock_guard<std::mutex> lock(requests_mutex_);
  requests_.restart = true;
}

void PairProcessor::requestPose(const UncertainTransform& T_odom_base) {
  const std::lock_guard<std::mutex> lock(requests_mutex_);
  requests_.T_odom_base = T_odom_base;
}

void PairProcessor::requestConfig(const VisualOdometry::Config& config) {
  const std::lock_guard<std::mutex> lock(requests_mutex_);
  requests_.config = config;
}

}  // namespace rotrocc
