#include "motion/reprojection_error.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kRounding_px = 1e-9;

Correspondences features(const Eigen::Isometry3d& T_keyframe_cur) {
  std::mt19937 generator(1);
  return simulateFeatures(kittiCamera(), T_keyframe_cur, 100, {}, generator);
}

std::vector<double> decoupled(const Correspondences& features, const Eigen::Matrix3d& R) {
  std::vector<double> lengths_px;
  decoupledFlow(kittiCamera(), features, R, lengths_px);
  return lengths_px;
}

TEST(FlowDecouplingTest, IsTheDistanceToTheRotatedRay) {
  const Eigen::Isometry3d T = motion({0.2, -0.05, 1.4}, {0.01, 0.06, -0.02});
  const StereoCamera camera = kittiCamera();
  const Correspondences moved = features(T);
  const std::vector<double> lengths_px = decoupled(moved, T.linear());
  std::vector<double> coupled_px;
  coupledFlow(moved, coupled_px);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    // Eq. 28 needs no depth: it uses pi(R x) of the ray.
    const Eigen::Vector3d ray = T.linear() * camera.ray(moved[i].cur_px);
    EXPECT_NEAR(lengths_px[i], (moved[i].keyframe_px - camera.project(ray)).norm(), kRounding_px);
    EXPECT_NEAR(coupled_px[i], (moved[i].keyframe_px - moved[i].cur_px).norm(), kRounding_px);
  }
}

TEST(FlowDecouplingTest, StaysFiniteForPointsTurnedBehindTheCamera) {
  const Eigen::Isometry3d T = motion({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  for (const double length_px :
       decoupled(features(T), motion({0.0, 0.0, 0.0}, {0.0, 3.0, 0.0}).linear())) {
    EXPECT_TRUE(std::isfinite(length_px));
  }
}

}  // namespace
}  // namespace rotrocc
