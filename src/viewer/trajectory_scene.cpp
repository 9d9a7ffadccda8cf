#include "viewer/trajectory_scene.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include <std_msgs/ColorRGBA.h>
#include <tf2_eigen/tf2_eigen.h>
#include <visualization_msgs/Marker.h>
#include <opencv2/core.hpp>

#include "drawing/okabe_ito.h"
#include "input/message_conversion.h"
#include "node/base/base_odometry.h"
#include "node/health/odometry_health.h"
#include "node/odometry_messages.h"

namespace rotrocc {
namespace {

using visualization_msgs::Marker;

// As parts of the distance of the camera.
constexpr double kWayWidth = 0.004, kTruthWidth = 0.009, kStartSize = 0.015, kArrowLength = 0.06,
                 kStep = 0.002;
/// The lines are above the points on the ground, and the estimate above the truth.
constexpr double kWayHeight = 0.015, kTruthHeight = 0.01;
/// Of the text. Nearer to the camera, it would tremble with it.
constexpr double kTextDistance = 0.3, kTextSize = 0.035, kTextHeight = -0.36;
constexpr std::size_t kMostPoints = 20000, kPointsPerMarker = 200;
/// Of the view "Whole path" in rviz/*.rviz.
constexpr double kPitch_rad = 1.05;
/// Sides of the used part of the picture, as tangents: rviz sees 22.5 deg up and down, more to the
/// sides, and text is below.
constexpr double kSide = 0.42, kTop = 0.33, kBottom = 0.28;

const Eigen::Matrix3d kAxes = WholeView::orientation().toRotationMatrix();
const Eigen::Vector3d kForward = kAxes.col(0);
const Eigen::Vector3d kLeft = kAxes.col(1);
const Eigen::Vector3d kUp = kAxes.col(2);

/// Sizes change by this factor at once, so that markers of things that rest stay as they are.
constexpr double kSizeStep = 1.1;

std_msgs::ColorRGBA color(const cv::Scalar& bgr) {
  std_msgs::ColorRGBA rgba;
  rgba.r = static_cast<float>(bgr[2] / 255.0);
  rgba.g = static_cast<float>(bgr[1] / 255.0);
  rgba.b = static_cast<float>(bgr[0] / 255.0);
  rgba.a = 1.0F;
  return rgba;
}

/// The worse, the darker, for those who see no colors.
cv::Scalar colorOf(std::uint8_t state) {
  if (state == OdometryStatus::LOST) return okabe_ito::kBlack;
  if (state == OdometryStatus::DEGRADED) return okabe_ito::kVermillion;
  return okabe_ito::kOrange;
}

/// Other states say why there is none.
bool isOfPair(std::uint8_t state) {
  return state <= OdometryStatus::LOST;
}

/// Whether it has a pose: while_lost may be unknown.
bool isKnown(const nav_msgs::Odometry& odometry) {
  return odometry.pose.covariance[0] != kUnknownVariance;
}

template <class Point>
Eigen::Vector3d toEigen(const Point& point) {
  return {point.x, point.y, point.z};
}

}  // namespace

Eigen::Quaterniond WholeView::orientation() {
  return Eigen::Quaterniond(Eigen::AngleAxisd(kPitch_rad, Eigen::Vector3d::UnitY()));
}

void WholeView::add(const Eigen::Vector3d& point) {
  const double depth = kForward.dot(point);
  left_ = std::max(left_, kLeft.dot(point) - kSide * depth);
  right_ = std::max(right_, -kLeft.dot(point) - kSide * depth);
  top_ = std::max(top_, kUp.dot(point) - kTop * depth);
  bottom_ = std::max(bottom_, -kUp.dot(point) - kBottom * depth);
}

Eigen::Vector3d WholeView::position() const {
  // Far enough back for both pairs of sides, and in the middle between them.
  const double depth =
      std::min(-(left_ + right_) / (2.0 * kSide), -(top_ + bottom_) / (kTop + kBottom));
  const double left = (left_ - right_) / 2.0;
  const double up = (top_ - bottom_ + (kTop - kBottom) * depth) / 2.0;
  return depth * kForward + left * kLeft + up * kUp;
}

void TrajectoryScene::setState(const OdometryStatus& status) {
  status_ = status;
  if (empty() || !isOfPair(status.state)) return;
  if (status.header.stamp == last_.header.stamp) {
    if (keeps_last_) way_.pop_back();
    keepLast();
  } else if (status.state == OdometryStatus::LOST && way_.back().state != status.state) {
    // A pair may have no pose: the way since the last one is that of the loss.
    way_.push_back({toEigen(last_.pose.pose.position), status.state});
    keeps_last_ = false;
  }
}

void TrajectoryScene::add(const nav_msgs::Odometry& odometry) {
  if (!isKnown(odometry)) return;
  const Eigen::Vector3d position = toEigen(odometry.pose.pose.position);
  if (empty() || odometry.header.stamp < last_.header.stamp ||
      odometry.header.frame_id != last_.header.frame_id) {
    way_.clear();
    view_ = WholeView();
    length_m_ = 0.0;
    for (const int side : {-1, 1}) {
      view_.add(position + side * 0.5 * least_size_m_ * Eigen::Vector3d::UnitX());
      view_.add(position + side * 0.5 * least_size_m_ * Eigen::Vector3d::UnitY());
    }
  } else {
    length_m_ += (position - toEigen(last_.pose.pose.position)).norm();
  }
  last_ = odometry;
  view_.add(position);
  keepLast();
}

/// Adds the last pose to the way if it shows something new.
void TrajectoryScene::keepLast() {
  const WayPoint point = {toEigen(last_.pose.pose.position), status_.state};
  keeps_last_ = way_.empty() || way_.back().state != point.state ||
                (way_.back().position - point.position).norm() > kStep * distance_m();
  if (keeps_last_) way_.push_back(point);
  if (way_.size() < kMostPoints) return;
  for (std::size_t i = 0; 2 * i < way_.size(); ++i) way_[i] = way_[2 * i];
  way_.resize((way_.size() + 1) / 2);
  keeps_last_ = false;
}

double TrajectoryScene::distance_m() const {
  return (view_.position() - toEigen(last_.pose.pose.position)).norm();
}

std::string TrajectoryScene::words() const {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << stateName(status_.state);
  if (status_.state < OdometryStatus::LOST)
    text << ",  " << toEigen(last_.twist.twist.linear).norm() << " m/s";
  text << ",  " << std::setprecision(length_m_ < 100.0 ? 1 : 0) << length_m_ << " m";
  if (!status_.reason.empty()) text << '\n' << status_.reason;
  return text.str();
}

Marker TrajectoryScene::marker(const char* name,
                               int type,
                               double size,
                               const cv::Scalar& bgr) const {
  Marker marker;
  marker.header.frame_id = last_.header.frame_id;
  marker.ns = name;
  marker.type = type;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = size;
  marker.color = color(bgr);
  marker.frame_locked = 1;  // with the time 0: drawn where the frame is now
  return marker;
}

visualization_msgs::MarkerArray TrajectoryScene::markers() const {
  visualization_msgs::MarkerArray markers;
  if (empty()) return markers;
  const double distance =
      std::pow(kSizeStep, std::round(std::log(distance_m()) / std::log(kSizeStep)));

  if (truth_.poses.size() > 1) {
    Marker truth = marker("truth", Marker::LINE_STRIP, kTruthWidth * distance, okabe_ito::kSkyBlue);
    truth.header.frame_id = truth_.header.frame_id;
    truth.pose.position.z = kTruthHeight * distance;
    for (const auto& pose : truth_.poses) truth.points.push_back(pose.pose.position);
    markers.markers.push_back(truth);
  }

  Marker start = marker("start", Marker::SPHERE, kStartSize * distance, okabe_ito::kBlack);
  start.pose.position = tf2::toMsg(way_.front().position);
  markers.markers.push_back(start);

  Marker arrow = marker("now", Marker::ARROW, kArrowLength * distance, okabe_ito::kBlack);
  arrow.scale.y = arrow.scale.z = 0.25 * arrow.scale.x;
  arrow.pose = last_.pose.pose;
  arrow.pose.position.z += kWayHeight * distance;
  markers.markers.push_back(arrow);

  const double to_text = kTextDistance * distance;
  Marker text = marker("state", Marker::TEXT_VIEW_FACING, kTextSize * to_text, okabe_ito::kBlack);
  text.header.frame_id = view_frame_;
  text.pose.position.x = to_text;
  text.pose.position.z = kTextHeight * to_text;
  text.text = words();
  markers.markers.push_back(text);

  // In parts, of which only the last one changes while the way grows.
  for (std::size_t begin = 0; begin < way_.size(); begin += kPointsPerMarker) {
    Marker way = marker("estimate", Marker::LINE_STRIP, kWayWidth * distance, okabe_ito::kOrange);
    way.id = static_cast<int>(begin / kPointsPerMarker);
    way.pose.position.z = kWayHeight * distance;
    const auto add = [&way](const Eigen::Vector3d& position, std::uint8_t state) {
      way.points.push_back(tf2::toMsg(position));
      way.colors.push_back(color(colorOf(state)));
    };
    const std::size_t end = std::min(begin + kPointsPerMarker + 1, way_.size());
    for (std::size_t i = begin; i < end; ++i) add(way_[i].position, way_[i].state);
    if (begin + kPointsPerMarker >= way_.size()) {
      add(toEigen(last_.pose.pose.position), status_.state);
    }
    markers.markers.push_back(way);
  }
  return markers;
}

geometry_msgs::TransformStamped TrajectoryScene::view() const {
  Eigen::Isometry3d T_odom_view(WholeView::orientation());
  T_odom_view.translation() = view_.position();
  return toTransform(
      T_odom_view, toNanoseconds(last_.header.stamp), last_.header.frame_id, view_frame_);
}

}  // namespace rotrocc
