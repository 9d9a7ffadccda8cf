#include "simulation/simulator.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <opencv2/core/utility.hpp>

#include "simulation/counter_random.h"
#include "simulation/gyroscope.h"

namespace rotrocc {
namespace {

constexpr int kBlurSteps = 8;
constexpr double kRainBrightness = 1.3;  // of drops over the sky: they are lenses

std::optional<WornRig> chosenRig(const SimulationOptions& options, const Exposure& exposure) {
  if (!options.worn_rig) return std::nullopt;
  return wornRig(options.camera, options.seed, exposure);
}

std::optional<UnrectifiedRig> chosenLens(const SimulationOptions& options) {
  if (options.lens.empty()) return std::nullopt;
  if (options.worn_rig) {
    throw std::invalid_argument("the images of a worn rig are rectified: leave out the lens");
  }
  return unrectifiedRig(options.camera, options.lens);
}

Gains chosenGains(const SimulationOptions& options, const std::optional<WornRig>& worn) {
  if (options.gains_out_of_step) return outOfStepGains(options.seed);
  return worn ? worn->gains : Gains();
}

WorldPlan plannedWorld(const Scenario& scenario,
                       const SimulationOptions& options,
                       const std::optional<WornRig>& worn) {
  WorldPlan plan = scenario.world;
  plan.tiled_share = options.tiled_share;
  if (worn) {
    plan.weather.wind = worn->weather.wind;
    plan.weather.reflections = worn->weather.reflections;
  }
  return plan;
}

TrafficPlan plannedTraffic(const Scenario& scenario,
                           const SimulationOptions& options,
                           const World& world) {
  TrafficPlan plan = scenario.traffic;
  plan.lorry_across_mps = options.lorry.across_mps;
  if (options.lorry.share > 0.0) {
    plan.lorry = makeLorry(options.lorry.share, options.camera, world.tiles());
  }
  return plan;
}

SimulationOptions checked(const SimulationOptions& options) {
  options.check();
  return options;
}

Rain checkedRain(const Rain& rain) {
  rain.check();
  return rain;
}

}  // namespace

Simulator::Simulator(const Scenario& scenario, const SimulationOptions& options)
    : options_(checked(options)),
      exposure_(scenario.exposure),
      rain_(checkedRain(scenario.rain)),
      rain_brightness_(kRainBrightness * scenario.world.lighting.sky),
      worn_(chosenRig(options_, exposure_)),
      unrectified_(chosenLens(options_)),
      gains_(chosenGains(options_, worn_)),
      drive_(scenario.drive),
      world_(std::make_unique<World>(plannedWorld(scenario, options_, worn_))),
      traffic_(std::make_unique<Traffic>(plannedTraffic(scenario, options_, *world_),
                                         *drive_,
                                         *world_,
                                         options.moving_share,
                                         options.seed)),
      stamps_ns_(frameStamps(scenario, options)) {}

Eigen::Isometry3d Simulator::pose(int index) const {
  return drive_->pose(time_s(0)).inverse() * drive_->pose(time_s(index));
}

std::vector<GyroSample> Simulator::gyroscope() const {
  return simulateGyroscope(*drive_, stamps_ns_.front(), stamps_ns_.back(), options_.noise_seed);
}

PixelRays Simulator::rays(bool right) const {
  PixelRays rays = {options_.camera, {}};
  if (right) rays.pinhole.cx = options_.camera.cx_right;
  if (worn_) rays = (right ? worn_->right : worn_->left).rays();
  if (unrectified_) rays = (right ? unrectified_->right : unrectified_->left).rays;
  if (!right) return rays;
  const double scale = rays.pinhole.fx / options_.camera.fx;
  rays.pinhole.cx -= scale * options_.faults.disparity_bias_px;
  rays.pinhole.cy += scale * options_.faults.row_offset_px;
  return rays;
}

Eigen::Isometry3d Simulator::cameraPose(double time_s, bool right) const {
  if (!right) return drive_->pose(time_s);
  return drive_->pose(time_s) * options_.faults.rightCamera(options_.camera);
}

Picture Simulator::look(double time_s, bool right, const PixelRays& rays) {
  world_->setTime(time_s);
  world_->setCar(drive_->pose(time_s));
  return rotrocc::render(*world_, traffic_->at(time_s), rays, cameraPose(time_s, right));
}

double Simulator::exposedAt(int index, bool right) const {
  return time_s(index) + (right ? options_.faults.time_skew_s : 0.0);
}

cv::Mat Simulator::meanLight(double time_s, const PixelRays& rays, bool right) {
  const double step_s = options_.faults.motion_blur_s / kBlurSteps;
  cv::Mat sum;
  for (int step = 0; step < kBlurSteps; ++step) {
    const double middle_s = time_s + (step + 0.5 - 0.5 * kBlurSteps) * step_s;
    const cv::Mat one = smearedLight(look(middle_s, right, rays), middle_s, step_s, rays, right);
    sum = sum.empty() ? one : cv::Mat(sum + one);
  }
  return sum / kBlurSteps;
}

cv::Mat Simulator::smearedLight(const Picture& picture,
                                double time_s,
                                double exposure_s,
                                const PixelRays& rays,
                                bool right) const {
  if (exposure_s <= 0.0) return picture.brightness;
  const double half_s = 0.5 * exposure_s;
  return blurred(picture, rays, motions(time_s - half_s, time_s + half_s, right));
}

std::vector<Streak> Simulator::streaks(int index, double exposure_s, bool right) const {
  constexpr double kFall_mps = 8.0;
  const double time = exposedAt(index, right);
  const Eigen::Isometry3d T_left_world = drive_->pose(time).inverse();
  const Eigen::Vector3d fall(0.0, kFall_mps * exposure_s, 0.0);
  const Eigen::Vector3d ride = drive_->pose(time + 0.5 * exposure_s).translation() -
                               drive_->pose(time - 0.5 * exposure_s).translation();
  const Eigen::Vector3d way = T_left_world.linear() * (fall - ride);
  std::vector<Streak> streaks =
      fallingDrops(rain_, options_.camera, way, randomBits(options_.seed, 0xFA11, index));
  if (!right) return streaks;
  const Eigen::Isometry3d T_right_left = options_.faults.rightCamera(options_.camera).inverse();
  for (Streak& streak : streaks) {
    streak.from = T_right_left * streak.from;
    streak.to = T_right_left * streak.to;
  }
  return streaks;
}

cv::Mat Simulator::throughRain(
    const cv::Mat& light, const PixelRays& rays, int index, double exposure_s, bool right) const {
  const cv::Mat before =
      throughStreaks(light, rays, streaks(index, exposure_s, right), rain_brightness_);
  const std::uint64_t lens = randomBits(options_.seed, 0x1E45, right ? 1 : 0);
  return throughDrops(before, dropsOnLens(rain_, light.size(), exposedAt(index, right), lens));
}

double Simulator::gain(int index, bool right) const {
  return jumpGain(options_.faults, index, options_.noise_seed) * gains_.at(time_s(index), right);
}

std::uint64_t Simulator::noiseKey(int index, bool right) const {
  return randomBits(
      options_.noise_seed, 0x4015E, 2 * static_cast<std::uint64_t>(index) + (right ? 1 : 0));
}

cv::Mat Simulator::perfectImage(int index, bool right, Picture sharp) {
  const double time = exposedAt(index, right);
  const PixelRays own_rays = rays(right);
  const double exposure_s = std::max(exposure_.time_s, options_.faults.motion_blur_s);
  cv::Mat light;
  if (options_.faults.motion_blur_s > 0.0) {
    light = meanLight(time, own_rays, right);
  } else {
    if (sharp.brightness.empty()) sharp = look(time, right, own_rays);
    light = smearedLight(sharp, time, exposure_.time_s, own_rays, right);
  }
  return develop(throughRain(light, own_rays, index, exposure_s, right),
                 exposure_.of(options_.faults.sensor),
                 gain(index, right),
                 noiseKey(index, right));
}

cv::Mat Simulator::wornImage(int index, bool right) {
  const double time = exposedAt(index, right);
  const PixelRays own_rays = rays(right);
  const Picture picture = look(time, right, own_rays);
  const cv::Mat light = smearedLight(picture, time, worn_->exposure_s, own_rays, right);
  const WornCamera& camera = right ? worn_->right : worn_->left;
  return camera.develop(throughRain(light, own_rays, index, worn_->exposure_s, right),
                        gain(index, right),
                        noiseKey(index, right));
}

SimulatedFrame Simulator::render(int index, bool with_flow) {
  const double time = time_s(index);
  world_->goTo(drive_->station_m(time));
  SimulatedFrame frame;
  frame.pair.stamp_ns = stamp_ns(index);
  Picture left;
  const bool is_nominal = !worn_ && !unrectified_;
  if (is_nominal || with_flow) left = look(time, false, {options_.camera, {}});
  if (worn_) {
    frame.pair.left = wornImage(index, false);
    frame.pair.right = wornImage(index, true);
  } else {
    frame.pair.left = perfectImage(index, false, is_nominal ? left : Picture());
    frame.pair.right = perfectImage(index, true, {});
  }
  frame.depth = left.depth;
  if (with_flow && index + 1 < size()) frame.flow = flowToNext(index, left);
  return frame;
}

std::vector<double> Simulator::depthsAt(int index, const std::vector<Eigen::Vector2d>& pixels) {
  const double time = time_s(index);
  world_->goTo(drive_->station_m(time));
  const MovingCars cars = traffic_->at(time);
  world_->setTime(time);
  const View view(
      world_->bodies(), cars.bodies, options_.camera, options_.camera.cx, drive_->pose(time));
  std::vector<double> depths;
  for (const Eigen::Vector2d& pixel : pixels) {
    depths.push_back(world_->look(view, pixel.x(), pixel.y()).depth);
  }
  return depths;
}

SeenMotions Simulator::motions(double from_s, double to_s, bool right) const {
  const Eigen::Isometry3d T_world_from = cameraPose(from_s, right);
  const Eigen::Isometry3d T_to_world = cameraPose(to_s, right).inverse();
  SeenMotions motions;
  for (int car = 0; car < traffic_->size(); ++car) {
    motions.push_back(T_to_world * traffic_->pose(car, to_s) *
                      traffic_->pose(car, from_s).inverse() * T_world_from);
  }
  motions.push_back(T_to_world * T_world_from);
  return motions;
}

cv::Mat Simulator::flowToNext(int index, const Picture& left) const {
  const SeenMotions to_next = motions(time_s(index), time_s(index + 1), false);
  const PixelRays rays = {options_.camera, {}};
  cv::Mat flow(left.depth.size(), CV_64FC2);
  for (int y = 0; y < flow.rows; ++y) {
    for (int x = 0; x < flow.cols; ++x) {
      const Eigen::Vector2d shift = flowAt(x, y, left, rays, to_next);
      flow.at<cv::Vec2d>(y, x) = {shift.x(), shift.y()};
    }
  }
  return flow;
}

}  // namespace rotrocc
