#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <visualization_msgs/MarkerArray.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "rotrocc/OdometryStatus.h"

namespace rotrocc {

/// Where a camera must be to have all points in its picture. It always looks in the same direction,
/// down at an angle, so its picture is that of a map which grows.
class WholeView {
 public:
  /// [m]
  void add(const Eigen::Vector3d& point);

  /// The nearest place from which all points are seen, with a margin. Needs a point.
  Eigen::Vector3d position() const;

  /// x is the direction of view, y left and z up in the picture.
  static Eigen::Quaterniond orientation();

 private:
  /// The largest distance of a point beyond a side of the picture, if the camera were at 0.
  double left_ = std::numeric_limits<double>::lowest();
  double right_ = left_, top_ = left_, bottom_ = left_;
};

/// What rviz shows of a trajectory as a whole: the way so far, colored by the state, with widths
/// that stay visible from afar; the truth, if there is one; state and speed in words; and the frame
/// of a camera that sees all of it.
class TrajectoryScene {
 public:
  /// `least_size_m`: what is seen around the start. `view_frame`: of the camera.
  TrajectoryScene(double least_size_m, std::string view_frame)
      : least_size_m_(least_size_m), view_frame_(std::move(view_frame)) {}

  /// A pose has the state of the status with its stamp, whichever comes first.
  void setState(const OdometryStatus& status);
  void setTruth(const nav_msgs::Path& truth) { truth_ = truth; }

  /// The next pose. Restarts if time went back, or the frame is another one.
  void add(const nav_msgs::Odometry& odometry);

  bool empty() const { return way_.empty(); }

  /// In the frame of the poses and, for text, in that of the camera. While the way grows, further
  /// markers follow, and few of the others change.
  visualization_msgs::MarkerArray markers() const;

  /// The frame of the camera.
  geometry_msgs::TransformStamped view() const;

 private:
  struct WayPoint {
    Eigen::Vector3d position;
    std::uint8_t state;
  };

  void keepLast();
  double distance_m() const;
  std::string words() const;
  visualization_msgs::Marker marker(const char* name,
                                    int type,
                                    double size,
                                    const cv::Scalar& bgr) const;

  double least_size_m_;
  std::string view_frame_;
  OdometryStatus status_;
  nav_msgs::Path truth_;
  nav_msgs::Odometry last_;
  std::vector<WayPoint> way_;  // thinned out
  bool keeps_last_ = false;    // the last pose is the end of the way
  double length_m_ = 0.0;
  WholeView view_;
};

}  // namespace rotrocc
