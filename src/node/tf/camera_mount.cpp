#include "node/tf/camera_mount.h"

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

CameraMount::CameraMount(const std::string& base_frame, double timeout_s, TfFeed feed, Log log)
    : log_(std::move(log)),
      base_frame_(base_frame),
      timeout_s_(timeout_s),
      feed_(std::move(feed)),
      buffer_(std::make_unique<tf2::BufferCore>()),
      listener_(feed_(*buffer_)) {}

std::optional<Eigen::Isometry3d> CameraMount::find(const std::string& camera_frame,
                                                   std::int64_t stamp_ns) {
  if (camera_frame != camera_frame_) lookFor(camera_frame);
  if (fixed_) return T_base_camera_;
  const ros::Time stamp = toRosTime(stamp_ns);
  if (stamp < last_stamp_) buffer_->clear();  // a time jump: tf refuses what is older than it has
  last_stamp_ = stamp;
  try {
    const Eigen::Isometry3d T = lookUp(stamp);
    if (!T_base_camera_) tellMount(T);
    watchMovement(T);
    T_base_camera_ = T;
  } catch (const std::exception& error) {
    if (!T_base_camera_ || moves_) {
      onMissing(error.what());
      return std::nullopt;
    }
  }
  missing_.clear();
  missing_since_.reset();
  return T_base_camera_;
}

void CameraMount::lookAgain() {
  listener_.reset();
  buffer_ = std::make_unique<tf2::BufferCore>();  // it never forgets static transforms
  const std::string frame = std::exchange(camera_frame_, "");
  if (!frame.empty()) lookFor(frame);
  previous_frame_.clear();
}

void CameraMount::lookFor(const std::string& camera_frame) {
  previous_frame_ = std::exchange(camera_frame_, camera_frame);
  T_base_camera_.reset();
  fixed_ = moves_ = false;
  waits_ = true;
  if (!listener_) listener_ = feed_(*buffer_);
}

/// Throws std::exception if tf does not have the mount.
Eigen::Isometry3d CameraMount::lookUp(const ros::Time& stamp) {
  if (camera_frame_ == base_frame_) return fix(Eigen::Isometry3d::Identity());
  const geometry_msgs::TransformStamped latest = transformAt(ros::Time());
  const Eigen::Isometry3d T_latest = toEigen(latest.transform);
  if (latest.header.stamp.isZero()) return fix(T_latest);
  watchMovement(T_latest);
  if (stamp > latest.header.stamp && (waits_ || moves_)) {
    waits_ = waitForTransform(*buffer_, base_frame_, camera_frame_, stamp, timeout_s_);
  }
  const bool exact = moves_ || buffer_->canTransform(base_frame_, camera_frame_, stamp);
  return exact ? toEigen(transformAt(stamp).transform) : T_latest;
}

Eigen::Isometry3d CameraMount::fix(const Eigen::Isometry3d& T_base_camera) {
  fixed_ = true;
  // If the frame has changed before, it may change again.
  if (previous_frame_.empty()) listener_.reset();
  return T_base_camera;
}

void CameraMount::watchMovement(const Eigen::Isometry3d& T_base_camera) {
  if (!T_base_camera_ || moves_) return;
  const Eigen::Isometry3d motion = T_base_camera_first_.inverse() * T_base_camera;
  moves_ = motion.translation().norm() > kRest_m ||
           Eigen::AngleAxisd(motion.linear()).angle() > kRest_rad;
  if (!moves_) return;
  log_.info("camera " + camera_frame_ + " moves on " + base_frame_);
}

/// The first pose in a frame.
void CameraMount::tellMount(const Eigen::Isometry3d& T_base_camera) {
  T_base_camera_first_ = T_base_camera;
  std::string mount =
      "camera " + camera_frame_ + " in " + base_frame_ + ": " + describeMount(T_base_camera);
  if (!fixed_) mount += "; each pair waits for its tf: if it is fixed, publish it on /tf_static";
  if (previous_frame_.empty()) {
    log_.info(mount);
  } else if (change_warning_.pass()) {
    log_.warn("the frame_id of the left images changed from " + previous_frame_ + " to " +
              camera_frame_ + "; if that is a fault of the driver, set camera_frame. Now " + mount);
  }
}

void CameraMount::onMissing(const std::string& why) {
  const auto now = std::chrono::steady_clock::now();
  if (!missing_since_) missing_since_ = now;
  missing_ = "no tf from " + base_frame_ + " to " + camera_frame_ + " (camera pose): " + why;
  if (moves_) missing_ += "; raise mount_timeout_s = " + toText(timeout_s_) + " if it comes later";
  if (now - *missing_since_ > kPatience && warning_.pass()) {
    log_.warn("waiting: " + missing_);
  }
}

geometry_msgs::TransformStamped CameraMount::transformAt(const ros::Time& stamp) const {
  return buffer_->lookupTransform(base_frame_, camera_frame_, stamp);
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
