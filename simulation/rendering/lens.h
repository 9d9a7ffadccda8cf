#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The lens of one camera, and how the camera is mounted: what rectification takes out.
struct Lens {
  double k1 = 0.0;  ///< radial distortion: r (1 + k1 r^2 + k2 r^4); rises if 9 k1^2 < 20 k2
  double k2 = 0.0;
  Eigen::Matrix3d R_raw_rectified = Eigen::Matrix3d::Identity();
};

/// The raw image of a camera with a lens, which shows all that its rectified image does. Its focal
/// length is larger by kScale, so that both have about as many pixels.
class RawImage {
 public:
  static constexpr double kScale = 1.15;

  /// The rectified image has the size and focal lengths of `camera`, and the principal point
  /// (cx, camera.cy).
  RawImage(const Lens& lens, const StereoCamera& camera, double cx);

  const cv::Size& size() const { return size_; }

  /// The place in the rectified image of a raw pixel; it may lie outside.
  Eigen::Vector2d rectified(const Eigen::Vector2d& raw) const;

  /// The place in the raw image of a rectified pixel.
  Eigen::Vector2d raw(const Eigen::Vector2d& rectified) const;

  /// CV_8UC1, not 0 for the raw pixels of which the rectified image is made, and those around them.
  cv::Mat needed() const;

  /// The rectified image of a raw one, by bilinear interpolation.
  cv::Mat rectify(const cv::Mat& image) const;

 private:
  Lens lens_;
  Eigen::Vector2d focal_px_;
  Eigen::Vector2d centre_;  // principal point of the rectified image
  Eigen::Vector2d raw_centre_ = Eigen::Vector2d::Zero();
  cv::Size size_;
  cv::Mat map_;  // CV_32FC2: place in the raw image of each rectified pixel
};

}  // namespace rotrocc
