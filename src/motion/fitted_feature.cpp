#include "motion/fitted_feature.h"

#include <algorithm>

#include "kernels/kernels.h"

namespace rotrocc {
namespace {

/// The fit is nearly linear: after two steps the remaining error is below 1 % of the first step.
constexpr int kFitSteps = 2;

void put(const StereoCamera& camera, const Correspondence& feature, FitBlock& block, int i) {
  block.keyframe_x[i] = feature.keyframe_px.x();
  block.keyframe_y[i] = feature.keyframe_px.y();
  block.point_x[i] = feature.point_cur.x();
  block.point_y[i] = feature.point_cur.y();
  block.point_z[i] = feature.point_cur.z();
  block.measured[i] = feature.disparity_px - camera.disparityAtInfinity();
}

void get(const FitBlock& block, int i, FittedFeature& fitted) {
  fitted.target_px = {block.target_x[i], block.target_y[i]};
  fitted.rotated_point = {block.rotated_x[i], block.rotated_y[i], block.rotated_z[i]};
  fitted.whitening << block.whitening_xx[i], block.whitening_xy[i], block.whitening_xy[i],
      block.whitening_yy[i];
  fitted.by_disparity = {block.slope_x[i], block.slope_y[i]};
}

}  // namespace

MotionTerms termsAt(const StereoCamera& camera, const Eigen::Isometry3d& T_keyframe_cur) {
  MotionTerms terms = {{}, {}, camera.fx, camera.fy, camera.cx, camera.cy, kMinDepth_m};
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(terms.rotation) =
      T_keyframe_cur.linear();
  Eigen::Map<Eigen::Vector3d>(terms.translation) = T_keyframe_cur.translation();
  return terms;
}

void fitAt(const Measurements& measured, const Eigen::Isometry3d& T_keyframe_cur, Fit& fit) {
  const StereoCamera& camera = measured.camera;
  const Correspondences& features = measured.features;
  const Kernels& kernels = chooseKernels();
  const MotionTerms terms = termsAt(camera, T_keyframe_cur);
  const int steps = measured.noise_ratio > 0.0 ? kFitSteps : 0;
  FitBlock block = {};
  fit.T_keyframe_cur = T_keyframe_cur;
  fit.features.resize(features.size());
  for (std::size_t first = 0; first < features.size(); first += FitBlock::kSize) {
    const auto left = features.size() - first;
    const int count = static_cast<int>(std::min<std::size_t>(left, FitBlock::kSize));
    for (int i = 0; i < FitBlock::kSize; ++i) {
      put(camera, features[first + static_cast<std::size_t>(std::min(i, count - 1))], block, i);
    }
    kernels.fitDisparities(terms, measured.noise_ratio * measured.noise_ratio, steps, block);
    for (int i = 0; i < count; ++i)
      get(block, i, fit.features[first + static_cast<std::size_t>(i)]);
  }
}

}  // namespace rotrocc
