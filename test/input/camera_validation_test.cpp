#include "input/camera_validation.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "input/input_error.h"
#include "input/message_conversion.h"
#include "support/expect_error.h"

namespace rotrocc {
namespace {

constexpr double kFocal = 700.0;
constexpr double kBaseline = 0.54;

sensor_msgs::CameraInfo makeInfo(double baseline_m) {
  sensor_msgs::CameraInfo info;
  info.width = 1226;
  info.height = 370;
  info.P = {kFocal, 0, 601.5, -kFocal * baseline_m, 0, kFocal, 183.25, 0, 0, 0, 1, 0};
  return info;
}

/// Expects a refusal after `change` of one of the two infos.
void expectRefused(const std::function<void(sensor_msgs::CameraInfo&)>& change,
                   const std::string& part) {
  const sensor_msgs::CameraInfo left = makeInfo(0.0);
  const sensor_msgs::CameraInfo right = makeInfo(kBaseline);
  sensor_msgs::CameraInfo changed_left = left;
  sensor_msgs::CameraInfo changed_right = right;
  change(changed_left);
  change(changed_right);
  expectError<InputError>([&] { toStereoCamera(changed_left, right); }, part);
  expectError<InputError>([&] { toStereoCamera(left, changed_right); }, part);
}

TEST(StereoCameraConversionTest, OnlyPCounts) {
  // K, D and R as kitti2bag writes them for raw drives: of the unrectified images.
  sensor_msgs::CameraInfo left = makeInfo(0.0);
  left.K = {984.2, 0, 690.0, 0, 980.8, 233.2, 0, 0, 1};
  left.D = {-0.37, 0.2, 0.001, 0.002, -0.07};
  left.distortion_model = "plumb_bob";
  const StereoCamera camera = toStereoCamera(left, makeInfo(kBaseline));
  EXPECT_EQ(camera.width, 1226);
  EXPECT_EQ(camera.height, 370);
  EXPECT_EQ(camera.fx, kFocal);
  EXPECT_EQ(camera.fy, kFocal);
  EXPECT_EQ(camera.cx, 601.5);
  EXPECT_EQ(camera.cy, 183.25);
  EXPECT_EQ(camera.cx_right, 601.5);
  EXPECT_NEAR(camera.baseline_m, kBaseline, 1e-12);
}

TEST(StereoCameraConversionTest, BaselineIsBetweenTheCameras) {
  // KITTI's colour cameras are 0.06 m to the left and 0.47 m to the right of the origin of P, and
  // differ by millimetres in height.
  sensor_msgs::CameraInfo left = makeInfo(-0.06);
  sensor_msgs::CameraInfo right = makeInfo(0.47);
  left.P[7] = 0.2;
  right.P[7] = 2.2;
  left.P[11] = right.P[11] = 0.0027;
  EXPECT_NEAR(toStereoCamera(left, right).baseline_m, 0.53, 1e-12);
}

TEST(StereoCameraConversionTest, PrincipalPointsMayDifferAlongX) {
  sensor_msgs::CameraInfo right = makeInfo(kBaseline);
  right.P[2] = 610.0;
  const StereoCamera camera = toStereoCamera(makeInfo(0.0), right);
  EXPECT_EQ(camera.cx, 601.5);
  EXPECT_EQ(camera.cx_right, 610.0);
}

TEST(StereoCameraConversionTest, BinningAndRegionOfInterest) {
  sensor_msgs::CameraInfo left = makeInfo(0.0);
  sensor_msgs::CameraInfo right = makeInfo(kBaseline);
  for (sensor_msgs::CameraInfo* info : {&left, &right}) {
    info->binning_x = 2;
    info->binning_y = 4;
    info->roi.x_offset = 100;
    info->roi.y_offset = 40;
    info->roi.width = 1000;
    info->roi.height = 300;
  }
  const StereoCamera camera = toStereoCamera(left, right);
  EXPECT_EQ(camera.width, 500);
  EXPECT_EQ(camera.height, 75);
  EXPECT_EQ(camera.fx, kFocal / 2);
  EXPECT_EQ(camera.fy, kFocal / 4);
  EXPECT_EQ(camera.cx, (601.5 - 100) / 2);
  EXPECT_EQ(camera.cy, (183.25 - 40) / 4);
  EXPECT_NEAR(camera.baseline_m, kBaseline, 1e-12);
}

TEST(StereoCameraConversionTest, RefusesWhatIsNoRectifiedCamera) {
  using Info = sensor_msgs::CameraInfo;
  expectRefused([](Info& info) { info.P.fill(0.0); }, "is all zeros: the camera is not calibrated");
  expectRefused([](Info& info) { info.P[2] = NAN; }, "P[2] of the");
  expectRefused([](Info& info) { info.P[3] = INFINITY; }, "camera_info is inf");
  expectRefused([](Info& info) { info.P[0] = -700.0; }, "P[0] = -700");
  expectRefused([](Info& info) { info.P[5] = 0.0; }, "P[5] = 0 px");
  expectRefused([](Info& info) { info.P[1] = 3.0; }, "P[1] = 3");
  expectRefused([](Info& info) { info.P[10] = 0.0; }, "P[10] = 0");
  expectRefused([](Info& info) { info.width = 640; }, "640x370 px");
  expectRefused([](Info& info) { info.P[0] = 705.0; }, "fx is 70");
  expectRefused([](Info& info) { info.P[5] = 705.0; }, "fy is 70");
  expectRefused([](Info& info) { info.P[6] = 190.0; }, "cy is 1");
  expectRefused([](Info& info) { info.roi.y_offset = 7; }, "cy is 1");
  expectRefused([](Info& info) { info.P[7] = 300.0; }, "side by side");
}

TEST(StereoCameraConversionTest, RefusesABaselineThatIsNotPositive) {
  expectError<InputError>([] { toStereoCamera(makeInfo(0.0), makeInfo(0.0)); },
                          "the baseline is zero: P[3] of camera_info, which is -fx times the "
                          "camera's position, is 0 left and 0 right");
  expectError<InputError>([] { toStereoCamera(makeInfo(0.5), makeInfo(0.0)); },
                          "are left and right swapped?");
}

TEST(StereoCameraConversionTest, AnotherBaselineMayBeTold) {
  EXPECT_EQ(toStereoCamera(makeInfo(0.0), makeInfo(0.0), 0.12).baseline_m, 0.12);
  EXPECT_EQ(toStereoCamera(makeInfo(0.0), makeInfo(kBaseline), 0.12).baseline_m, 0.12);
}

TEST(StereoCameraConversionTest, UnlikelyBaselinesAreNamed) {
  EXPECT_EQ(oddityOf(toStereoCamera(makeInfo(0.0), makeInfo(kBaseline))), "");
  EXPECT_NE(oddityOf(toStereoCamera(makeInfo(0.0), makeInfo(120.0))).find("a baseline of 120 m"),
            std::string::npos);
  EXPECT_NE(oddityOf(toStereoCamera(makeInfo(0.0), makeInfo(0.0004))).find("0.0004 m"),
            std::string::npos);
}

TEST(StereoCameraConversionTest, RefusesASizeOfZero) {
  sensor_msgs::CameraInfo left = makeInfo(0.0);
  sensor_msgs::CameraInfo right = makeInfo(kBaseline);
  left.width = right.width = 0;
  expectError<InputError>([&] { toStereoCamera(left, right); }, "width is 0");
}

TEST(StampConversionTest, KeepsEveryNanosecond) {
  const ros::Time stamp(1'317'384'506, 123'456'789);
  EXPECT_EQ(toNanoseconds(stamp), 1'317'384'506'123'456'789);
  EXPECT_EQ(toRosTime(toNanoseconds(stamp)), stamp);
}

}  // namespace
}  // namespace rotrocc
