#include "node/stereo_odometry.h"

#include <pthread.h>

#include <exception>
#include <utility>

#include <ros/init.h>
#include <ros/time.h>

#include "input/message_conversion.h"
#include "input/stereo_pair_converter.h"
#include "node/odometry_messages.h"

namespace rotrocc {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// Period at which the worker checks for shutdown, which may happen without a call of the
/// destructor.
constexpr std::chrono::milliseconds kIdlePoll(100);
/// Period at which a pair is tried again that waits for tf, or for the vertical.
constexpr std::chrono::milliseconds kRetry(10);
/// How long a pair waits for the transform from guess_frame: a period of odometry at 20 Hz.
constexpr double kGuessTimeout_s = 0.05;
/// Period of diagnostics (REP 107).
constexpr double kTick_s = 1.0;

float milliseconds(SteadyClock::duration duration) {
  return std::chrono::duration<float, std::milli>(duration).count();
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
      trajectory_(static_cast<std::size_t>(parameters_.trajectory_length),
                  parameters_.trajectory_file,
                  parameters_.trajectory_format,
                  log_),
      loss_log_(log_),
      silence_(parameters_.silence_s, SteadyClock::now(), log_) {
  if (!parameters_.guess_frame.empty()) {
    guess_.emplace(
        parameters_.guess_frame, parameters_.base_frame, kGuessTimeout_s, listenToTf, log_);
  }
  if (parameters_.use_imu) gyro_.emplace(nh, parameters_, log_);
  input_.emplace(
      nh, parameters_, drops_, [this](ReceivedPair pair) { onPair(std::move(pair)); }, log_);
  if (parameters_.publish_tf) {
    tf_conflict_.emplace(publishedTf(name, parameters_), parameters_.base_frame, log_);
  }
  diagnostics_.emplace(nh, private_nh, name);
  if (gyro_) {
    diagnostics_->add("gyroscope", [this](StatusWrapper& status) { gyro_->describe(status); });
  }
  if (!parameters_.trajectory_file.empty()) {
    diagnostics_->add("trajectory file", [this](StatusWrapper& status) {
      const std::string fault = trajectory_.fault();
      fault.empty() ? status.summary(StatusWrapper::OK, "written")
                    : status.summary(StatusWrapper::ERROR, fault);
    });
  }
  const auto save = [this](const std::string& path, const std::string& format) {
    return trajectory_.save(path, format);
  };
  services_.emplace(private_nh, processor_, health_, save, parameters_.odom_frame, log_);
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

void StereoOdometry::onPair(ReceivedPair pair) {
  const std::int64_t stamp_ns = toNanoseconds(pair.images.left->header.stamp);
  silence_.onPair({stamp_ns, pair.stamp_age_s}, drops_.total(), SteadyClock::now());
  if (health_.paused()) return drops_.count(DropReason::kPaused);
  if (mailbox_.put(std::move(pair))) drops_.count(DropReason::kSuperseded);
}

/// Once a second: diagnostics, a status if there was no pair, and a report of missing input.
void StereoOdometry::onTick(const ros::WallTimerEvent&) {
  try {
    HealthReport report = health_.report(input_->report(), drops_);
    if (tf_conflict_) report.tf_conflict = tf_conflict_->check();
    diagnostics_->publish(report);
    if (!report.answers || report.paused) {
      publisher_.publishStatus(toIdleStatus(report.status, ros::Time::now()));
    }
    for (const std::string& fault : {report.input_fault, report.rig_fault}) {
      if (!fault.empty() && warning_.pass(fault)) log_.warn(fault);
    }
    silence_.onTick(report.input, SteadyClock::now());
  } catch (const std::exception& error) {
    log_.error(std::string("diagnostics: ") + error.what());
  }
}

void StereoOdometry::work() {
  pthread_setname_np(pthread_self(), "odometry");  // for `top -H` and debuggers
  std::optional<ReceivedPair> pair;
  std::optional<DropReason> waits_for;
  while (ros::ok() && !mailbox_.closed()) {
    if (auto newer = mailbox_.take(pair ? kRetry : kIdlePoll)) {
      if (pair) drops_.count(*waits_for);
      pair = std::move(newer);
      pair->taken = SteadyClock::now();
    }
    if (pair) waits_for = tryPair(*pair);
    if (!waits_for) pair.reset();
  }
}

/// Nothing if the pair is done with: processed, or dropped. Otherwise it waits, and a newer one
/// replaces it for that reason: tf lacks the camera pose, or the vertical is not known yet.
std::optional<DropReason> StereoOdometry::tryPair(const ReceivedPair& received) {
  try {
    if (processor_.takeRequests()) {
      mount_.lookAgain();
      if (gyro_) gyro_->lookAgain();
    }
    const sensor_msgs::Image& left = *received.images.left;
    const std::string frame = cameraFrameOf(left, parameters_.camera_frame);
    const std::int64_t stamp_ns = toNanoseconds(left.header.stamp);
    const auto T_base_camera = mount_.find(frame, stamp_ns);
    if (!T_base_camera) {
      health_.setWaitsForTf(mount_.missing());
      return DropReason::kTfMissing;
    }
    if (gyro_) gyro_->follow(stamp_ns, T_base_camera->T);
    if (gyro_ && processor_.startsLevel() && gyro_->waitsForVertical(stamp_ns)) {
      return DropReason::kSuperseded;
    }
    process(received, frame, *T_base_camera);
  } catch (const InputError& error) {
    drops_.add(error);
  } catch (const std::exception& error) {
    drops_.add(InputError(DropReason::kFailed, std::string("internal error: ") + error.what()));
  }
  return std::nullopt;
}

void StereoOdometry::process(const ReceivedPair& received,
                             const std::string& frame,
                             const UncertainTransform& T_base_camera) {
  const SteadyClock::time_point begin = SteadyClock::now();
  const StereoPair pair = processor_.convert(received);
  const SteadyClock::time_point converted = SteadyClock::now();
  PairContext context = {received.camera, T_base_camera};
  context.is_simulated = ros::Time::isSimTime();
  if (guess_) context.T_last_base = guess_->motionTo(pair.stamp_ns);
  if (gyro_) {
    context.measured_rotation = [&](std::int64_t from_ns, std::int64_t to_ns) {
      return gyro_->rotation(from_ns, to_ns);
    };
    context.up = [&] { return gyro_->up(pair.stamp_ns); };
  }
  const PairAnswer answer = processor_.process(pair, context);
  // Before the odometry is sent: who has received it can save its pose.
  trajectory_.add({answer.state.stamp_ns, answer.state.T_first_camera}, answer.starts_trajectory);
  const SteadyClock::time_point ready = SteadyClock::now();
  const SteadyClock::time_point sent = publishMotion(answer);
  OdometryStatus status = toStatus(answer.result, frame);
  status.stamp_age = static_cast<float>(received.stamp_age_s);
  status.time_pairing = milliseconds(received.arrival - received.images.first_arrival);
  status.time_waiting = milliseconds(received.taken - received.arrival);
  status.time_tf = milliseconds(begin - received.taken);
  status.time_conversion = milliseconds(converted - begin);
  status.time_publishing = milliseconds(sent - ready);
  status.time_rest = milliseconds(ready - converted) - status.time_total;
  status.latency = milliseconds(sent - received.arrival);
  followUp(answer, status);
  processor_.prepare();
  publisher_.publishPictures(answer, processor_.odometry(), frame);
}

/// Returns when the odometry was sent.
SteadyClock::time_point StereoOdometry::publishMotion(const PairAnswer& answer) {
  std::optional<Eigen::Isometry3d> T_guess_base;
  if (guess_) T_guess_base = guess_->moveTo(answer.result.stamp_ns, answer.starts_trajectory);
  const bool is_lost = answer.result.state == State::kLost;
  return publisher_.publishMotion(answer.state, is_lost, T_guess_base);
}

/// All that the odometry of the pair need not wait for.
void StereoOdometry::followUp(const PairAnswer& answer, OdometryStatus& status) {
  if (guess_) status.guess_misses = guess_->misses();
  if (gyro_) gyro_->observe(answer.result, status);
  const std::string camera_fault = processor_.inspect(answer);
  std::string tf_trouble = mount_.trouble();
  if (guess_ && !guess_->trouble().empty()) {
    tf_trouble += (tf_trouble.empty() ? "" : "; ") + guess_->trouble();
  }
  status = health_.addAnswer(status, camera_fault, tf_trouble, drops_);
  publisher_.publishStatus(status);
  publisher_.publishPath(answer.state, answer.starts_trajectory);
  loss_log_.observe(status, camera_fault);
}

}  // namespace rotrocc
