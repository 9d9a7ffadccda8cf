#include "node/stereo_odometry.h"

#include <pthread.h>

#include <algorithm>
#include <exception>
#include <limits>
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
/// Bounds of the period at which a pair that waits looks whether it still must: a twentieth of the
/// time so far.
constexpr std::chrono::duration<double> kShortestPoll(0.0005);
constexpr std::chrono::duration<double> kLongestPoll(0.01);
constexpr double kUnlimited_s = std::numeric_limits<double>::infinity();
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
      tf_conflict_(parameters_.publish_tf
                       ? std::make_unique<TfConflict>(
                             publishedTf(name, parameters_), parameters_.base_frame, log_)
                       : nullptr),
      tf_([this](const TfReceiver::Event& event, bool is_static) {
        if (tf_conflict_) tf_conflict_->onTf(event, is_static);
      }),
      camera_pose_(tf_.buffer(), parameters_.base_frame, parameters_.transform_timeout_s, log_),
      publisher_(nh, parameters_),
      trajectory_(
          static_cast<std::size_t>(parameters_.trajectory_length),
          parameters_.trajectory_file,
          parameters_.trajectory_format,
          parameters_.trajectory_frame == "base" ? parameters_.base_frame : "the left camera",
          log_),
      loss_log_(log_) {
  if (!parameters_.guess_frame.empty()) {
    const std::string& frame = parameters_.guess_frame;
    const GuessSource source = {"guess_frame " + frame, frame, parameters_.base_frame};
    guess_.emplace(tf_.buffer(), source, log_);
  } else if (!parameters_.guess_topic.empty()) {
    guess_topic_.emplace(nh, parameters_, tf_);
    GuessSource source = {
        "guess_topic " + parameters_.guess_topic, GuessTopic::kGuessFrame, GuessTopic::kBaseFrame};
    source.why_not = [this] { return guess_topic_->whyNot(); };
    guess_.emplace(tf_.buffer(), source, log_);
  }
  if (parameters_.use_imu) gyro_.emplace(nh, tf_.buffer(), parameters_, log_);
  input_.emplace(
      nh, parameters_, drops_, [this](ReceivedPair pair) { onPair(std::move(pair)); }, log_);
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
  if (health_.paused()) return drops_.count(DropReason::kPaused);
  const bool is_together = pair.follows_held;
  if (const std::size_t replaced = mailbox_.put(std::move(pair), is_together)) {
    drops_.count(DropReason::kSuperseded, replaced);
  }
}

/// Once a second: diagnostics, a status if there was no pair, and a report of missing input.
void StereoOdometry::onTick(const ros::WallTimerEvent&) {
  try {
    HealthReport report = health_.report(input_->report(), drops_);
    if (tf_conflict_) report.tf_conflict = tf_conflict_->check();
    diagnostics_->publish(report);
    if (!report.answers || report.paused) {
      publisher_.publishStatus(toIdleStatus(report, ros::Time::now()));
    }
    for (const std::string& fault : {report.input_fault, report.rig_fault}) {
      if (!fault.empty() && warning_.pass(fault)) log_.warn(fault);
    }
  } catch (const std::exception& error) {
    log_.error(std::string("diagnostics: ") + error.what());
  }
}

void StereoOdometry::work() {
  pthread_setname_np(pthread_self(), "odometry");  // for `top -H` and debuggers
  while (isRunning()) {
    auto pair = mailbox_.take(kIdlePoll);
    if (!pair) continue;
    pair->taken = SteadyClock::now();
    try {
      process(*pair);
    } catch (const InputError& error) {
      drops_.add(error);
    } catch (const std::exception& error) {
      drops_.add(InputError(DropReason::kFailed, std::string("internal error: ") + error.what()));
    }
  }
}

/// Throws InputError if the pair is dropped, and the log is to say so.
void StereoOdometry::process(const ReceivedPair& received) {
  const std::optional<Gathered> pair = gather(received);
  if (!pair) return;
  const PairAnswer answer = processor_.process(pair->in);
  // Before the odometry is sent: who has received it can save its pose.
  const bool is_of_base = parameters_.trajectory_frame == "base";
  trajectory_.add({answer.state.stamp_ns,
                   is_of_base ? answer.state.T_odom_base.T : answer.state.T_first_camera},
                  answer.starts_trajectory);
  const Time ready = SteadyClock::now();
  std::optional<Eigen::Isometry3d> T_guess_base;
  if (guess_) T_guess_base = guess_->moveTo(answer.result.stamp_ns);
  const bool is_lost = answer.result.state == State::kLost;
  const Time sent = publisher_.publishMotion(answer.state, is_lost, T_guess_base);
  PairReport known;
  known.result = answer.result;
  OdometryStatus& status = known.status;
  status.header.frame_id = pair->camera_frame;
  status.stamp_age_s = static_cast<float>(received.stamp_age_s);
  status.pairing_ms = milliseconds(received.arrival - received.images.first_arrival);
  status.waiting_ms = milliseconds(received.taken - received.arrival);
  status.conversion_ms = milliseconds(pair->converted - received.taken);
  status.tf_ms = milliseconds(pair->complete - pair->converted);
  status.overhead_ms =
      milliseconds(ready - pair->complete) - static_cast<float>(answer.result.times.total_ms);
  status.publishing_ms = milliseconds(sent - ready);
  status.latency_ms = milliseconds(sent - received.arrival);
  report(pair->in, answer, std::move(known));
  processor_.prepare();
  publisher_.publishPictures(pair->in, answer.result, processor_.odometry(), pair->camera_frame);
}

