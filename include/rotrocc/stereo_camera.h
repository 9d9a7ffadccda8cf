#pragma once

#include <Eigen/Core>

namespace rotrocc {

/// A rectified pinhole stereo camera: what the projection matrices P of the two
/// sensor_msgs/CameraInfo (or KITTI's P0, P1) say. Points are in the left camera's optical frame
/// (REP 103: x right, y down, z forward), in metres; pixels have their origin at the centre of the
/// top left pixel.
struct StereoCamera {
  int width = 0;          ///< [px]
  int height = 0;         ///< [px]
  double fx = 0.0;        ///< [px]
  double fy = 0.0;        ///< [px]
  double cx = 0.0;        ///< principal point of the left image [px]
  double cy = 0.0;        ///< principal point of both images [px]
  double cx_right = 0.0;  ///< principal point of the right image [px]; differs if the rig is verged
  double baseline_m = 0.0;  ///< distance from the left to the right camera, positive

  /// Throws std::invalid_argument that names the first value no camera can have: sizes, focal
  /// lengths and baseline must be positive, all values finite, and the disparity at infinity less
  /// than the width.
  void check() const;

  /// Disparity x_left - x_right [px] of a point at infinity.
  double disparityAtInfinity() const { return cx - cx_right; }

  /// Depth [m] of a pixel whose disparity x_left - x_right is `disparity_px`; infinite or negative
  /// if that is not more than the disparity at infinity.
  double depth(double disparity_px) const {
    return fx * baseline_m / (disparity_px - disparityAtInfinity());
  }

  /// Disparity x_left - x_right [px] of a point `depth_m` in front of the camera.
  double disparity(double depth_m) const {
    return fx * baseline_m / depth_m + disparityAtInfinity();
  }

  /// Viewing ray of a left pixel, scaled to unit depth (Eq. 3).
  Eigen::Vector3d ray(const Eigen::Vector2d& pixel) const {
    return {(pixel.x() - cx) / fx, (pixel.y() - cy) / fy, 1.0};
  }

  /// Left pixel of a point; the point's z must not be zero.
  Eigen::Vector2d project(const Eigen::Vector3d& point) const {
    return {fx * point.x() / point.z() + cx, fy * point.y() / point.z() + cy};
  }

  bool operator==(const StereoCamera& other) const;
  bool operator!=(const StereoCamera& other) const { return !(*this == other); }
};

}  // namespace rotrocc
