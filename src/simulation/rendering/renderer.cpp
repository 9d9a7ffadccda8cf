#include "simulation/rendering/renderer.h"

#include <array>
#include <cmath>

#include "simulation/rows.h"

namespace rotrocc {
namespace {

/// Additional samples of a pixel at an edge.
constexpr std::array<std::array<double, 2>, 3> kSamples = {
    {{-0.375, -0.125}, {0.125, -0.375}, {0.25, 0.375}}};

class Rendering {
 public:
  Rendering(const World& world,
            const MovingCars& cars,
            const StereoCamera& camera,
            double cx,
            const Eigen::Isometry3d& T_world_camera)
      : world_(world),
        cars_(cars),
        camera_(camera),
        view_(world.bodies(), cars.bodies, camera, cx, T_world_camera),
        surfaces_(camera.height, camera.width, CV_32SC1) {
    picture_.brightness.create(camera.height, camera.width, CV_32FC1);
    picture_.depth.create(camera.height, camera.width, CV_64FC1);
    picture_.moving_car.create(camera.height, camera.width, CV_32SC1);
  }

  Picture run() {
    forEachRow(camera_.height, [this](int y) { lookAtCentres(y); });
    // Edges are detected in the centre samples, not in the smoothed image of other threads.
    centres_ = picture_.brightness.clone();
    forEachRow(camera_.height, [this](int y) { smoothEdges(y); });
    return picture_;
  }

 private:
  void lookAtCentres(int y) {
    for (int x = 0; x < camera_.width; ++x) {
      const Sighting sighting = world_.look(view_, x, y);
      picture_.brightness.at<float>(y, x) = static_cast<float>(sighting.brightness);
      picture_.depth.at<double>(y, x) = sighting.depth;
      picture_.moving_car.at<int>(y, x) =
          sighting.moving_body < 0 ? -1 : cars_.cars[sighting.moving_body];
      surfaces_.at<int>(y, x) = static_cast<int>(sighting.surface);
    }
  }

  /// Whether a neighbour belongs to another surface of another brightness.
  bool isAtEdge(int x, int y) const {
    constexpr float kContrast = 0.04F;
    const int surface = surfaces_.at<int>(y, x);
    const float brightness = centres_.at<float>(y, x);
    const auto differs = [&](int column, int row) {
      return surfaces_.at<int>(row, column) != surface &&
             std::abs(centres_.at<float>(row, column) - brightness) > kContrast;
    };
    return (x > 0 && differs(x - 1, y)) || (x + 1 < camera_.width && differs(x + 1, y)) ||
           (y > 0 && differs(x, y - 1)) || (y + 1 < camera_.height && differs(x, y + 1));
  }

  void smoothEdges(int y) {
    for (int x = 0; x < camera_.width; ++x) {
      if (!isAtEdge(x, y)) continue;
      double sum = centres_.at<float>(y, x);
      for (const auto& [dx, dy] : kSamples) {
        sum += world_.look(view_, x + dx, y + dy).brightness;
      }
      picture_.brightness.at<float>(y, x) = static_cast<float>(sum / (1.0 + kSamples.size()));
    }
  }

  const World& world_;
  const MovingCars& cars_;
  const StereoCamera& camera_;
  View view_;
  cv::Mat surfaces_;
  cv::Mat centres_;
  Picture picture_;
};

}  // namespace

Picture render(const World& world,
               const MovingCars& cars,
               const StereoCamera& camera,
               double cx,
               const Eigen::Isometry3d& T_world_camera) {
  return Rendering(world, cars, camera, cx, T_world_camera).run();
}

}  // namespace rotrocc
