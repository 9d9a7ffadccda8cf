#include "simulation/rendering/rain.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <opencv2/imgproc.hpp>

#include "simulation/counter_random.h"
#include "simulation/rows.h"
#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

constexpr double kLargestDrop = 0.03;  // radius, as a share of the width of the image
constexpr double kSmallestDrop = 0.006;
constexpr double kNearestStreak_m = 0.5;
constexpr double kFarthestStreak_m = 6.0;

void requireRange(const std::string& name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(name + " is " + std::to_string(value) + ": choose it from " +
                              std::to_string(low) + " to " + std::to_string(high));
}

/// A picture of what is around each place, a quarter as large.
cv::Mat surroundings(const cv::Mat& light) {
  cv::Mat small;
  cv::resize(light, small, cv::Size(), 0.25, 0.25, cv::INTER_AREA);
  cv::GaussianBlur(small, small, cv::Size(), 0.01 * small.cols);
  return small;
}

/// What a drop shows at an offset of its centre.
double refracted(const cv::Mat& around, const LensDrop& drop, const Eigen::Vector2d& offset) {
  constexpr double kSmaller = 6.0;
  constexpr double kRim = 0.5;  // light lost there
  const Eigen::Vector2d place = 0.25 * (drop.centre - kSmaller * offset);
  const int x = std::clamp(static_cast<int>(place.x()), 0, around.cols - 1);
  const int y = std::clamp(static_cast<int>(place.y()), 0, around.rows - 1);
  const double away = offset.squaredNorm() / (drop.radius * drop.radius);
  return around.at<float>(y, x) * (1.0 - kRim * std::min(away * away, 1.0));
}

/// Adds a streak to the shares of the light that falling drops replace, in the pinhole image.
void draw(const Streak& streak, const StereoCamera& pinhole, cv::Mat& shares) {
  if (streak.from.z() < kNearestStreak_m || streak.to.z() < kNearestStreak_m) return;
  const Eigen::Vector2d from = pinhole.project(streak.from);
  const Eigen::Vector2d way = pinhole.project(streak.to) - from;
  const double width = pinhole.fx * streak.diameter_m / streak.from.z();
  const double half = std::max(0.5 * width, 0.5);
  // A drop is before a pixel for a part of the exposure, and only a part of a wider line.
  const double share = std::min(1.0, width / std::max(way.norm(), 1e-9)) * 0.5 * width / half;
  const Eigen::Vector2d low = from.cwiseMin(from + way) - Eigen::Vector2d::Constant(half + 1.0);
  const Eigen::Vector2d high = from.cwiseMax(from + way) + Eigen::Vector2d::Constant(half + 1.0);
  const int last_x = std::min(static_cast<int>(high.x()), shares.cols - 1);
  const int last_y = std::min(static_cast<int>(high.y()), shares.rows - 1);
  for (int y = std::max(static_cast<int>(low.y()), 0); y <= last_y; ++y) {
    for (int x = std::max(static_cast<int>(low.x()), 0); x <= last_x; ++x) {
      const Eigen::Vector2d offset = Eigen::Vector2d(x, y) - from;
      const double along =
          std::clamp(offset.dot(way) / std::max(way.squaredNorm(), 1e-9), 0.0, 1.0);
      const double inside = std::clamp(half + 0.5 - (offset - along * way).norm(), 0.0, 1.0);
      float& old = shares.at<float>(y, x);
      old += (1.0F - old) * static_cast<float>(share * inside);
    }
  }
}

}  // namespace

void Rain::check() const {
  requireRange("number of drops", drops, 0.0, 1e4);
  requireRange("number of streaks", streaks, 0.0, 1e6);
  requireRange("time between wipes [s]", wiped_every_s, 0.1, 1e6);
}

double LensDrop::distance(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d offset = pixel - centre;
  const double away = offset.norm() / radius;
  if (away > 1.3) return away;
  const double angle = std::atan2(offset.y(), offset.x());
  return away / (1.0 + 0.12 * std::sin(2.0 * angle + phase_rad) +
                 0.07 * std::sin(3.0 * angle + phase_rad));
}

