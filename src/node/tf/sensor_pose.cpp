#include "node/tf/sensor_pose.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

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

/// Stamps in a row that must have a transform in time until a problem is over.
constexpr int kInTime = 50;
/// Transforms for each pair of images: a rate that is equal may be measured as less.
constexpr double kSeldom = 0.9;

bool differs(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Eigen::Isometry3d motion = a.inverse() * b;
  return motion.translation().norm() > kRest_m ||
         Eigen::AngleAxisd(motion.linear()).angle() > kRest_rad;
}

/// "20 deg down", where `positive` and `negative` name the sides; empty for less than half a
/// degree.
std::string nameAngle(double angle_rad, const char* positive, const char* negative) {
  const long angle_deg = std::lround(angle_rad / kDegree);
  if (angle_deg == 0) return "";
  if (std::abs(angle_deg) == 180) return "180 deg";
  return toText(std::abs(angle_deg)) + " deg " + (angle_deg > 0 ? positive : negative);
}

std::string listed(const std::string& a, const std::string& b) {
  return a + (a.empty() || b.empty() ? "" : " and ") + b;
}

/// The axis of the base closest to a direction.
std::string nameDirection(const Eigen::Vector3d& direction) {
  static const char* const kNames[3][2] = {
      {"+x (forward)", "-x (backward)"}, {"+y (left)", "-y (right)"}, {"+z (up)", "-z (down)"}};
  int axis = 0;
  const double cosine = direction.cwiseAbs().maxCoeff(&axis);
  std::ostringstream text;
  text << kNames[axis][direction[axis] < 0.0 ? 1 : 0];
  const double off_rad = std::acos(std::min(cosine, 1.0));
  std::string off = nameAngle(off_rad, "off", "");
  if (axis < 2) {
    const double side =
        direction[1 - axis] * (axis == 0 ? 1.0 : -1.0) * (direction[axis] < 0.0 ? -1.0 : 1.0);
    off = listed(
        nameAngle(std::asin(std::clamp(direction.z(), -1.0, 1.0)), "up", "down"),
        nameAngle(std::atan2(side, std::abs(direction[axis])), "to the left", "to the right"));
  }
  if (!off.empty()) text << ", " << off;
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

SensorPose::SensorPose(const tf2::BufferCore& tf,
                       const std::string& base_frame,
                       double timeout_s,
                       const std::optional<Log>& log)
    : tf_(tf), log_(log), base_frame_(base_frame), timeout_s_(timeout_s) {}

std::optional<Eigen::Isometry3d> SensorPose::find(const std::string& frame,
                                                  std::int64_t stamp_ns,
                                                  const WaitFor& wait) {
  if (frame != frame_) lookFor(frame);
  if (fixed_) {
    watchFixed();
    return T_base_sensor_;
  }
  std::optional<Eigen::Isometry3d> T_base_sensor;
  try {
    T_base_sensor = lookUp(toRosTime(stamp_ns), wait);
  } catch (const std::exception& error) {
    if (!T_base_sensor_ || moves_) {
      const auto now = std::chrono::steady_clock::now();
      if (!missing_since_) missing_since_ = now;
      missing_ = "no tf from " + base_frame_ + " to " + frame_ + " (camera pose): " + error.what();
      if (log_ && now - *missing_since_ > kPatience && warning_.pass()) {
        log_->warn("waiting: " + missing_);
      }
      return std::nullopt;
    }
    T_base_sensor = T_base_sensor_;
  }
  missing_.clear();
  missing_since_.reset();
  if (!T_base_sensor) return std::nullopt;
  if (!T_base_sensor_) logPose(*T_base_sensor);
  watchMovement(*T_base_sensor);
  return T_base_sensor_ = T_base_sensor;
}

void SensorPose::refresh() {
  if (!frame_.empty()) lookFor(frame_);
  previous_frame_.clear();
}

void SensorPose::lookFor(const std::string& frame) {
  previous_frame_ = std::exchange(frame_, frame);
  T_base_sensor_.reset();
  fixed_ = moves_ = false;
  waits_ = true;
  in_time_ = 0;
  problem_.clear();
}

/// Nothing if it moves, and the transform does not come in time. Throws std::exception if tf has
/// none.
std::optional<Eigen::Isometry3d> SensorPose::lookUp(const ros::Time& stamp, const WaitFor& wait) {
  if (frame_ == base_frame_) {
    fixed_ = true;
    return Eigen::Isometry3d::Identity();
  }
  geometry_msgs::TransformStamped newest = transformAt(ros::Time());
  const Eigen::Isometry3d T_newest = toEigen(newest.transform);
  fixed_ = newest.header.stamp.isZero();
  if (fixed_) return T_newest;
  watchMovement(T_newest);
  const auto is_there = [&] { return tf_.canTransform(base_frame_, frame_, stamp); };
  const ros::Time before = std::exchange(last_stamp_, stamp);
  if (stamp != before) period_s_ = std::abs(stamp.toSec() - before.toSec());
  std::chrono::duration<double> waited{0.0};
  if (stamp > newest.header.stamp && (moves_ || waits_)) {
    const auto begin = std::chrono::steady_clock::now();
    waits_ = wait(timeout_s_, is_there);
    waited = std::chrono::steady_clock::now() - begin;
    newest = transformAt(ros::Time());
    watchMovement(toEigen(newest.transform));
  }
  const bool comes = is_there();
  if (!comes && !moves_) return toEigen(newest.transform);
  if (!comes && stamp <= newest.header.stamp) transformAt(stamp);  // throws: it is too old
  if (moves_ && (!comes || waited.count() > period_s_)) {
    // A wait that is longer than the period of the images loses pairs, too.
    in_time_ = 0;
    // At most once a second: it reads the whole tree of tf.
    if (description_.pass()) problem_ = describeLate(comes);
    if (log_ && late_warning_.pass()) log_->warn(problem_);
  } else if (++in_time_ >= kInTime) {
    problem_.clear();
  }
  if (!comes) return std::nullopt;
  return toEigen(transformAt(stamp).transform);
}

geometry_msgs::TransformStamped SensorPose::transformAt(const ros::Time& stamp) const {
  return tf_.lookupTransform(base_frame_, frame_, stamp);
}

void SensorPose::watchMovement(const Eigen::Isometry3d& T_base_sensor) {
  if (!T_base_sensor_ || moves_) return;
  moves_ = differs(T_base_sensor_first_, T_base_sensor);
  if (moves_ && log_) log_->info("camera " + frame_ + " moves on " + base_frame_);
}

/// Whether /tf_static still says what it said.
void SensorPose::watchFixed() {
  if (frame_ == base_frame_) return;
  try {
    const Eigen::Isometry3d T_newest = toEigen(transformAt(ros::Time()).transform);
    if (!differs(*T_base_sensor_, T_newest)) return problem_.clear();
    if (!problem_.empty()) return;
    problem_ = "another static tf of the camera " + frame_ + " arrived, which is not used yet (" +
               describeCameraPose(T_newest) + "): call reset to use it";
    if (log_) log_->warn(problem_);
  } catch (const std::exception&) {
    return;  // it stays what it was
  }
}

/// The first one in a frame.
void SensorPose::logPose(const Eigen::Isometry3d& T_base_sensor) {
  T_base_sensor_first_ = T_base_sensor;
  if (!log_) return;
  std::string pose =
      "camera " + frame_ + " in " + base_frame_ + ": " + describeCameraPose(T_base_sensor);
  if (!fixed_)
    pose += "; each pair waits for its tf: if the mount is fixed, publish it on /tf_static";
  if (previous_frame_.empty()) {
    log_->info(pose);
  } else if (change_warning_.pass()) {
    log_->warn("the left images' frame_id changed from " + previous_frame_ + " to " + frame_ +
               "; if this is a driver bug, set camera_frame. Now " + pose);
  }
}

std::string SensorPose::describeLate(bool comes) const {
  const std::optional<double> rate = rate_hz();
  std::string text =
      "tf from " + base_frame_ + " to " + frame_ + ", which moves, arrives" +
      (rate ? " at " + fixedText(*rate, 1) + " Hz and" : "") +
      (comes ? " later than the next images, so pairs are dropped"
             : " more than transform_timeout_s = " + toText(timeout_s_) + " s after the images") +
      ": publish it " +
      (rate && *rate * period_s_ < kSeldom ? "at the rate of the images" : "earlier");
  if (comes) return text;
  return text + ", or raise transform_timeout_s" +
         (rate && *rate * timeout_s_ < 1.0 ? " to " + hundredths(1.1 / *rate) : "");
}

/// Of the slowest transform on the way from the base to the sensor, while tf has it; none if that
/// cannot be told.
std::optional<double> SensorPose::rate_hz() const {
  std::optional<double> slowest_hz;
  try {
    std::vector<std::string> frames;
    tf_._chainAsVector(base_frame_, ros::Time(), frame_, ros::Time(), base_frame_, frames);
    const YAML::Node tree = YAML::Load(tf_.allFramesAsYAML());
    for (const std::string& frame : frames) {
      if (!tree[frame]) continue;  // the root
      const auto length_s = tree[frame]["buffer_length"].as<double>();
      if (length_s <= 0.0) continue;  // static
      const double hz = tree[frame]["rate"].as<double>() - 1.0 / length_s;
      slowest_hz = std::min(hz, slowest_hz.value_or(hz));
    }
  } catch (const std::exception&) {
    return std::nullopt;  // a name that YAML does not have
  }
  return slowest_hz;
}

std::string describeCameraPose(const Eigen::Isometry3d& T_base_camera) {
  const Eigen::Vector3d position = T_base_camera.translation();
  const Eigen::Vector3d view = T_base_camera.linear().col(2);
  const Eigen::Vector3d image_up = -T_base_camera.linear().col(1);
  std::ostringstream text;
  text << std::setprecision(3) << "at " << position.x() << " " << position.y() << " "
       << position.z() << " m, looks along " << nameDirection(view);
  if (std::abs(view.z()) < std::cos(kUpright)) {
    text << ", its image is " << (image_up.z() > std::cos(kUpright) ? "upright" : "not upright");
    const Eigen::Vector3d image_right = T_base_camera.linear().col(0);
    const std::string roll =
        nameAngle(std::atan2(image_right.z(), image_up.z()), "counterclockwise", "clockwise");
    if (!roll.empty()) text << ", the camera rolled by " << roll;
  } else if (view.z() > 0.0) {
    text << "; is its frame an optical frame, with z forward?";
  }
  return text.str();
}

}  // namespace rotrocc
