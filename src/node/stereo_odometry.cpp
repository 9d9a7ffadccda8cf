#include "node/stereo_odometry.h"

#include <pthread.h>

#include <exception>
#include <utility>

#include <ros/init.h>
#include <ros/time.h>

#include "input/image_validation.h"
#include "input/message_conversion.h"
#include "node/odometry_messages.h"

namespace rotrocc {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// Period at which the worker checks for shutdown, which may happen without a call of the
/// destructor.
constexpr std::chrono::milliseconds kIdlePoll(100);
/// Period of tf lookups while a pair waits for tf.
constexpr std::chrono::milliseconds kTfPoll(10);
/// Period of diagnostics (REP 107).
constexpr double kTick_s = 1.0;

double milliseconds(SteadyClock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

}  // namespace

StereoOdometry::StereoOdometry(ros::NodeHandle& nh,
                               ros::NodeHandle& private_nh,
                               const std::string& name,
                               const Parameters& parameters)
    : log_(name),
      parameters_(parameters.node),
      drops_(log_),
      processor_(parameters, log_),
      mount_(parameters_.base_frame, parameters_.mount_timeout_s, listenToTf, log_),
      publisher_(nh, parameters_),
      trajectory_(static_cast<std::size_t>(parameters_.trajectory_length)),
      silence_(parameters_.silence_s, SteadyClock::now()) {
  if (!parameters_.trajectory_file.empty()) {
    trajectory_recorder_.emplace(parameters_.trajectory_file, parameters_.trajectory_format, log_);
  }
  if (!parameters_.guess_frame.empty()) {
    guess_.emplace(parameters_.guess_frame,
                   parameters_.base_frame,
                   parameters_.guess_timeout_s,
                   listenToTf,
                   log_);
  }
  if (parameters_.use_imu) gyro_.emplace(nh, parameters_.imu_timeout_s, log_);
  input_.emplace(
      nh, parameters_, drops_, [this](ReceivedPair pair) { onPair(std::move(pair)); }, log_);
  if (parameters_.publish_tf) {
    tf_conflict_.emplace(publishedTf(name, parameters_), parameters_.base_frame, log_);
  }
  diagnostics_.emplace(nh, private_nh, name);
  if (gyro_) diagnostics_->addGyro();
  services_.emplace(private_nh, makeActions(), log_);
  live_parameters_.emplace(
      private_nh,
      parameters,
      [this](const VisualOdometry::Config& config) { processor_.requestConfig(config); },
      log_);
  if (ros::isShuttingDown()) return;  // some publishers do not exist then
  ticker_ = nh.createWallTimer(ros::WallDuration(kTick_s), &StereoOdometry::onTick, this);
  worker_ = std::thread(&StereoOdometry::work, this);  // last: nothing may fail after it
}

StereoOdometry::~StereoOdometry() {
  mailbox_.close();
  if (worker_.joinable()) worker_.join();
}

OdometryServices::Actions StereoOdometry::makeActions() {
  OdometryServices::Actions actions;
  actions.reset = [this] { processor_.requestReset(); };
  actions.set_pose = [this](const geometry_msgs::PoseWithCovarianceStamped& pose) {
    processor_.requestPose(toPose(pose, parameters_.odom_frame));
  };
  actions.pause = [this](bool paused) { onPause(paused); };
  actions.save_trajectory = [this](const std::string& path, const std::string& format) {
    return trajectory_.save(path, format);
  };
  return actions;
}

void StereoOdometry::onPair(ReceivedPair pair) {
  const std::string said = silence_.onPair(SteadyClock::now());
  if (!said.empty()) log_.warn(said);
  if (health_.paused()) return drops_.count(DropReason::kPaused);
  if (mailbox_.put(std::move(pair))) drops_.count(DropReason::kSuperseded);
}

void StereoOdometry::onPause(bool paused) {
  if (health_.paused() && !paused) processor_.requestRestart();
  health_.setPaused(paused);
}

/// Once a second: diagnostics, a status if there was no pair, and a report of missing input.
void StereoOdometry::onTick(const ros::WallTimerEvent&) {
  try {
    const SteadyClock::time_point now = SteadyClock::now();
    const InputReport input = input_->report();
    const std::string fault = faultOfPairs(input);
    health_.setInputFault(fault);
    if (!fault.empty() && input_warning_.pass()) log_.warn(fault);
    if (tf_conflict_) health_.setTfConflict(tf_conflict_->description());
    const HealthReport report = health_.report(input, drops_);
    diagnostics_->publish(report);
    if (!report.answers || report.paused) {
      publisher_.publishStatus(toIdleStatus(report, ros::Time::now()));
    }
    const std::string said = silence_.onTick(input, now);
    if (!said.empty()) log_.warn(said);
  } catch (const std::exception& error) {
    log_.error(std::string("diagnostics: ") + error.what());
  }
}

void StereoOdometry::work() {
  pthread_setname_np(pthread_self(), "odometry");  // for `top -H` and debuggers
  std::optional<ReceivedPair> pair;
  while (ros::ok() && !mailbox_.closed()) {
    if (auto newer = mailbox_.take(pair ? kTfPoll : kIdlePoll)) {
      if (pair) drops_.count(DropReason::kTfMissing);
      pair = std::move(newer);
    }
    if (pair && tryPair(*pair)) pair.reset();
  }
}

/// Whether the pair is done with: processed, or dropped. Otherwise tf lacks the camera pose.
bool StereoOdometry::tryPair(const ReceivedPair& received) {
  try {
    const sensor_msgs::Image& left = *received.images.left;
    const auto T_base_camera = mount_.find(cameraFrameOf(left, parameters_.camera_frame),
                                           toNanoseconds(left.header.stamp));
    if (!T_base_camera) {
      health_.setWaitsForTf(mount_.missing());
      return false;
    }
    process(received, *T_base_camera);
  } catch (const InputError& error) {
    drops_.add(error);
  } catch (const std::exception& error) {
    drops_.add(InputError(DropReason::kFailed, std::string("internal error: ") + error.what()));
  }
  return true;
}

void StereoOdometry::process(const ReceivedPair& received, const Eigen::Isometry3d& T_base_camera) {
  PairTimes times;
  times.pairing_ms = milliseconds(received.arrival - received.images.first_arrival);
  times.waiting_ms = milliseconds(SteadyClock::now() - received.arrival);
  const PairAnswer answer = estimate(received, T_base_camera);
  times.conversion_ms = answer.conversion_ms;
  keepPose(answer);
  const SteadyClock::time_point ready = SteadyClock::now();
  const SteadyClock::time_point sent = publishMotion(answer);
  times.publishing_ms = milliseconds(sent - ready);
  times.latency_ms = milliseconds(sent - received.arrival);
  followUp(answer, received, times);
  processor_.prepare();
}

PairAnswer StereoOdometry::estimate(const ReceivedPair& received,
                                    const Eigen::Isometry3d& T_base_camera) {
  PairProcessor::MotionSource expected;
  if (guess_) {
    expected = [this](std::int64_t prev_ns, std::int64_t cur_ns) {
      return guess_->motion(prev_ns, cur_ns);
    };
  }
  RotationSource rotation;
  if (gyro_) {
    rotation = [&](std::int64_t from_ns, std::int64_t to_ns) {
      return gyro_->rotation(
          cameraFrameOf(*received.images.left, parameters_.camera_frame), from_ns, to_ns);
    };
  }
  return processor_.process(received, T_base_camera, expected, rotation);
}

/// Returns when the odometry was sent.
SteadyClock::time_point StereoOdometry::publishMotion(const PairAnswer& answer) {
  std::optional<Eigen::Isometry3d> T_guess_base;
  if (guess_) {
    if (answer.starts_trajectory) guess_->clear();
    T_guess_base = guess_->pose(answer.result.stamp_ns);
  }
  return publisher_.publishMotion(answer.state, T_guess_base);
}

/// All that the odometry of the pair need not wait for.
void StereoOdometry::followUp(const PairAnswer& answer,
                              const ReceivedPair& received,
                              const PairTimes& times) {
  if (guess_) health_.setGuess(guess_->trouble(), guess_->misses());
  if (gyro_) {
    gyro_->observe(answer.result);
    health_.setGyro(gyro_->report());
  }
  const std::string hint = processor_.inspect(answer, received.camera);
  health_.addAnswer(answer.result, hint, times.latency_ms);
  const std::string camera_frame = cameraFrameOf(*received.images.left, parameters_.camera_frame);
  publisher_.publishStatus(toStatus(answer.result, health_.counts(drops_), times, camera_frame));
  writePose(answer);
  logState(answer.result, hint);
  publisher_.publishPictures(
      answer.pair.left, received.camera, processor_.odometry(), answer.result, camera_frame);
}

/// For ~save_trajectory. Before the odometry is sent: who has received it can save its pose.
void StereoOdometry::keepPose(const PairAnswer& answer) {
  if (answer.starts_trajectory) trajectory_.clear();
  trajectory_.add({answer.state.stamp_ns, answer.state.T_first_camera});
}

/// Into trajectory_file and the path.
void StereoOdometry::writePose(const PairAnswer& answer) {
  if (answer.starts_trajectory) {
    if (trajectory_recorder_) trajectory_recorder_->beginNew();
    publisher_.forgetPath();
  }
  if (trajectory_recorder_) {
    trajectory_recorder_->add({answer.state.stamp_ns, answer.state.T_first_camera});
  }
  publisher_.publishPath(answer.state);
}

void StereoOdometry::logState(const OdometryResult& result, const std::string& hint) {
  const State before = std::exchange(last_state_, result.state);
  if (result.state == State::kLost) {
    if (lost_warning_.pass()) log_.warn("lost: " + result.reason);
  } else if (before == State::kLost) {
    log_.info(std::string("no longer lost: ") + toString(result.state));
  }
  if (!hint.empty() && hint_warning_.pass()) log_.warn(hint);
  const std::string rig = rigWarning(result);
  if (!rig.empty() && rig_warning_.pass()) log_.warn(rig);
}

}  // namespace rotrocc
