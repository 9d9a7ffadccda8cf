#include "node/tf/sensor_mount.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "input/message_conversion.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kMaxNormError = 0.01;
constexpr double kUpright = 45.0 * kDegree;
/// Before a warning: tf takes a moment after startup.
constexpr std::chrono::seconds kPatience(1);
/// A mount that differs less is at rest: joints have noise.
constexpr double kRest_m = 1e-4;
constexpr double kRest_rad = 1e-4;

/// Stamps whose transform was slow after which that is told, and others in a row until it is over.
constexpr int kSlow = 6;
constexpr int kExact = 50;

/// Intervals of the stamps, after which a transform is slow. A wait of two always costs a pair;
/// one interval is that of transforms which are late, but all come.
constexpr double kLongWait = 1.5;

/// Calls in a row with a new transform, after which tf may be faster than the calls.
constexpr int kNew = 5;
static_assert(kNew < kSlow, "what is told must know which it is");

/// The axis of the base closest to a direction.
std::string nameDirection(const Eigen::Vector3d& direction) {
  static const char* const kNames[3][2] = {
      {"+x (forward)", "-x (backward)"}, {"+y (left)", "-y (right)"}, {"+z (up)", "-z (down)"}};
  int axis = 0;
  const double cosine = direction.cwiseAbs().maxCoeff(&axis);
  std::ostringstream text;
  text << kNames[axis][direction[axis] < 0.0 ? 1 : 0];
  const double off_deg = std::acos(std::min(cosine, 1.0)) / kDegree;
  if (off_deg > 0.5) text << ", " << std::lround(off_deg) << " deg off";
  return text.str();
}

}  // namespace

Eigen::Isometry3d toEigen(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  const auto& q = transform.rotation;
  for (const double value : {t.x, t.y, t.z, q.w, q.x, q.y, q.z}) {
    if (std::isfinite(value)) continue;
    throw std::invalid_argument("the transform contains " + toText(value) +
                                ": correct its publisher");
  }
  const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  if (std::abs(rotation.norm() - 1.0) > kMaxNormError) {
    throw std::invalid_argument("the quaternion of the transform has the length " +
                                toText(rotation.norm()) +
                                ", but must have 1: correct its publisher");
  }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(t.x, t.y, t.z);
  T.linear() = rotation.normalized().toRotationMatrix();
  return T;
}

SensorMount::SensorMount(const std::string& base_frame,
                         double timeout_s,
                         TfFeed feed,
                         const std::optional<Log>& log)
    : log_(log),
      base_frame_(base_frame),
      timeout_s_(timeout_s),
      feed_(std::move(feed)),
      buffer_(std::make_unique<tf2::BufferCore>()),
      listener_(feed_(*buffer_)) {}

std::optional<UncertainTransform> SensorMount::find(const std::string& frame,
                                                    std::int64_t stamp_ns) {
  if (frame != frame_) lookFor(frame);
  if (fixed_) return T_base_sensor_;
  const ros::Time stamp = toRosTime(stamp_ns);
  if (stamp < last_stamp_) {  // a time jump: tf refuses what is older than it has
    buffer_->clear();
    latest_ = {};
  }
  if (stamp > last_stamp_) interval_s_ = (stamp - last_stamp_).toSec();
  last_stamp_ = stamp;
  try {
    const UncertainTransform T_base_sensor = lookUp(stamp);
    if (!T_base_sensor_) tellMount(T_base_sensor.T);
    watchMovement(T_base_sensor.T);
    T_base_sensor_ = T_base_sensor;
  } catch (const std::exception& error) {
    if (!T_base_sensor_ || moves_) {
      onMissing(error.what());
      return std::nullopt;
    }
  }
  missing_.clear();
  missing_since_.reset();
  return T_base_sensor_;
}

void SensorMount::lookAgain() {
  listener_.reset();
  buffer_ = std::make_unique<tf2::BufferCore>();  // it never forgets static transforms
  const std::string frame = std::exchange(frame_, "");
  if (!frame.empty()) lookFor(frame);
  previous_frame_.clear();
}