/// All that is known of a pair; nothing if it is dropped. The only place where a pair waits: for tf
/// and for the gyroscope. One without any pose of the camera in tf, and a first one without the
/// vertical, give way to a newer one.
std::optional<StereoOdometry::Gathered> StereoOdometry::gather(const ReceivedPair& received) {
  const WaitFor wait = [this](double limit_s, const std::function<bool()>& condition) {
    return waitFor(limit_s, condition);
  };
  if (processor_.takeRequests()) {
    camera_pose_.refresh();
    if (gyro_) gyro_->refresh();
  }
  Gathered pair;
  pair.camera_frame = cameraFrameOf(*received.images.left, parameters_.camera_frame);
  PairInput& in = pair.in;
  in.pair = processor_.convert(received);
  pair.converted = SteadyClock::now();
  in.camera = received.camera;
  in.arrival = received.arrival;
  in.before = received.before;
  in.is_simulated = ros::Time::isSimTime();
  const std::int64_t stamp_ns = in.pair.stamp_ns;
  tf_.follow(stamp_ns);
  std::optional<Eigen::Isometry3d> T_base_camera;  // nothing if the camera moves and tf is late
  wait(kUnlimited_s, [&] {
    T_base_camera = camera_pose_.find(pair.camera_frame, stamp_ns, wait);
    const std::string& missing = camera_pose_.missing();
    health_.setWaitsForTf(missing.empty() && !T_base_camera ? camera_pose_.problem() : missing);
    return missing.empty() || mailbox_.hasItem();
  });
  if (!T_base_camera) {
    if (isRunning()) drops_.count(DropReason::kTfMissing);
    return std::nullopt;
  }
  in.T_base_camera = *T_base_camera;
  if (gyro_) {
    bool gives_way = false;
    wait(kUnlimited_s, [&] {
      gyro_->gather(stamp_ns, *T_base_camera, wait);
      gives_way = processor_.startsLevel() && gyro_->waitsForVertical(stamp_ns);
      return !gives_way || mailbox_.hasItem();
    });
    if (gives_way) {
      drops_.count(DropReason::kSuperseded);
      return std::nullopt;
    }
    in.measured_rotation = [this](std::int64_t from_ns, std::int64_t to_ns) {
      return gyro_->rotation(from_ns, to_ns);
    };
    in.up = [this, stamp_ns] { return gyro_->up(stamp_ns); };
  }
  if (guess_) in.T_last_base = guess_->motionTo(stamp_ns, wait);
  if (!isRunning()) return std::nullopt;
  pair.complete = SteadyClock::now();
  return pair;
}

/// All that the odometry of the pair need not wait for.
void StereoOdometry::report(const PairInput& in, const PairAnswer& answer, PairReport report) {
  report.camera_fault = processor_.inspect(in);
  report.tf_problem = camera_pose_.problem();
  if (report.tf_problem.empty()) report.tf_problem = answer.mount_problem;
  if (guess_) {
    const std::string& problem = guess_->problem();
    if (!report.tf_problem.empty() && !problem.empty()) report.tf_problem += "; ";
    report.tf_problem += problem;
    report.status.guess_misses = guess_->misses();
  }
  if (gyro_) gyro_->observe(answer.result, report.status);
  publisher_.publishStatus(toStatus(health_.addPair(report, drops_)));
  publisher_.publishPath(answer.state, answer.starts_trajectory);
  loss_log_.observe(answer.result, report.camera_fault);
}

/// See WaitFor. Ends at once when the odometry does.
bool StereoOdometry::waitFor(double limit_s, const std::function<bool()>& condition) const {
  const Time begin = SteadyClock::now();
  while (!condition()) {
    const std::chrono::duration<double> passed = SteadyClock::now() - begin;
    if (!isRunning() || passed.count() >= limit_s) return false;
    std::this_thread::sleep_for(std::clamp(passed / 20.0, kShortestPoll, kLongestPoll));
  }
  return true;
}

bool StereoOdometry::isRunning() const {
  return ros::ok() && !ros::isShuttingDown() && !mailbox_.closed();
}

}  // namespace rotrocc
