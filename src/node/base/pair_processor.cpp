#include "node/base/pair_processor.h"

#include <utility>

#include "common/to_seconds.h"
#include "input/message_conversion.h"
#include "input/to_text.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

/// Below these a base is at rest: wheels that do not turn still have noise in a simulator.
constexpr double kRest_mps = 0.05;
constexpr double kRest_rps = 0.05;

}  // namespace

PairProcessor::PairProcessor(const Parameters& parameters, Log log)
    : log_(std::move(log)),
      parameters_(parameters.node),
      systematic_error_(parameters.odometry.systematic_error),
      converter_(
          parameters.node.significant_bits, parameters.node.mask, parameters.odometry.threads),
      odometry_(parameters.odometry),
      inspector_(parameters.odometry.correspondence_finder, parameters.node.rectify) {
  if (parameters_.continue_from.empty()) return;
  saved_ = readPoseFile(parameters_.continue_from, parameters_.odom_frame, log_);
  pose_file_.emplace(parameters_.continue_from, parameters_.odom_frame, log_);
}

bool PairProcessor::takeRequests() {
  const std::lock_guard<std::mutex> lock(requests_mutex_);
  const Requests requests = std::exchange(requests_, {});
  taken_.reset |= requests.reset;
  taken_.restart |= requests.restart;
  if (requests.reset || requests.T_odom_base) taken_.T_odom_base = requests.T_odom_base;
  if (requests.config) taken_.config = requests.config;
  return requests.reset;
}

PairAnswer PairProcessor::process(const StereoPair& pair, const PairContext& context) {
  const Requests requests = std::exchange(taken_, {});
  if (requests.config) configure(*requests.config);
  PairAnswer answer;
  answer.pair = pair;
  answer.camera = context.camera;
  answer.starts_trajectory = restartIfNeeded(requests, pair.stamp_ns);
  if (requests.reset || requests.T_odom_base) saved_.reset();
  if (!base_odometry_) begin(context, pair.stamp_ns);
  if (requests.T_odom_base) setPose(*requests.T_odom_base);
  move(context, answer);
  last_stamp_ns_ = pair.stamp_ns;
  // While lost, the one before is kept: its uncertainty will grow over all of the time.
  if (pose_file_ && answer.result.hasMotion()) pose_file_->put(answer.state);
  return answer;
}

/// Whether initial_pose leaves roll and pitch to gravity.
bool PairProcessor::isLevelled() const {
  return !parameters_.planar && parameters_.initial_pose[3] == 0.0 &&
         parameters_.initial_pose[4] == 0.0;
}

/// At the pose that an earlier run has saved, or at the initial one.
void PairProcessor::begin(const PairContext& context, std::int64_t stamp_ns) {
  const std::optional<BaseState> saved = std::exchange(saved_, std::nullopt);
  if (saved && saved->stamp_ns <= stamp_ns) {
    base_odometry_.emplace(parameters_, systematic_error_);
    base_odometry_->continueFrom(*saved);
    log_.info("continues from the pose of " + parameters_.continue_from + ", " +
              toText(toSeconds(stamp_ns - saved->stamp_ns)) + " s before the first pair");
    return;
  }
  if (saved) {
    log_.warn("the pose of " + parameters_.continue_from + " is of " + stampText(saved->stamp_ns) +
              " s, but the first pair of " + stampText(stamp_ns) + " s: starting at initial_pose");
  }
  std::optional<Eigen::Vector3d> up;
  if (context.up && isLevelled()) up = context.up();
  if (up) {
    up = context.T_base_camera.T.linear() * *up;
    log_.info("the first pose is level: up is " + toText(up->x()) + " " + toText(up->y()) + " " +
              toText(up->z()) + " in " + parameters_.base_frame);
  }
  base_odometry_.emplace(parameters_, systematic_error_, up);
}

void PairProcessor::configure(const VisualOdometry::Config& config) {
  odometry_.configure(config);
  converter_.setThreads(config.threads);
  inspector_.configure(config.correspondence_finder);
  systematic_error_ = config.systematic_error;
  if (base_odometry_) base_odometry_->setSystematicError(systematic_error_);
}