void SensorMount::lookFor(const std::string& frame) {
  previous_frame_ = std::exchange(frame_, frame);
  T_base_sensor_.reset();
  fixed_ = moves_ = false;
  waits_ = true;
  latest_ = {};
  new_in_a_row_ = kNew;
  endTrouble();
  if (!listener_) listener_ = feed_(*buffer_);
}

/// Throws std::exception if tf does not have the mount.
UncertainTransform SensorMount::lookUp(const ros::Time& stamp) {
  if (frame_ == base_frame_) return {fix(Eigen::Isometry3d::Identity())};
  const ros::Time known = latest_;
  geometry_msgs::TransformStamped newest = latest();
  if (newest.header.stamp.isZero()) return {fix(toEigen(newest.transform))};
  watchMovement(toEigen(newest.transform));
  new_in_a_row_ = newest.header.stamp == known ? 0 : new_in_a_row_ + 1;
  const bool comes_in_time = comesInTime(stamp);
  const auto begin = std::chrono::steady_clock::now();
  if (stamp > newest.header.stamp && (moves_ ? comes_in_time : waits_)) {
    waits_ = waitForTransform(*buffer_, base_frame_, frame_, stamp, timeout_s_);
    newest = latest();
  }
  if (buffer_->canTransform(base_frame_, frame_, stamp)) {
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - begin;
    const double long_s = kLongWait * interval_s_;
    if (moves_ && waited.count() > long_s) {
      onSlow(stamp, long_s);
    } else if (++exact_ >= kExact) {
      endTrouble();
    }
    return {toEigen(transformAt(stamp).transform)};
  }
  if (!moves_) return {toEigen(newest.transform)};
  const double ahead_s = (stamp - latest_).toSec();
  if (ahead_s > 0.0 && (!comes_in_time || ahead_s <= timeout_s_)) onSlow(stamp, timeout_s_);
  return extrapolate(stamp);
}

/// The latest transform, whose stamp and distance from the one before are kept.
geometry_msgs::TransformStamped SensorMount::latest() {
  const geometry_msgs::TransformStamped latest = transformAt(ros::Time());
  toEigen(latest.transform);  // throws if it is none
  const ros::Time stamp = latest.header.stamp;
  if (stamp == latest_) return latest;
  const std::optional<double> last_s = std::exchange(step_s_, std::nullopt);
  if (!latest_.isZero() && stamp > latest_) step_s_ = (stamp - latest_).toSec();
  period_s_ = last_s && step_s_ ? std::min(*last_s, *step_s_) : step_s_;
  latest_ = stamp;
  return latest;
}

/// Not if there is a new transform at each call: others may come between them.
bool SensorMount::knowsPeriod() const {
  return new_in_a_row_ < kNew && period_s_;
}

/// Whether the transform of a stamp may come before the timeout. Not if tf is so slow that the next
/// one is due later.
bool SensorMount::comesInTime(const ros::Time& stamp) const {
  return !knowsPeriod() || (latest_ - stamp).toSec() + *period_s_ <= timeout_s_;
}

/// Repeats the motion before the latest transform: that of as much time as there is since then.
/// Throws std::exception if that is more than the timeout, or more than tf has.
UncertainTransform SensorMount::extrapolate(const ros::Time& stamp) const {
  const ros::Duration ahead = stamp - latest_;
  if (ahead.toSec() > timeout_s_ || stamp < latest_) return {toEigen(transformAt(stamp).transform)};
  const Eigen::Isometry3d T_latest = toEigen(transformAt(latest_).transform);
  const Eigen::Isometry3d T_before = toEigen(transformAt(latest_ - ahead).transform);
  const Eigen::Isometry3d T = T_latest * T_before.inverse() * T_latest;
  Vector6d motion;
  motion << T.translation() - T_latest.translation(),
      logRotation(T.linear() * T_latest.linear().transpose());
  return {T, motion * motion.transpose()};
}

Eigen::Isometry3d SensorMount::fix(const Eigen::Isometry3d& T_base_sensor) {
  fixed_ = true;
  // If the frame has changed before, it may change again.
  if (previous_frame_.empty()) listener_.reset();
  return T_base_sensor;
}

