#include "simulation/rendering/renderer.h"

#include <array>
#include <cmath>

#include "simulation/each_row.h"

namespace rotrocc {
namespace {

/// Additional samples of a pixel at an edge.
constexpr std::array<std::array<double, 2>, 3> kSamples = {
    {{-0.375, -0.125}, {0.125, -0.375}, {0.25, 0.375}}};

class Rendering {
 public:
  Rendering(const World& world,
            const std::vector<Body>& cars,
            const PixelRays& rays,
            const Eigen::Isometry3d& T_world_camera)
      : world_(world),
        rays_(rays),
        view_(world.bodies(), cars, rays.pinhole, T_world_camera),
        surfaces_(rays.size(), CV_32SC1),
        picture_{cv::Mat(rays.size(), CV_32FC1), cv::Mat(rays.size(), CV_64FC1)} {}

  Picture run() {
    eachRow(surfaces_.rows, [this](int y) { lookAtCenters(y); });
    // Edges are detected in the center samples, not in the smoothed image of other threads.
    centers_ = picture_.brightness.clone();
    eachRow(surfaces_.rows, [this](int y) { smoothEdges(y); });
    return picture_;
  }

 private:
  void lookAtCenters(int y) {
    for (int x = 0; x < surfaces_.cols; ++x) {
      const Eigen::Vector2d place = rays_.place(x, y);
      const Sighting sighting = world_.look(view_, place.x(), place.y());
      picture_.brightness.at<float>(y, x) = static_cast<float>(sighting.brightness);
      picture_.depth.at<double>(y, x) = sighting.depth;
      surfaces_.at<int>(y, x) = static_cast<int>(sighting.surface);
    }
  }

  /// Whether a neighbor belongs to another surface of another brightness.
  bool isAtEdge(int x, int y) const {
    constexpr float kContrast = 0.04F;
    const int surface = surfaces_.at<int>(y, x);
    const float brightness = centers_.at<float>(y, x);
    const auto differs = [&](int column, int row) {
      return surfaces_.at<int>(row, column) != surface &&
             std::abs(centers_.at<float>(row, column) - brightness) > kContrast;
    };
    return (x > 0 && differs(x - 1, y)) || (x + 1 < surfaces_.cols && differs(x + 1, y)) ||
           (y > 0 && differs(x, y - 1)) || (y + 1 < surfaces_.rows && differs(x, y + 1));
  }

  void smoothEdges(int y) {
    for (int x = 0; x < surfaces_.cols; ++x) {
      if (!isAtEdge(x, y)) continue;
      const Eigen::Vector2d place = rays_.place(x, y);
      double sum = centers_.at<float>(y, x);
      for (const auto& [dx, dy] : kSamples) {
        sum += world_.look(view_, place.x() + dx, place.y() + dy).brightness;
      }
      picture_.brightness.at<float>(y, x) = static_cast<float>(sum / (1.0 + kSamples.size()));
    }
  }

  const World& world_;
  const PixelRays& rays_;
  View view_;
  cv::Mat surfaces_;
  cv::Mat centers_;
  Picture picture_;
};

}  // namespace

Picture render(const World& world,
               const std::vector<Body>& cars,
               const PixelRays& rays,
               const Eigen::Isometry3d& T_world_camera) {
  return Rendering(world, cars, rays, T_world_camera).run();
}

}  // namespace rotrocc
