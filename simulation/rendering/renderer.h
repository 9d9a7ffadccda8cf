#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "rotrocc/stereo_camera.h"
#include "simulation/scene/world.h"

namespace rotrocc {

/// Where the pixels of a picture look: through places in the image of a pinhole camera.
struct PixelRays {
  StereoCamera pinhole;  ///< its principal point is (cx, cy), whichever camera of a pair it is
  cv::Mat places;  ///< CV_64FC2, in the image of `pinhole`; empty: each pixel at its own place

  cv::Size size() const {
    return places.empty() ? cv::Size(pinhole.width, pinhole.height) : places.size();
  }

  Eigen::Vector2d place(int x, int y) const {
    if (places.empty()) return Eigen::Vector2d(x, y);
    const cv::Vec2d& place = places.at<cv::Vec2d>(y, x);
    return {place[0], place[1]};
  }
};

struct Picture {
  cv::Mat brightness;  ///< CV_32FC1, 1 is white, the mean over each pixel
  cv::Mat depth;       ///< CV_64FC1 [m], at the center of each pixel; infinite for the sky
};

/// Uses all threads of OpenCV; the result is independent of their number.
Picture render(const World& world,
               const std::vector<Body>& cars,
               const PixelRays& rays,
               const Eigen::Isometry3d& T_world_camera);

}  // namespace rotrocc
