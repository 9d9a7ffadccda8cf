#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "rectification/distortion.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// One camera of a stereo pair as it takes its images, and how these are rectified: what K, D and R
/// of sensor_msgs/CameraInfo describe.
struct RawCamera {
  int width = 0;  ///< [px]
  int height = 0;
  double fx = 0.0;  ///< [px]
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
  Distortion distortion;
  Eigen::Matrix3d R_rectified_raw = Eigen::Matrix3d::Identity();

  /// Throws std::invalid_argument that names the first value that is not finite or not positive, a
  /// side of more than 32000 px, or a matrix that is no rotation.
  void check() const;

  /// Pixels of points in the frame of the raw camera, whose z must be positive.
  std::vector<cv::Point2d> project(const std::vector<Eigen::Vector3d>& points) const;

  /// Viewing rays of pixels in the frame of the raw camera, of unit depth.
  std::vector<Eigen::Vector3d> rays(std::vector<cv::Point2d> pixels) const;
};

/// A stereo camera before and after rectification.
struct StereoCalibration {
  RawCamera left;
  RawCamera right;
  StereoCamera rectified;

  /// Whether the images of both cameras, or the left ones, are rectified as they are taken.
  bool isRectified() const;
  bool isLeftRectified() const;
};

/// Of images that are rectified already.
StereoCalibration rectifiedCalibration(const StereoCamera& camera);

/// Chooses the rectification of two cameras: each is turned by half of the angle between them and
/// towards the other (Bouguet's method). The rectified images have the size of the raw ones. They
/// show as much as fits without pixels that a camera does not see, but have at least 0.7 times the
/// focal length of the raw images, so that those of a wide lens do not get coarse in the middle.
/// Throws std::invalid_argument if the sizes differ, or if the right camera is not beside the left
/// one, on its right, and looking the same way.
StereoCalibration chooseRectification(const RawCamera& left,
                                      const RawCamera& right,
                                      const Eigen::Isometry3d& T_left_right);

}  // namespace rotrocc
