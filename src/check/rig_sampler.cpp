#include "check/rig_sampler.h"

#include <algorithm>
#include <cmath>

namespace rotrocc {
namespace {

/// Features of a pair that are measured: more would not change a result by a tenth of its
/// uncertainty.
constexpr std::size_t kPerPair = 80;

/// Moves a window by a part of a pixel, for each sample by another one. Interpolation blurs the
/// noise of windows between pixels, so that these match a little better. Where images hardly move,
/// all features are at similar parts of pixels, and rows would be wrong by some hundredths.
cv::Point2f shiftOf(std::size_t sample) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  const double part = golden * static_cast<double>(sample);
  return {0.0F, static_cast<float>(part - std::floor(part) - 0.5)};
}

/// Derivatives of the pixel of a point by it.
Eigen::Matrix<double, 2, 3> pixelByPoint(const StereoCamera& camera, const Eigen::Vector3d& point) {
  Eigen::Matrix<double, 2, 3> by_point;
  by_point << camera.fx, 0.0, -camera.fx * point.x() / point.z(), 0.0, camera.fy,
      -camera.fy * point.y() / point.z();
  return by_point / point.z();
}

}  // namespace

Eigen::Vector3d measureFlow(const StereoCamera& camera,
                            const OdometryResult& result,
                            const Correspondence& feature,
                            RigSample& sample) {
  constexpr double kLeast_px = 1.0;  // of a disparity, of which errors are parts
  const UncertainTransform& motion = result.T_keyframe_cur;
  const double applied_px = result.disparity_bias.applied_px;
  const double from_infinity_px = feature.disparity_px + applied_px - camera.disparityAtInfinity();
  const double depth_m = camera.fx * camera.baseline_m / std::max(from_infinity_px, kLeast_px);
  const Eigen::Vector3d ray = camera.ray(feature.cur_px);
  const Eigen::Vector3d point = motion.T * (depth_m * ray);
  if (from_infinity_px < kLeast_px || !isUsableDepth(point.z())) return depth_m * ray;
  const Eigen::Matrix<double, 2, 3> by_point = pixelByPoint(camera, point);
  sample.flow_by_motion << by_point, -by_point * skew(point);
  sample.flow_by_disparity = by_point * (motion.T.linear() * ray) * (-depth_m / from_infinity_px);
  sample.damping_ppx = motion.T.translation().z() / (point.z() * from_infinity_px);
  // Both lenses move the feature in the keyframe, its ray, and its disparity.
  const auto moved = [](const Eigen::Vector2d& at) { return (at.squaredNorm() * at).eval(); };
  const Eigen::Vector2d at = ray.head<2>();
  const double disparity = moved(at).x() - moved({sample.x_right, sample.y}).x();
  const Eigen::Matrix<double, 2, 2> by_ray = depth_m * by_point * motion.T.linear().leftCols<2>();
  sample.flow_by_both.col(0) =
      camera.fx * (moved(point.hnormalized()) - disparity * sample.flow_by_disparity) -
      by_ray * moved(at);
  // A principal point moves the ray back, and the projection forth.
  sample.flow_by_both.rightCols<2>() =
      Eigen::Matrix2d::Identity() -
      by_ray * Eigen::Vector2d(1.0 / camera.fx, 1.0 / camera.fy).asDiagonal();
  sample.flow_px = feature.keyframe_px - camera.project(point);
  return depth_m * ray;
}

void RigSampler::observe(const CheckedPair& pair) {
  const OdometryResult& result = pair.result;
  if (!result.hasMotion()) return;
  const double dt_s = result.dt_s();
  const Vector6d twist = logMotion(result.T_prev_cur) / dt_s;
  if (result.prev_stamp_ns == last_ns_) {  // a parabola through three poses
    addVelocities(pair.camera, last_dt_s_ / (dt_s + last_dt_s_) * (twist - last_twist_));
  }
  if (!pair.has_moved) return;
  PairSamples samples = {pair.time_s, result.flow_noise_px, result.disparity_bias.applied_px, {}};
  samples.late_s = result.right_delay.applied_s;
  last_points_.clear();
  tracker_.setWindowScale(result.detail_px());
  const std::size_t step = std::max<std::size_t>(1, pair.features.size() / kPerPair);
  for (std::size_t i = 0; i < pair.features.size(); i += step) {
    const Correspondence& feature = pair.features[i];
    RigSample sample;
    sample.left_px = cv::Point2d(feature.cur_px.x(), feature.cur_px.y());
    sample.x_right =
        (feature.cur_px.x() - feature.disparity_px - pair.camera.cx_right) / pair.camera.fx;
    sample.y = (feature.cur_px.y() - pair.camera.cy) / pair.camera.fy;
    last_points_.push_back(measureFlow(pair.camera, result, feature, sample));
    if (result.keyframe_stamp_ns == result.prev_stamp_ns) {
      sample.velocity_pxps = -sample.flow_px / dt_s;
    }
    measureRow(pair, feature, sample);
    samples.samples.push_back(sample);
  }
  pairs_.push_back(std::move(samples));
  last_ns_ = result.stamp_ns;
  last_dt_s_ = dt_s;
  last_twist_ = twist;
  addVelocities(pair.camera, twist);
}

void RigSampler::exclude(const cv::Mat& mask) {
  const auto isMasked = [&](const RigSample& sample) {
    return mask.at<uchar>(cv::Point(sample.left_px)) != 0;
  };
  for (auto& [time_s, noise_px, applied_px, samples, late_s] : pairs_) {
    samples.erase(std::remove_if(samples.begin(), samples.end(), isMasked), samples.end());
  }
}

void RigSampler::addVelocities(const StereoCamera& camera, const Vector6d& twist) {
  const Eigen::Vector3d right(camera.baseline_m, 0.0, 0.0);
  auto sample = pairs_.back().samples.begin();
  for (const Eigen::Vector3d& point : last_points_) {
    const Eigen::Vector3d velocity_mps = point.cross(twist.tail<3>()) - twist.head<3>();
    (sample++)->velocity_pxps += pixelByPoint(camera, point - right) * velocity_mps;
  }
}

void RigSampler::measureRow(const CheckedPair& pair,
                            const Correspondence& feature,
                            RigSample& sample) {
  const cv::Point2f left = sample.left_px + shiftOf(samples_++);
  cv::Point2f right = left + cv::Point2f(-static_cast<float>(feature.disparity_px),
                                         static_cast<float>(pair.result.row_offset.applied_px));
  // Twice again from where it stops, up to 0.04 px before the end.
  for (int i = 0; i < 3; ++i) {
    if (!tracker_.locate(pair.images.left, pair.images.right, left, right)) return;
  }
  // What looks a little alike in the row where the search began is not found on the way back.
  constexpr double kReturn = 0.3;  // over the detail
  cv::Point2f back = left;
  if (!tracker_.locate(pair.images.right, pair.images.left, right, back)) return;
  if (cv::norm(back - left) > kReturn * pair.result.detail_px()) return;
  sample.left_px = left;
  sample.row_px = right.y - left.y;
}

}  // namespace rotrocc
