#include "rotrocc/stereo_camera.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kRounding = 1e-12;  // relative error of a few operations

StereoCamera vergedCamera() {
  StereoCamera camera = kittiCamera();
  camera.cx_right = camera.cx - 5.0;
  return camera;
}

TEST(StereoCameraTest, ProjectsByFocalLengthAndPrincipalPoint) {
  StereoCamera camera = kittiCamera();
  camera.fx = 100.0;
  camera.fy = 200.0;
  camera.cx = 10.0;
  camera.cy = 20.0;
  EXPECT_EQ(camera.project({1.0, 2.0, 4.0}), Eigen::Vector2d(35.0, 120.0));
  EXPECT_EQ(camera.ray({35.0, 120.0}), Eigen::Vector3d(0.25, 0.5, 1.0));
}

TEST(StereoCameraTest, DepthAndDisparityAreInverse) {
  for (const StereoCamera& camera : {kittiCamera(), vergedCamera()}) {
    for (const double depth_m : {0.5, 3.0, 80.0}) {
      EXPECT_NEAR(camera.depth(camera.disparity(depth_m)), depth_m, kRounding * 100.0 * depth_m);
    }
  }
}

TEST(StereoCameraTest, DisparityIsTheDistanceBetweenBothImagesOfAPoint) {
  const StereoCamera camera = vergedCamera();
  const Eigen::Vector3d point(1.0, 0.5, 8.0);
  const double right_x = camera.fx * (point.x() - camera.baseline_m) / point.z() + camera.cx_right;
  EXPECT_NEAR(camera.disparity(8.0), camera.project(point).x() - right_x, 1e-9);
}

TEST(StereoCameraTest, APointAtInfinityHasTheDifferenceOfThePrincipalPoints) {
  const StereoCamera camera = vergedCamera();
  EXPECT_DOUBLE_EQ(camera.disparityAtInfinity(), 5.0);
  EXPECT_TRUE(std::isinf(camera.depth(5.0)));
  EXPECT_LT(camera.depth(4.0), 0.0);
}

TEST(StereoCameraTest, CheckNamesTheValueThatIsWrong) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect_rejected = [](auto member, auto value, const std::string& part) {
    StereoCamera camera = kittiCamera();
    camera.*member = value;
    expectError<std::invalid_argument>([&] { camera.check(); }, part);
  };
  EXPECT_NO_THROW(kittiCamera().check());
  expect_rejected(&StereoCamera::width, 0, "width is 0");
  expect_rejected(&StereoCamera::height, -3, "height is -3");
  expect_rejected(&StereoCamera::fx, 0.0, "fx is 0");
  expect_rejected(&StereoCamera::fy, nan, "fy is nan");
  expect_rejected(&StereoCamera::cx, nan, "cx is nan");
  expect_rejected(&StereoCamera::cy, nan, "cy is nan");
  expect_rejected(&StereoCamera::cx_right, nan, "cx_right is nan");
  expect_rejected(&StereoCamera::cx_right, 1e300, "cx - cx_right is -1e+300");
  expect_rejected(&StereoCamera::baseline_m, -0.5, "baseline_m is -0.5");
}

}  // namespace
}  // namespace rotrocc
