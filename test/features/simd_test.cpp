// Compares the results of the processor's widest registers with those of 128-bit registers and of
// plain C++. For the latter, the sources of the front end are compiled a second time in another
// namespace, with OpenCV's emulation of its SIMD types.

#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "features/front_end.h"
#include "rotrocc/kitti.h"
#include "support/synthetic_scene.h"

namespace rotrocc_emulated {

std::vector<double> runFrontEnd(const cv::Mat& prev_left,
                                const cv::Mat& prev_right,
                                const cv::Mat& cur_left,
                                const cv::Mat& cur_right,
                                double focal_px,
                                double ahead_m);

}  // namespace rotrocc_emulated

namespace rotrocc {
namespace {

constexpr std::size_t kNumbersOfAFeature = 5;

void expectTheSame(const StereoPair& a, const StereoPair& b, double focal_px, double ahead_m) {
  const auto widest = runFrontEnd(a.left, a.right, b.left, b.right, focal_px, ahead_m);
  cv::setUseOptimized(false);
  const auto simd = runFrontEnd(a.left, a.right, b.left, b.right, focal_px, ahead_m);
  cv::setUseOptimized(true);
  const auto plain =
      rotrocc_emulated::runFrontEnd(a.left, a.right, b.left, b.right, focal_px, ahead_m);
  EXPECT_GT(simd.size(), 200 * kNumbersOfAFeature) << "there is little to compare";
  EXPECT_EQ(simd, plain);
  EXPECT_EQ(widest, plain);
}

StereoPair render(double z_m, const StereoCamera& camera) {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.translation().z() = z_m;
  StereoPair pair = SyntheticScene(camera).render(T_world_camera, 0);
  SyntheticScene::addNoise(pair, 2.0, 1);
  return pair;
}

TEST(SimdTest, PlainCodeFindsTheSameInAStreet) {
  StereoCamera camera = SyntheticScene::defaultCamera();
  expectTheSame(render(0.0, camera), render(0.3, camera), camera.fx, 0.25);
  camera.width -= 3;  // so that rows are not a whole number of registers
  camera.height -= 1;
  expectTheSame(render(0.0, camera), render(0.3, camera), camera.fx, 0.25);
}

TEST(SimdTest, PlainCodeFindsTheSameAtAnotherContrast) {
  const StereoCamera camera = SyntheticScene::defaultCamera();
  StereoPair before = render(0.0, camera);
  StereoPair after = render(0.3, camera);
  before.right.convertTo(before.right, -1, 0.6, 10.0);
  after.left.convertTo(after.left, -1, 0.5, 0.0);
  expectTheSame(before, after, camera.fx, 0.25);
}

TEST(SimdTest, PlainCodeFindsTheSameOnKitti) {
  const char* directory = std::getenv("ROTROCC_KITTI_DIR");
  if (directory == nullptr) GTEST_SKIP() << "ROTROCC_KITTI_DIR names no folder of KITTI clips";
  const KittiSequence sequence(std::string(directory) + "/06_000_050");
  const auto pair = [&](int i) -> StereoPair {
    return {sequence.stamp_ns(i), sequence.readLeft(i), sequence.readRight(i)};
  };
  expectTheSame(pair(20), pair(21), sequence.camera().fx, 1.2);
}

}  // namespace
}  // namespace rotrocc
