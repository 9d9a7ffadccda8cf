#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "rotrocc/stereo_camera.h"
#include "simulation/drives/traffic.h"
#include "simulation/world/world.h"

namespace rotrocc {

/// Image of a camera without faults.
struct Picture {
  cv::Mat brightness;  ///< CV_32FC1, 1 is white, the mean over each pixel
  cv::Mat depth;       ///< CV_64FC1 [m], at the centre of each pixel; infinite for the sky
  cv::Mat moving_car;  ///< CV_32SC1, index of the moving car; -1: none
};

/// The picture of a pinhole camera with the focal lengths and size of `camera`, the principal point
/// (cx, camera.cy), at a pose in the world. Uses all threads of OpenCV; the result is independent
/// of their number.
Picture render(const World& world,
               const MovingCars& cars,
               const StereoCamera& camera,
               double cx,
               const Eigen::Isometry3d& T_world_camera);

}  // namespace rotrocc
