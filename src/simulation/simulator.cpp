#include "simulation/simulator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <opencv2/core/utility.hpp>

#include "simulation/counter_random.h"

namespace rotrocc {
namespace {

constexpr int kBlurSteps = 8;

void requireShare(const std::string& name, double value) {
  if (value >= 0.0 && value <= 1.0) return;
  throw std::invalid_argument(name + " is " + std::to_string(value) + ": choose it from 0 to 1");
}

SimulationOptions checked(const SimulationOptions& options) {
  options.camera.check();
  options.faults.check();
  requireShare("share of moving cars", options.moving_share);
  requireShare("share of dropped frames", options.drop_share);
  if (!(options.rate_hz > 0.0 && options.rate_hz <= 1000.0)) {
    throw std::invalid_argument("rate is " + std::to_string(options.rate_hz) +
                                " Hz: choose it above 0, up to 1000");
  }
  return options;
}

std::vector<std::int64_t> allStamps(const Scenario& scenario, double rate_hz) {
  if (!scenario.stamps_ns.empty()) return scenario.stamps_ns;
  std::vector<std::int64_t> stamps_ns;
  for (int i = 0; i <= scenario.drive->duration_s() * rate_hz; ++i) {
    stamps_ns.push_back(std::llround(1e9 * i / rate_hz));
  }
  return stamps_ns;
}

std::vector<std::int64_t> keptStamps(const Scenario& scenario, const SimulationOptions& options) {
  const std::vector<std::int64_t> all = allStamps(scenario, options.rate_hz);
  std::vector<std::int64_t> kept;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (options.frames > 0 && static_cast<int>(kept.size()) == options.frames) break;
    if (options.duration_s > 0.0 && 1e-9 * static_cast<double>(all[i]) > options.duration_s) break;
    const bool dropped = i > 0 && randomUniform(options.seed, 0xD209, i) < options.drop_share;
    if (!dropped) kept.push_back(all[i]);
  }
  return kept;
}

}  // namespace

Simulator::Simulator(const Scenario& scenario, const SimulationOptions& options)
    : options_(checked(options)),
      drive_(scenario.drive),
      world_(std::make_unique<World>(scenario.world)),
      traffic_(std::make_unique<Traffic>(
          scenario.traffic, *drive_, *world_, options.moving_share, options.seed)),
      stamps_ns_(keptStamps(scenario, options)) {}

Eigen::Isometry3d Simulator::pose(int index) const {
  return drive_->pose(time_s(0)).inverse() * drive_->pose(time_s(index));
}

Picture Simulator::look(double time_s, bool right) const {
  const MovingCars cars = traffic_->at(time_s);
  Eigen::Isometry3d T_world_camera = drive_->pose(time_s);
  double cx = options_.camera.cx;
  if (right) {
    T_world_camera = T_world_camera * options_.faults.rightCamera(options_.camera);
    cx = options_.camera.cx_right - options_.faults.disparity_bias_px;
  }
  return rotrocc::render(*world_, cars, options_.camera, cx, T_world_camera);
}

cv::Mat Simulator::brightness(double time_s, bool right) const {
  if (options_.faults.motion_blur_s <= 0.0) return look(time_s, right).brightness;
  cv::Mat sum;
  for (int step = 0; step < kBlurSteps; ++step) {
    const double offset = (step + 0.5) / kBlurSteps - 0.5;
    const cv::Mat one = look(time_s + offset * options_.faults.motion_blur_s, right).brightness;
    sum = sum.empty() ? one : cv::Mat(sum + one);
  }
  return sum / kBlurSteps;
}

SimulatedFrame Simulator::render(int index, bool with_flow) {
  const double time = time_s(index);
  world_->goTo(drive_->station_m(time));
  const Picture left = look(time, false);
  const bool blurred = options_.faults.motion_blur_s > 0.0;
  const cv::Mat left_light = blurred ? brightness(time, false) : left.brightness;
  const cv::Mat right_light = brightness(time + options_.faults.time_skew_s, true);
  SimulatedFrame frame;
  frame.pair.stamp_ns = stamp_ns(index);
  frame.pair.left = develop(left_light, options_.faults, {index, false}, options_.noise_seed);
  frame.pair.right = develop(right_light, options_.faults, {index, true}, options_.noise_seed);
  frame.depth = left.depth;
  if (with_flow && index + 1 < size()) frame.flow = flowToNext(index, left);
  return frame;
}

std::vector<double> Simulator::depthsAt(int index, const std::vector<Eigen::Vector2d>& pixels) {
  const double time = time_s(index);
  world_->goTo(drive_->station_m(time));
  const MovingCars cars = traffic_->at(time);
  const View view(
      world_->bodies(), cars.bodies, options_.camera, options_.camera.cx, drive_->pose(time));
  std::vector<double> depths;
  for (const Eigen::Vector2d& pixel : pixels) {
    depths.push_back(world_->look(view, pixel.x(), pixel.y()).depth);
  }
  return depths;
}

cv::Mat Simulator::flowToNext(int index, const Picture& left) const {
  const double now = time_s(index);
  const double then = time_s(index + 1);
  const Eigen::Isometry3d T_world_now = drive_->pose(now);
  const Eigen::Isometry3d T_then_world = drive_->pose(then).inverse();
  // Motion of the points of each car in the camera's frame; the last entry is the static scene.
  std::vector<Eigen::Isometry3d> T_then_now;
  for (int car = 0; car < traffic_->size(); ++car) {
    T_then_now.push_back(T_then_world * traffic_->pose(car, then) *
                         traffic_->pose(car, now).inverse() * T_world_now);
  }
  T_then_now.push_back(T_then_world * T_world_now);

  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  cv::Mat flow(left.depth.size(), CV_64FC2);
  for (int y = 0; y < flow.rows; ++y) {
    for (int x = 0; x < flow.cols; ++x) {
      const Eigen::Vector2d pixel(x, y);
      const Eigen::Vector3d ray = options_.camera.ray(pixel);
      const double depth = left.depth.at<double>(y, x);
      const int car = left.moving_car.at<int>(y, x);
      const Eigen::Isometry3d& motion = car < 0 ? T_then_now.back() : T_then_now[car];
      const Eigen::Vector3d point = std::isinf(depth) ? Eigen::Vector3d(motion.linear() * ray)
                                                      : Eigen::Vector3d(motion * (depth * ray));
      const Eigen::Vector2d shift = options_.camera.project(point) - pixel;
      const bool in_front = point.z() > 0.0;
      flow.at<cv::Vec2d>(y, x) =
          in_front ? cv::Vec2d(shift.x(), shift.y()) : cv::Vec2d(kNone, kNone);
    }
  }
  return flow;
}

}  // namespace rotrocc
