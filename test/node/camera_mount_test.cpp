#include "node/camera_mount.h"

#include <cmath>

#include <gtest/gtest.h>

#include "bags/kitti_mount.h"
#include "support/expect_error.h"

namespace rotrocc {
namespace {

TEST(DescribeMountTest, CameraOfACar) {
  EXPECT_EQ(describeMount(kittiMount()),
            "at 0 0 1.65 m, looks along +x (forward), its image is upright");
}

TEST(DescribeMountTest, TiltedCameraUpsideDown) {
  Eigen::Isometry3d T_base_camera = kittiMount();
  T_base_camera.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  T_base_camera.rotate(Eigen::AngleAxisd(M_PI / 9.0, Eigen::Vector3d::UnitY()));
  EXPECT_EQ(describeMount(T_base_camera),
            "at 0 0 1.65 m, looks along +x (forward), 20 deg off, its image is not upright");
}

TEST(DescribeMountTest, FrameThatIsNotOptical) {
  EXPECT_EQ(describeMount(Eigen::Isometry3d::Identity()),
            "at 0 0 0 m, looks along +z (up); is its frame an optical frame, with z forward?");
}

TEST(DescribeMountTest, CameraThatLooksDown) {
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  T_base_camera.translation().z() = 12.0;
  T_base_camera.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  EXPECT_EQ(describeMount(T_base_camera), "at 0 0 12 m, looks along -z (down)");
}

geometry_msgs::Transform makeTransform(double x, double qw, double qz) {
  geometry_msgs::Transform transform;
  transform.translation.x = x;
  transform.rotation.w = qw;
  transform.rotation.z = qz;
  return transform;
}

TEST(ToEigenTest, TakesWhatIsATransform) {
  const Eigen::Isometry3d T = toEigen(makeTransform(2.0, std::sqrt(0.5), std::sqrt(0.5)));
  EXPECT_TRUE((T * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(2, 1, 0)));
  // As rounded in a launch file.
  EXPECT_NEAR(toEigen(makeTransform(0.0, 0.707, 0.707)).linear().determinant(), 1.0, 1e-12);
}

TEST(ToEigenTest, RefusesWhatIsNone) {
  expectError([] { toEigen(makeTransform(NAN, 1.0, 0.0)); }, "the transform contains nan");
  expectError([] { toEigen(makeTransform(0.0, INFINITY, 0.0)); }, "the transform contains inf");
  expectError([] { toEigen(makeTransform(0.0, 0.0, 0.0)); }, "has the length 0, but must have 1");
  expectError([] { toEigen(makeTransform(0.0, 1.0, 1.0)); }, "has the length 1.41421");
}

}  // namespace
}  // namespace rotrocc