/// Returns whether a new trajectory starts.
bool PairProcessor::restartIfNeeded(const Requests& requests, std::int64_t stamp_ns) {
  bool starts_trajectory = requests.reset;
  if (requests.reset || requests.restart) odometry_.reset();
  if (requests.reset) base_odometry_.reset();
  if (last_stamp_ns_ && stamp_ns < *last_stamp_ns_) {  // a looping bag, or a restarted simulation
    restart(
        "time jumped back from " + stampText(*last_stamp_ns_) + " to " + stampText(stamp_ns) + " s",
        "pose_after_time_jump",
        parameters_.pose_after_time_jump);
    starts_trajectory = true;
  }
  const double lost_s = lost_since_ns_ ? toSeconds(stamp_ns - *lost_since_ns_) : 0.0;
  const double limit_s = parameters_.reset_after_lost_s;
  if (lost_since_ns_ && limit_s > 0.0 && lost_s >= limit_s) {
    const bool keep =
        restart("lost for " + toText(lost_s) + " s, reset_after_lost_s = " + toText(limit_s),
                "pose_after_lost",
                parameters_.pose_after_lost);
    starts_trajectory = starts_trajectory || !keep;
  }
  return starts_trajectory;
}

/// At the pose that `parameter`, of value `pose`, says. Returns whether it is kept.
bool PairProcessor::restart(const std::string& why,
                            const std::string& parameter,
                            const std::string& pose) {
  const bool keep = pose == "keep";
  log_.warn(why + ": restarting at " + (keep ? "the last pose" : "initial_pose") + " (" +
            parameter + ")");
  odometry_.reset();
  if (!keep) base_odometry_.reset();
  return keep;
}

/// A pose that is set while lost would be lost again if the next pair were compared with one from
/// before the loss.
void PairProcessor::setPose(const UncertainTransform& T_odom_base) {
  base_odometry_->setPose(T_odom_base);
  if (lost_since_ns_) odometry_.reset();
}

/// Whether the pair is that before, though the base may have moved since. At rest in a simulator
/// the images may be the same, unless another sensor sees a motion.
bool PairProcessor::isFrozen(const StereoPair& pair, const PairContext& context) {
  if (!inspector_.isRepeated(pair)) return false;
  if (!context.is_simulated) return true;
  if (!last_stamp_ns_ || pair.stamp_ns <= *last_stamp_ns_) return false;
  const double passed_s = toSeconds(pair.stamp_ns - *last_stamp_ns_);
  const auto moves = [&](const Eigen::Matrix3d& R) {
    return logRotation(R).norm() > kRest_rps * passed_s;
  };
  if (const auto& T = context.T_last_base) {
    return T->translation().norm() > kRest_mps * passed_s || moves(T->linear());
  }
  const auto R = context.measured_rotation
                     ? context.measured_rotation(*last_stamp_ns_, pair.stamp_ns)
                     : std::nullopt;
  return R && moves(*R);
}

void PairProcessor::move(const PairContext& context, PairAnswer& answer) {
  std::optional<Eigen::Isometry3d> T_known_base, T_known_camera;
  if (context.T_last_base && T_known_last_) {
    T_known_base = *T_known_last_ * *context.T_last_base;
    T_known_camera = T_base_camera_known_.inverse() * *T_known_base * context.T_base_camera.T;
  }
  if (isFrozen(answer.pair, context)) {  // no measurement: the next one is compared with an earlier
    answer.result.stamp_ns = answer.pair.stamp_ns;
    answer.result.reason =
        "both images are those of the pair before: is the camera frozen, or does its driver repeat "
        "images?";
  } else {
    answer.result =
        odometry_.process(answer.pair, context.camera, T_known_camera, context.measured_rotation);
  }
  answer.state = base_odometry_->add(answer.result, context.T_base_camera, context.T_last_base);
  if (answer.result.state == State::kLost) {
    if (!lost_since_ns_) lost_since_ns_ = answer.pair.stamp_ns;
    T_known_last_ = T_known_base;
  } else {
    lost_since_ns_.reset();
    T_known_last_ = Eigen::Isometry3d::Identity();
    T_base_camera_known_ = context.T_base_camera.T;
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
