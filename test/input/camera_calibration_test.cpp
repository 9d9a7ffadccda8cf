#include "input/camera_calibration.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "input/input_error.h"
#include "support/expect_error.h"

namespace rotrocc {
namespace {

using Info = sensor_msgs::CameraInfo;

constexpr double kFocal = 700.0;
constexpr double kBaseline = 0.54;

Info makeRectifiedInfo(double baseline_m) {
  Info info;
  info.width = 1226;
  info.height = 370;
  info.K = {984.2, 0, 690, 0, 980.8, 233.2, 0, 0, 1};  // of the raw images
  info.D = {-0.37, 0.2, 0.001, 0.002, -0.07};
  info.P = {kFocal, 0, 601.5, -kFocal * baseline_m, 0, kFocal, 183.25, 0, 0, 0, 1, 0};
  return info;
}

TEST(StereoCameraConversionTest, TakesTheNumbersOfP) {
  Info right = makeRectifiedInfo(kBaseline);
  right.P[2] = 610.0;
  const StereoCamera camera = toStereoCamera(makeRectifiedInfo(0.0), right);
  EXPECT_EQ(camera.width, 1226);
  EXPECT_EQ(camera.height, 370);
  EXPECT_EQ(camera.fx, kFocal);
  EXPECT_EQ(camera.fy, kFocal);
  EXPECT_EQ(camera.cx, 601.5);
  EXPECT_EQ(camera.cy, 183.25);
  EXPECT_EQ(camera.cx_right, 610.0);
  EXPECT_NEAR(camera.baseline_m, kBaseline, 1e-12);
  EXPECT_EQ(toStereoCamera(makeRectifiedInfo(0.0), right, 0.12).baseline_m, 0.12);
}

TEST(StereoCameraConversionTest, BaselineIsBetweenTheCameras) {
  // KITTI's colour cameras are 0.06 m to the left and 0.47 m to the right of the origin of P, and
  // differ by millimetres in height.
  Info left = makeRectifiedInfo(-0.06);
  Info right = makeRectifiedInfo(0.47);
  left.P[7] = 0.2;
  right.P[7] = 2.2;
  left.P[11] = right.P[11] = 0.0027;
  EXPECT_NEAR(toStereoCamera(left, right).baseline_m, 0.53, 1e-12);
}

TEST(StereoCameraConversionTest, BinningAndRegionOfInterest) {
  Info left = makeRectifiedInfo(0.0);
  Info right = makeRectifiedInfo(kBaseline);
  for (Info* info : {&left, &right}) {
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

/// Other refusals are rows of BadInputsTest.
TEST(StereoCameraConversionTest, RefusesWhatIsNoRectifiedCamera) {
  const struct {
    std::function<void(Info&)> change;
    const char* part;
  } kCases[] = {{[](Info& info) { info.P[1] = 3.0; }, "P[1] = 3"},
                {[](Info& info) { info.P[5] = 0.0; }, "P[5] = 0 px"},
                {[](Info& info) { info.P[10] = 0.0; }, "P[10] = 0"},
                {[](Info& info) { info.width = 640; }, "640x370 px"},
                {[](Info& info) { info.P[0] = 705.0; }, "fx is 70"},
                {[](Info& info) { info.P[6] = 190.0; }, "cy is 1"},
                {[](Info& info) { info.roi.y_offset = 7; }, "cy is 1"},
                {[](Info& info) { info.P[7] = 300.0; }, "side by side"}};
  for (const auto& [change, part] : kCases) {
    Info left = makeRectifiedInfo(0.0), right = makeRectifiedInfo(kBaseline);
    change(left);
    expectError<InputError>([&] { toStereoCamera(left, right); }, part);
    left = makeRectifiedInfo(0.0);
    change(right);
    expectError<InputError>([&] { toStereoCamera(left, right); }, part);
  }
  Info left = makeRectifiedInfo(0.0), right = makeRectifiedInfo(kBaseline);
  left.width = right.width = 0;
  expectError<InputError>([&] { toStereoCamera(left, right); }, "width is 0");
}

/// Of a camera that is not rectified, at a time of its own.
Info makeInfo(double stamp_s, double baseline_m) {
  Info info;
  info.header.stamp = ros::Time(stamp_s);
  info.width = 620;
  info.height = 188;
  info.distortion_model = "plumb_bob";
  info.D = {-0.3, 0.1, 0.0, 0.0, 0.0};
  info.K = {350, 0, 300, 0, 350, 90, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {360, 0, 310, -360 * baseline_m, 0, 360, 94, 0, 0, 0, 1, 0};
  return info;
}

TEST(SameCameraTest, DiffersByMoreThanTheStampAndWhatNoPixelShows) {
  const Info info = makeInfo(1.0, 0.5);
  Info other = makeInfo(2.0, 0.5);
  EXPECT_TRUE(isSameCamera(info, other));
  other.K[0] *= 1.0 + 1e-9;
  EXPECT_TRUE(isSameCamera(info, other));
  other.D[0] = -0.2;
  EXPECT_FALSE(isSameCamera(info, other));
}

TEST(StereoCalibrationTest, HasTheLensesAndTheRectifiedCamera) {
  const StereoCalibration calibration = toStereoCalibration(makeInfo(1.0, 0.0), makeInfo(1.0, 0.5));
  EXPECT_EQ(calibration.left.fx, 350.0);
  EXPECT_EQ(calibration.right.distortion.coefficients()[0], -0.3);
  EXPECT_EQ(calibration.rectified.baseline_m, 0.5);
}

TEST(StereoCalibrationTest, ALensWithoutAModelDistortsNothing) {
  Info left = makeInfo(1.0, 0.0);
  left.distortion_model.clear();
  left.D.clear();
  EXPECT_TRUE(toStereoCalibration(left, makeInfo(1.0, 0.5)).left.distortion.isNone());
}

TEST(StereoCalibrationTest, NeedsFocalLengths) {
  Info invalid = makeInfo(1.0, 0.5);
  invalid.K[4] = std::numeric_limits<double>::quiet_NaN();
  expectError<InputError>([&] { toStereoCalibration(makeInfo(1.0, 0.0), invalid, 0.2); },
                          "K of the right camera_info has focal lengths 350 and nan px");
}

}  // namespace
}  // namespace rotrocc
