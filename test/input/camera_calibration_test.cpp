#include "input/camera_calibration.h"

#include <limits>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include "input/input_error.h"
#include "support/expect_error.h"

namespace rotrocc {
namespace {

using Info = sensor_msgs::CameraInfo;

/// Of a camera that is not rectified, at a time of its own.
boost::shared_ptr<Info> makeInfo(double stamp_s, double baseline_m) {
  const auto info = boost::make_shared<Info>();
  info->header.stamp = ros::Time(stamp_s);
  info->width = 620;
  info->height = 188;
  info->distortion_model = "plumb_bob";
  info->D = {-0.3, 0.1, 0.0, 0.0, 0.0};
  info->K = {350, 0, 300, 0, 350, 90, 0, 0, 1};
  info->R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info->P = {360, 0, 310, -360 * baseline_m, 0, 360, 94, 0, 0, 0, 1, 0};
  return info;
}

TEST(CurrentCalibrationTest, IsTheSameUntilACameraChanges) {
  CurrentCalibration current(0.0);
  const auto right = makeInfo(1.0, 0.5);
  const auto first = current.of(makeInfo(1.0, 0.0), right);
  EXPECT_EQ(first->left.fx, 350.0);
  EXPECT_EQ(first->rectified.baseline_m, 0.5);
  EXPECT_EQ(current.of(makeInfo(2.0, 0.0), makeInfo(2.0, 0.5)), first);
  const auto changed = makeInfo(3.0, 0.5);
  changed->D[0] = -0.2;
  const auto second = current.of(makeInfo(3.0, 0.0), changed);
  EXPECT_NE(second, first);
  EXPECT_EQ(second->right.distortion.coefficients()[0], -0.2);
  EXPECT_EQ(first->right.distortion.coefficients()[0], -0.3);
}

TEST(CurrentCalibrationTest, OutlivesAnInvalidMessage) {
  CurrentCalibration current(0.2);
  const auto left = makeInfo(1.0, 0.0);
  const auto invalid = makeInfo(1.0, 0.5);
  invalid->K[4] = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 2; ++i) {
    expectError<InputError>([&] { current.of(left, invalid); },
                            "K of the right camera_info has focal lengths 350 and nan px");
  }
  EXPECT_EQ(current.of(left, makeInfo(1.0, 0.5))->rectified.baseline_m, 0.2);
}

TEST(CameraCalibrationTest, NamesWhatIsWrong) {
  const auto left = makeInfo(1.0, 0.0);
  const auto expectRefused = [&](const Info& right, const std::string& part) {
    expectError<InputError>([&] { toStereoCalibration(*left, right); }, part);
  };
  auto right = makeInfo(1.0, 0.5);
  right->distortion_model = "tilted";
  expectRefused(*right, "D of the right camera_info: the distortion model 'tilted'");
  right = makeInfo(1.0, 0.5);
  right->D.resize(3);
  expectRefused(*right, "D of the right camera_info: the distortion plumb_bob has 3 coefficients");
  right = makeInfo(1.0, 0.5);
  right->R.fill(0.0);
  expectRefused(*right, "the right camera_info: the rectification matrix R is not a rotation");
  right = makeInfo(1.0, 0.5);
  right->width = 600;
  expectRefused(*right, "the right one for 600x188");
}

}  // namespace
}  // namespace rotrocc
