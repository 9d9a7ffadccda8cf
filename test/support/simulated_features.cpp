#include "support/simulated_features.h"

#include <vector>

#include "support/synthetic_scene.h"

namespace rotrocc {

bool measure(const StereoCamera& camera,
             const Eigen::Vector3d& point_cur,
             const Eigen::Isometry3d& T_keyframe_cur,
             const FeatureNoise& noise,
             std::mt19937& generator,
             Correspondence& feature) {
  std::normal_distribution<double> normal;
  const Eigen::Vector3d point_prev = T_keyframe_cur * point_cur;
  if (point_prev.z() < 1.0 || point_cur.z() < 1.0) return false;
  feature.keyframe_px = camera.project(point_prev);
  feature.keyframe_px.x() += noise.flow_px * normal(generator);
  feature.keyframe_px.y() += noise.flow_px * normal(generator);
  if ((feature.keyframe_px.array() < 0.0).any() || feature.keyframe_px.x() >= camera.width ||
      feature.keyframe_px.y() >= camera.height) {
    return false;
  }
  feature.cur_px = camera.project(point_cur);
  feature.disparity_px = camera.disparity(point_cur.z()) + noise.disparity_px * normal(generator);
  if (feature.disparity_px < 1.0) return false;
  feature.point_cur = camera.depth(feature.disparity_px) * camera.ray(feature.cur_px);
  return true;
}

Correspondences simulateFeatures(const StereoCamera& camera,
                                 const Eigen::Isometry3d& T_keyframe_cur,
                                 int count,
                                 const FeatureNoise& noise,
                                 std::mt19937& generator) {
  const SyntheticScene scene(camera);
  std::uniform_real_distribution<double> x(0.0, camera.width);
  std::uniform_real_distribution<double> y(0.0, camera.height);
  Correspondences features;
  while (static_cast<int>(features.size()) < count) {
    const Eigen::Vector2d pixel(x(generator), y(generator));
    const Eigen::Vector3d point = scene.pointAt(Eigen::Isometry3d::Identity(), pixel);
    Correspondence feature;
    if (measure(camera, point, T_keyframe_cur, noise, generator, feature))
      features.push_back(feature);
  }
  return features;
}

void mismatch(Correspondences& features,
              std::size_t first,
              std::size_t count,
              double most_px,
              std::mt19937& generator) {
  std::uniform_real_distribution<double> offset_px(-most_px, most_px);
  for (std::size_t i = first; i < first + count; ++i) {
    features[i].keyframe_px += Eigen::Vector2d(offset_px(generator), offset_px(generator));
  }
}

void putOnTruck(Correspondences& features,
                std::size_t count,
                const Eigen::Isometry3d& T_keyframe_cur,
                const FeatureNoise& noise,
                std::mt19937& generator) {
  std::uniform_real_distribution<double> x(-3.0, 1.0);
  std::uniform_real_distribution<double> y(-2.0, 1.2);
  const Eigen::Isometry3d relative = T_keyframe_cur * motion({0.0, 0.0, 0.3}, {0.0, 0.0, 0.0});
  for (std::size_t i = 0; i < count;) {
    const Eigen::Vector3d point(x(generator), y(generator), 12.0);
    if (measure(kittiCamera(), point, relative, noise, generator, features[i])) ++i;
  }
}

Correspondences biasedFeatures(const Eigen::Isometry3d& T_keyframe_cur,
                               unsigned seed,
                               const FeatureNoise& noise,
                               const std::function<double(const Eigen::Vector2d&)>& error_px) {
  std::mt19937 generator(seed);
  Correspondences features = simulateFeatures(kittiCamera(), T_keyframe_cur, 400, noise, generator);
  for (Correspondence& feature : features) feature.disparity_px -= error_px(feature.cur_px);
  return features;
}

FeatureSet all(const Correspondences& features) {
  return FeatureSet(features.size(), 1);
}

Eigen::Isometry3d motion(const Eigen::Vector3d& translation_m,
                         const Eigen::Vector3d& rotation_rad) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = expRotation(rotation_rad);
  T.translation() = translation_m;
  return T;
}

Eigen::Isometry3d turnAhead() {
  return motion({0.03, -0.01, 1.3}, {0.002, 0.03, -0.001});
}

Eigen::Isometry3d roughly(const Eigen::Isometry3d& T_keyframe_cur) {
  return T_keyframe_cur * motion({0.02, 0.01, -0.05}, {0.001, -0.002, 0.001});
}

Vector6d motionError(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth) {
  Vector6d error;
  error << estimate.translation() - truth.translation(),
      logRotation(estimate.linear() * truth.linear().transpose());
  return error;
}

std::vector<Eigen::Isometry3d> someMotions() {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const auto vector = [&] {
    return Eigen::Vector3d(any(generator), any(generator), any(generator));
  };
  std::vector<Eigen::Isometry3d> motions = {motion({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}),
                                            motion({0.0, 0.0, 1.5}, {0.0, 0.0, 0.0}),
                                            motion({0.0, 0.0, 0.0}, {0.0, 0.1, 0.0})};
  for (int i = 0; i < 10; ++i) motions.push_back(motion(vector(), 0.2 * vector()));
  return motions;
}

Correspondences someFeatures(const Eigen::Isometry3d& T_keyframe_cur) {
  std::mt19937 generator(2);
  return simulateFeatures(kittiCamera(), T_keyframe_cur, 20, {5.0, 1.0}, generator);
}

}  // namespace rotrocc