void SensorMount::watchMovement(const Eigen::Isometry3d& T_base_sensor) {
  if (!T_base_sensor_ || moves_) return;
  const Eigen::Isometry3d motion = T_base_sensor_first_.inverse() * T_base_sensor;
  moves_ = motion.translation().norm() > kRest_m ||
           Eigen::AngleAxisd(motion.linear()).angle() > kRest_rad;
  if (moves_ && log_) log_->info("camera " + frame_ + " moves on " + base_frame_);
}

/// The first pose in a frame.
void SensorMount::tellMount(const Eigen::Isometry3d& T_base_sensor) {
  T_base_sensor_first_ = T_base_sensor;
  if (!log_) return;
  std::string mount =
      "camera " + frame_ + " in " + base_frame_ + ": " + describeMount(T_base_sensor);
  if (!fixed_) mount += "; each pair waits for its tf: if it is fixed, publish it on /tf_static";
  if (previous_frame_.empty()) {
    log_->info(mount);
  } else if (change_warning_.pass()) {
    log_->warn("the frame_id of the left images changed from " + previous_frame_ + " to " + frame_ +
               "; if that is a fault of the driver, set camera_frame. Now " + mount);
  }
}

void SensorMount::onMissing(const std::string& why) {
  const auto now = std::chrono::steady_clock::now();
  if (!missing_since_) missing_since_ = now;
  missing_ = "no tf from " + base_frame_ + " to " + frame_ + " (camera pose): " + why;
  if (moves_) missing_ += "; raise mount_timeout_s = " + toText(timeout_s_) + " if it comes later";
  if (log_ && now - *missing_since_ > kPatience && warning_.pass()) {
    log_->warn("waiting: " + missing_);
  }
}

/// tf did not have a transform at a stamp within the limit: it comes too seldom, or too late.
void SensorMount::onSlow(const ros::Time& stamp, double limit_s) {
  exact_ = 0;
  if (std::exchange(last_slow_, stamp) != stamp) ++slow_;
  if (!trouble_.empty() || slow_ < kSlow) return;
  const std::string timeout = "mount_timeout_s = " + toText(timeout_s_);
  trouble_ = "tf from " + base_frame_ + " to " + frame_ + ", which moves, comes ";
  if (knowsPeriod() && *period_s_ > limit_s) {
    // Up to half of a period after a transform, pairs are extrapolated; later ones wait.
    const double enough_s = std::ceil(50.0 * *period_s_) / 100.0;
    trouble_ += "at " + fixedText(1.0 / *period_s_, 1) +
                " Hz, too seldom for the images: publish it at their rate" +
                (enough_s > timeout_s_ ? ", or raise " + timeout + " to " + toText(enough_s) : "");
  } else {
    trouble_ += "too late: publish it earlier";
    if (limit_s >= timeout_s_) trouble_ += ", or raise " + timeout;
  }
  trouble_ += ". Until then, pairs wait for it or are extrapolated, for up to " +
              toText(timeout_s_) + " s each; others are dropped";
  if (log_) log_->warn(trouble_);
}

void SensorMount::endTrouble() {
  exact_ = slow_ = 0;
  trouble_.clear();
}

geometry_msgs::TransformStamped SensorMount::transformAt(const ros::Time& stamp) const {
  return buffer_->lookupTransform(base_frame_, frame_, stamp);
}

std::string describeMount(const Eigen::Isometry3d& T_base_camera) {
  const Eigen::Vector3d position = T_base_camera.translation();
  const Eigen::Vector3d view = T_base_camera.linear().col(2);
  const Eigen::Vector3d image_up = -T_base_camera.linear().col(1);
  std::ostringstream text;
  text << std::setprecision(3) << "at " << position.x() << " " << position.y() << " "
       << position.z() << " m, looks along " << nameDirection(view);
  if (std::abs(view.z()) < std::cos(kUpright)) {
    text << ", its image is " << (image_up.z() > std::cos(kUpright) ? "upright" : "not upright");
  } else if (view.z() > 0.0) {
    text << "; is its frame an optical frame, with z forward?";
  }
  return text.str();
}

}  // namespace rotrocc