std::vector<LensDrop> dropsOnLens(const Rain& rain,
                                  const cv::Size& image,
                                  double time_s,
                                  std::uint64_t key) {
  constexpr double kCreeping = 0.15;  // share of the drops
  const double wipes = time_s / rain.wiped_every_s + 1.0 + randomUniform(key);
  const double since_s = rain.wiped_every_s * (wipes - std::floor(wipes));
  RandomStream random(key, static_cast<std::uint64_t>(wipes));
  std::vector<LensDrop> drops;
  for (int i = 0; i < rain.drops; ++i) {
    const double x = random.uniform(0.0, 1.0);
    const double y = random.uniform(0.0, 1.0);
    const double large = random.uniform(0.0, 1.0);
    const double phase = random.uniform(0.0, 2.0 * M_PI);
    const double falls_s = random.uniform(0.0, rain.wiped_every_s);
    const double speed = random.uniform(0.005, 0.02);  // widths of the image per second
    const double creeps = random.chance(kCreeping) ? speed * image.width : 0.0;
    if (since_s < falls_s) continue;
    drops.push_back({{x * image.width, y * image.height + creeps * (since_s - falls_s)},
                     image.width * mix(kSmallestDrop, kLargestDrop, large * large),
                     phase});
  }
  return drops;
}

cv::Mat throughDrops(const cv::Mat& light, const std::vector<LensDrop>& drops) {
  if (drops.empty()) return light;
  constexpr double kEdge = 0.6;  // its soft edge begins there
  const cv::Mat around = surroundings(light);
  cv::Mat result = light.clone();
  forEachRow(result.rows, [&](int y) {
    for (const LensDrop& drop : drops) {
      const double reach = 1.3 * drop.radius;
      if (std::abs(y - drop.centre.y()) > reach) continue;
      const int last = std::min(static_cast<int>(drop.centre.x() + reach), result.cols - 1);
      for (int x = std::max(static_cast<int>(drop.centre.x() - reach), 0); x <= last; ++x) {
        const Eigen::Vector2d pixel(x, y);
        const double share = 1.0 - smoothStep(kEdge, 1.0, drop.distance(pixel));
        if (share <= 0.0) continue;
        float& at = result.at<float>(y, x);
        at = static_cast<float>(mix(at, refracted(around, drop, pixel - drop.centre), share));
      }
    }
  });
  return result;
}

std::vector<Streak> fallingDrops(const Rain& rain,
                                 const StereoCamera& camera,
                                 const Eigen::Vector3d& way_m,
                                 std::uint64_t key) {
  RandomStream random(key, 0x57E);
  std::vector<Streak> streaks;
  for (int i = 0; i < rain.streaks; ++i) {
    const Eigen::Vector2d pixel(random.uniform(-0.2 * camera.width, 1.2 * camera.width),
                                random.uniform(-0.2 * camera.height, 1.2 * camera.height));
    const double depth_m = kFarthestStreak_m * std::cbrt(random.uniform(0.0, 1.0));
    const Eigen::Vector3d middle = depth_m * camera.ray(pixel);
    streaks.push_back({middle - 0.5 * way_m, middle + 0.5 * way_m, random.uniform(0.001, 0.004)});
  }
  return streaks;
}

cv::Mat throughStreaks(const cv::Mat& light,
                       const PixelRays& rays,
                       const std::vector<Streak>& streaks,
                       double brightness) {
  if (streaks.empty()) return light;
  cv::Mat shares(rays.pinhole.height, rays.pinhole.width, CV_32FC1, cv::Scalar(0.0));
  for (const Streak& streak : streaks) draw(streak, rays.pinhole, shares);
  cv::Mat result = light.clone();
  forEachRow(result.rows, [&](int y) {
    for (int x = 0; x < result.cols; ++x) {
      const Eigen::Vector2d place = rays.place(x, y);
      if (std::isnan(place.x())) continue;
      const int column = std::clamp(static_cast<int>(place.x() + 0.5), 0, shares.cols - 1);
      const int row = std::clamp(static_cast<int>(place.y() + 0.5), 0, shares.rows - 1);
      float& at = result.at<float>(y, x);
      at = static_cast<float>(mix(at, brightness, shares.at<float>(row, column)));
    }
  });
  return result;
}

}  // namespace rotrocc
