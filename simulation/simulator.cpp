#include "simulation/simulator.h"

#include <algorithm>
#include <cmath>

#include <opencv2/core/utility.hpp>

#include "simulation/counter_random.h"
#include "simulation/gyroscope.h"
#include "simulation/require_range.h"

namespace rotrocc {
namespace {

constexpr int kBlurSteps = 8;

WorldPlan plannedWorld(const Scenario& scenario,
                       const SimulationOptions& options,
                       const std::optional<WornRig>& worn) {
  WorldPlan plan = scenario.world;
  plan.tiled_share = options.tiled_share;
  if (worn) plan.weather = worn->weather;
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

std::vector<std::int64_t> frameStamps(const Scenario& scenario, const SimulationOptions& options) {
  std::vector<std::int64_t> stamps_ns = scenario.stamps_ns;
  if (stamps_ns.empty()) {
    for (int i = 0; i <= scenario.drive->duration_s() * options.rate_hz; ++i) {
      stamps_ns.push_back(std::llround(1e9 * i / options.rate_hz));
    }
  }
  const auto frames = static_cast<std::size_t>(std::max(0, options.frames));
  if (frames > 0 && frames < stamps_ns.size()) stamps_ns.resize(frames);
  return stamps_ns;
}

}  // namespace

void CameraFaults::check() const {
  requireRange("disparity bias [px]", disparity_bias_px, -20.0, 20.0);
  requireRange("rotation of the right camera [rad]", right_rotation_rad.norm(), 0.0, 0.2);
  requireRange("row offset [px]", row_offset_px, -20.0, 20.0);
  requireRange("focal length of the right camera", right_focal_ratio, 0.5, 2.0);
  requireRange("time skew [s]", time_skew_s, -0.1, 0.1);
  requireRange("noise [grey levels]", sensor.noise_sigma, 0.0, 50.0);
  requireRange("vignetting", sensor.vignetting, 0.0, 1.0);
  requireRange("motion blur [s]", motion_blur_s, 0.0, 0.1);
}

Eigen::Isometry3d CameraFaults::rightCamera(const StereoCamera& camera) const {
  Eigen::Isometry3d T_left_right = Eigen::Isometry3d::Identity();
  T_left_right.translation().x() = camera.baseline_m;
  T_left_right.rotate(Eigen::AngleAxisd(right_rotation_rad[2], Eigen::Vector3d::UnitY()));
  T_left_right.rotate(Eigen::AngleAxisd(right_rotation_rad[1], Eigen::Vector3d::UnitX()));
  T_left_right.rotate(Eigen::AngleAxisd(right_rotation_rad[0], Eigen::Vector3d::UnitZ()));
  return T_left_right;
}

void SimulationOptions::check() const {
  camera.check();
  faults.check();
  requireRange("share of moving cars", moving_share, 0.0, 1.0);
  requireRange("share of the lorry", lorry.share, 0.0, 1.0);
  requireRange("share of repeated texture", tiled_share, 0.0, 1.0);
  requireRange("rate [Hz]", rate_hz, 1e-3, 1000.0);
}

Simulator::Simulator(const Scenario& scenario, const SimulationOptions& options)
    : options_(options), exposure_(scenario.exposure), drive_(scenario.drive) {
  options.check();
  if (options.worn_rig) worn_ = wornRig(options.camera, options.seed, exposure_);
  if (!options.lens.empty()) unrectified_ = rotrocc::unrectifiedRig(options.camera, options.lens);
  world_ = std::make_unique<World>(plannedWorld(scenario, options, worn_));
  traffic_ = std::make_unique<Traffic>(plannedTraffic(scenario, options, *world_),
                                       *drive_,
                                       *world_,
                                       options.moving_share,
                                       options.seed);
  stamps_ns_ = frameStamps(scenario, options);
}

Eigen::Isometry3d Simulator::pose(int index) const {
  return drive_->pose(time_s(0)).inverse() * drive_->pose(time_s(index));
}

std::vector<GyroSample> Simulator::gyroscope() const {
  return simulateGyroscope(*drive_, stamps_ns_.front(), stamps_ns_.back(), options_.noise_seed);
}

PixelRays Simulator::rays(bool right) const {
  PixelRays rays = {options_.camera, {}};
  if (right) rays.pinhole.cx = options_.camera.cx_right;
  if (worn_) rays = (right ? worn_->right : worn_->left).rays;
  if (unrectified_) rays = (right ? unrectified_->right : unrectified_->left).rays;
  if (!right) return rays;
  const double scale = rays.pinhole.fx / options_.camera.fx;
  rays.pinhole.cx -= scale * options_.faults.disparity_bias_px;
  rays.pinhole.cy += scale * options_.faults.row_offset_px;
  rays.pinhole.fx *= options_.faults.right_focal_ratio;
  rays.pinhole.fy *= options_.faults.right_focal_ratio;
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

std::uint64_t Simulator::noiseKey(int index, bool right) const {
  return randomBits(
      options_.noise_seed, 0x4015E, 2 * static_cast<std::uint64_t>(index) + (right ? 1 : 0));
}

cv::Mat Simulator::perfectImage(int index, bool right, Picture sharp) {
  const double time = exposedAt(index, right);
  const PixelRays own_rays = rays(right);
  cv::Mat light;
  if (options_.faults.motion_blur_s > 0.0) {
    light = meanLight(time, own_rays, right);
  } else {
    if (sharp.brightness.empty()) sharp = look(time, right, own_rays);
    light = smearedLight(sharp, time, exposure_.time_s, own_rays, right);
  }
  return develop(light, exposure_.of(options_.faults.sensor), 1.0, noiseKey(index, right));
}

cv::Mat Simulator::wornImage(int index, bool right) {
  const double time = exposedAt(index, right);
  const PixelRays own_rays = rays(right);
  const Picture picture = look(time, right, own_rays);
  const cv::Mat light = smearedLight(picture, time, worn_->exposure_s, own_rays, right);
  const WornCamera& camera = right ? worn_->right : worn_->left;
  return camera.develop(light, worn_->gains.at(time_s(index), right), noiseKey(index, right));
}

SimulatedFrame Simulator::render(int index, bool with_flow) {
  const double time = time_s(index);
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
