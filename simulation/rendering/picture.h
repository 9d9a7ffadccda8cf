#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Where the pixels of a picture look: through places in the image of a pinhole camera.
struct PixelRays {
  StereoCamera pinhole;  ///< its principal point is (cx, cy), whichever camera of a pair it is
  cv::Mat places;  ///< CV_64FC2, in the image of `pinhole`, NaN for pixels that are not needed;
                   ///< empty: each pixel at its own place
  double footprint = 1.0;  ///< width of what a pixel averages over, in pixels of `pinhole`

  cv::Size size() const {
    return places.empty() ? cv::Size(pinhole.width, pinhole.height) : places.size();
  }

  Eigen::Vector2d place(int x, int y) const {
    if (places.empty()) return Eigen::Vector2d(x, y);
    const cv::Vec2d& place = places.at<cv::Vec2d>(y, x);
    return {place[0], place[1]};
  }
};

/// Rays through `places` (CV_64FC2, NaN for pixels that are not needed) in the image of a pinhole
/// camera with these focal lengths and this principal point [px]. The image of the result is
/// shifted and as large as the places need.
PixelRays raysThrough(const cv::Mat& places, double fx, double fy, const Eigen::Vector2d& centre);

/// Image of a camera without faults.
struct Picture {
  cv::Mat brightness;  ///< CV_32FC1, 1 is white, the mean over each pixel
  cv::Mat depth;       ///< CV_64FC1 [m], at the centre of each pixel; infinite for the sky
  cv::Mat moving_car;  ///< CV_32SC1, index of the moving car; -1: none
};

/// How what a camera sees moves from one time to another, in its frames at both: each moving car,
/// and at the end all that stands.
using SeenMotions = std::vector<Eigen::Isometry3d>;

/// Motion of what a pixel shows [px of the pinhole camera]; NaN if it is behind the camera then.
Eigen::Vector2d flowAt(
    int x, int y, const Picture& picture, const PixelRays& rays, const SeenMotions& motions);

/// The brightness of a picture with an exposure time, during which what it shows moves by
/// `motions`: the mean along the path of each pixel. What appears from behind is not seen.
cv::Mat blurred(const Picture& picture, const PixelRays& rays, const SeenMotions& motions);

}  // namespace rotrocc
