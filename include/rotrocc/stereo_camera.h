#pragma once

#include <Eigen/Core>

namespace rotrocc {

/// A rectified pinhole stereo camera, as described by the projection matrices P of the two
/// sensor_msgs/CameraInfo (or P0 and P1 of KITTI). Points are in the left camera's optical frame
/// (REP 103: x right, y down, z forward), in meters. The origin of pixel coordinates is the center
/// of the top left pixel.
struct StereoCamera {
  int width = 0;    ///< [px]
  int height = 0;   ///< [px]
  double fx = 0.0;  ///< [px]
  double fy = 0.0;  ///< [px]
  double cx = 0.0;  ///< principal point of the left image [px]
  double cy = 0.0;  ///< principal point of both images [px]
  /// Principal point of the right image [px]; differs from cx if the cameras converge.
  double cx_right = 0.0;
  double baseline_m = 0.0;    ///< distance from the left to the right camera, positive
  double detail_px = 1.0;     ///< side of the smallest detail of its images: the unit of limits
  double window_scale = 1.0;  ///< of windows: detail_px, or less if so large ones have no room

  /// Throws std::invalid_argument that names the first invalid value. Sizes, focal lengths and
  /// baseline must be positive, all values finite, and the disparity at infinity less than the
  /// width.
  void check() const;

  /// Disparity x_left - x_right [px] of a point at infinity.
  double disparityAtInfinity() const { return cx - cx_right; }

  /// Depth [m] of a pixel with disparity x_left - x_right = `disparity_px`. Infinite at the
  /// disparity at infinity, negative below it.
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

  /// Left pixel of a point, whose z must not be zero.
  Eigen::Vector2d project(const Eigen::Vector3d& point) const {
    return {fx * point.x() / point.z() + cx, fy * point.y() / point.z() + cy};
  }

  /// The camera of images that are halved `times` times, keeping every other pixel. With a negative
  /// number they are doubled: pixel k becomes pixel 2k.
  StereoCamera halved(int times) const;

  /// How far another calibration differs: the largest change of the tangent of a viewing direction,
  /// over both images, or the relative change of the baseline if that is more. Infinite if the
  /// images have another size.
  double differenceTo(const StereoCamera& other) const;
};

}  // namespace rotrocc
