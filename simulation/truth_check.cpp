#include "simulation/truth_check.h"

#include <cmath>
#include <vector>

namespace rotrocc {
namespace {

constexpr int kSpacing_px = 4;
constexpr double kOtherSurface_px =
    0.5;  // of disparity: this much nearer or farther is another one

}  // namespace

void checkTruth(Simulator& simulator, int index, const SimulatedFrame& frame, TruthErrors& errors) {
  const StereoCamera& camera = simulator.camera();
  const Eigen::Isometry3d T_now_next = simulator.pose(index).inverse() * simulator.pose(index + 1);
  const Eigen::Isometry3d T_next_now = T_now_next.inverse();
  std::vector<Eigen::Vector2d> pixels, targets;
  std::vector<double> depths;
  for (int y = 0; y < camera.height; y += kSpacing_px) {
    for (int x = 0; x < camera.width; x += kSpacing_px) {
      const Eigen::Vector2d pixel(x, y);
      const double depth = frame.depth.at<double>(y, x);
      const cv::Vec2d& flow = frame.flow.at<cv::Vec2d>(y, x);
      const Eigen::Vector2d target = pixel + Eigen::Vector2d(flow[0], flow[1]);
      const bool inside = target.x() >= 0.0 && target.y() >= 0.0 &&
                          target.x() <= camera.width - 1 && target.y() <= camera.height - 1;
      if (std::isinf(depth) || !inside) continue;  // also not NaN
      const Eigen::Vector3d point = T_next_now * (depth * camera.ray(pixel));
      if ((camera.project(point) - target).norm() > kTruthLimit_px) {
        ++errors.moving;
        continue;
      }
      pixels.push_back(pixel);
      targets.push_back(target);
      depths.push_back(point.z());
    }
  }
  const std::vector<double> seen = simulator.depthsAt(index + 1, targets);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double disparity_error_px = camera.disparity(seen[i]) - camera.disparity(depths[i]);
    if (!(std::abs(disparity_error_px) < kOtherSurface_px)) {
      ++errors.hidden;
      continue;
    }
    const Eigen::Vector3d point = T_now_next * (seen[i] * camera.ray(targets[i]));
    const double error_px = (camera.project(point) - pixels[i]).norm();
    if (error_px > kTruthLimit_px) {
      ++errors.wrong;
      continue;
    }
    ++errors.right;
    errors.sum_px += error_px;
  }
}

}  // namespace rotrocc
