#include "input/camera_calibration.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "input/input_error.h"
#include "input/sent_calibration.h"
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
  // KITTI's color cameras are 0.06 m to the left and 0.47 m to the right of the origin of P, and
  // differ by millimeters in height.
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

/// The numbers of `sent` in an info of an image that is larger by binning and region of interest.
Info asSent(double baseline_m, unsigned binning, unsigned x_offset, unsigned y_offset) {
  Info info = makeRectifiedInfo(baseline_m);
  info.binning_x = info.binning_y = binning;
  info.roi.x_offset = x_offset;
  info.roi.y_offset = y_offset;
  if (x_offset + y_offset > 0) {
    info.roi.width = info.width * binning;
    info.roi.height = info.height * binning;
  }
  info.width = info.width * binning + 2 * x_offset;
  info.height = info.height * binning + 2 * y_offset;
  return info;
}

TEST(StereoCameraConversionTest, SomeDriversGiveTheMatricesOfTheImagesThatTheySend) {
  const StereoCamera expected =
      toStereoCamera(makeRectifiedInfo(0.0), makeRectifiedInfo(kBaseline));
  const struct {
    unsigned binning, x_offset, y_offset;
    const char* warning;
  } kCases[] = {{2, 0, 0, "that of the binned image,"},
                {4, 0, 0, "that of the binned image,"},
                {1, 400, 100, "that of the image in roi,"},
                {2, 800, 200, "that of the binned image in roi,"}};
  for (const auto& row : kCases) {
    const Info left = asSent(0.0, row.binning, row.x_offset, row.y_offset);
    const Info right = asSent(kBaseline, row.binning, row.x_offset, row.y_offset);
    const StereoCamera camera = toStereoCamera(left, right);
    EXPECT_EQ(camera.differenceTo(expected), 0.0) << row.warning;
    EXPECT_NE(calibrationWarning(left, camera).find(row.warning), std::string::npos)
        << calibrationWarning(left, camera);
  }
}

TEST(StereoCameraConversionTest, RejectsTheCalibrationOfAnotherSize) {
  const struct {
    double width, height;
    const char* part;
  } kCases[] = {{0.5, 0.5, "at (601.5, 183.2) px of images of 613x185 px, as that of images 1.97"},
                {0.4, 0.4, "outside of images of 490x148 px, as that of images 2.47 times"},
                {0.75, 0.75, "as that of images 1.32 times as large"},
                {2.0, 2.0, "as that of images 0.493 times as large"},
                {0.45, 1.0, "outside of images of 551x370 px: give the calibration"}};
  for (const auto& row : kCases) {
    Info left = makeRectifiedInfo(0.0), right = makeRectifiedInfo(kBaseline);
    for (Info* info : {&left, &right}) {
      info->width = static_cast<unsigned>(row.width * info->width);
      info->height = static_cast<unsigned>(row.height * info->height);
    }
    expectError<InputError>([&] { toStereoCamera(left, right); }, row.part);
    for (Info* info : {&left, &right}) {  // a part of a larger image is what it is
      info->roi.width = info->width;
      info->roi.height = info->height;
      info->width = 1226;
      info->height = 370;
    }
    if (row.width > 1.0) continue;
    EXPECT_NO_THROW(toStereoCamera(left, right));
  }
  Info left = makeInfo(1.0, 0.0);
  left.K[2] = 600.0, left.K[5] = 180.0;
  expectError<InputError>([&] { toStereoCalibration(left, makeInfo(1.0, 0.5)); },
                          "K of the left camera_info has its principal point at (600.0, 180.0)");
}

TEST(CalibrationWarningTest, NamesWhatIsUnlikely) {
  const Info info = makeRectifiedInfo(0.0);
  const StereoCamera camera = toStereoCamera(info, makeRectifiedInfo(kBaseline));
  EXPECT_EQ(calibrationWarning(info, camera), "");
  const auto expectWarning = [&](double StereoCamera::*value, double number, const char* part) {
    StereoCamera other = camera;
    other.*value = number;
    EXPECT_NE(calibrationWarning(info, other).find(part), std::string::npos)
        << calibrationWarning(info, other);
  };
  expectWarning(
      &StereoCamera::cy, 290.0, "(601.5, 290.0) px is far from the middle of 1226x370 px");
  expectWarning(&StereoCamera::fx, 7070.0, "with fx 7070 px, the images show 9.91 degrees");
  expectWarning(&StereoCamera::fx, 100.0, "show 161 degrees");
  expectWarning(&StereoCamera::fy, 350.0, "the focal lengths 700 and 350 px differ");
  for (const double usual_m : {0.018, 0.54}) EXPECT_EQ(baselineWarning(usual_m), "");
  for (const double unusual_m : {7.5, 0.0054}) {
    EXPECT_NE(baselineWarning(unusual_m).find(" m is unusual"), std::string::npos);
  }
}

TEST(RectifiedImagesTest, AreToldByTheLastPartOfTheirTopic) {
  for (const char* topic : {"/stereo/left/image_rect",
                            "/left/image_rect_color/compressed",
                            "/camera/infra1/image_rect_raw",
                            "/kitti/camera_gray_left/image_raw"}) {
    EXPECT_TRUE(isRectifiedByName(topic)) << topic;
  }
  for (const char* topic : {"/left/image_raw",
                            "/left/image_unrect",
                            "/direct_drive/left/image_raw",
                            "/image_rect/left"}) {
    EXPECT_FALSE(isRectifiedByName(topic)) << topic;
  }
}

/// Other refusals are rows of BadInputsTest.
TEST(StereoCameraConversionTest, RejectsWhatIsNoRectifiedCamera) {
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

TEST(StereoCalibrationTest, RectifiedImagesNeedNoR) {
  Info left = makeRectifiedInfo(0.0), right = makeRectifiedInfo(kBaseline);
  for (Info* info : {&left, &right}) {
    info->K = {kFocal, 0, 601.5, 0, kFocal, 183.25, 0, 0, 1};
    info->D.assign(12, 0.0);
    info->distortion_model = "none";
  }
  EXPECT_FALSE(describeRawImages(left, right)) << "R is all zeros";
  left.D[0] = 0.1;
  left.distortion_model = "plumb_bob";
  expectError<InputError>([&] { toStereoCalibration(left, right); }, "R is not a rotation");
  EXPECT_TRUE(describeRawImages(left, right));
}

TEST(StereoCalibrationTest, NeedsFocalLengths) {
  Info invalid = makeInfo(1.0, 0.5);
  invalid.K[4] = std::numeric_limits<double>::quiet_NaN();
  expectError<InputError>([&] { toStereoCalibration(makeInfo(1.0, 0.0), invalid, 0.2); },
                          "K of the right camera_info has focal lengths 350 and nan px");
}

}  // namespace
}  // namespace rotrocc
