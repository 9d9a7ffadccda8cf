#include "camera_mount.h"

#include <gtest/gtest.h>

#include "kitti_mount.h"

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
            "at 0 0 0 m, looks along +z (up); is its frame an optical one, with z along the view?");
}

TEST(DescribeMountTest, CameraThatLooksDown) {
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  T_base_camera.translation().z() = 12.0;
  T_base_camera.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  EXPECT_EQ(describeMount(T_base_camera), "at 0 0 12 m, looks along -z (down)");
}

}  // namespace
}  // namespace rotrocc
