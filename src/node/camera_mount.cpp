#include "node/camera_mount.h"

#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "input/to_text.h"

namespace rotrocc {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kMaxNormError = 0.01;
constexpr double kUpright = 45.0 * kDegree;
constexpr int kPatience = 100;  // attempts before a warning: tf takes a moment after startup

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

CameraMount::CameraMount(const std::string& base_frame, Log log)
    : base_frame_(base_frame), log_(std::move(log)) {
  listener_ = std::make_unique<tf2_ros::TransformListener>(buffer_);
}

const std::optional<Eigen::Isometry3d>& CameraMount::find(const std::string& camera_frame) {
  if (T_base_camera_) return T_base_camera_;
  try {
    T_base_camera_ =
        toEigen(buffer_.lookupTransform(base_frame_, camera_frame, ros::Time(0)).transform);
    log_.info("camera " + camera_frame + " in " + base_frame_ + ": " +
              describeMount(*T_base_camera_));
    listener_.reset();
    missing_.clear();
  } catch (const std::exception& error) {
    missing_ =
        "no tf from " + base_frame_ + " to " + camera_frame + " (camera pose): " + error.what();
    if (++attempts_ > kPatience && warning_.pass()) log_.warn("waiting: " + missing_);
  }
  return T_base_camera_;
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
