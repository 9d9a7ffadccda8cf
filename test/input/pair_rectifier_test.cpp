#include "input/pair_rectifier.h"

#include <memory>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "input/input_error.h"
#include "support/expect_error.h"
#include "support/raw_rig.h"

namespace rotrocc {
namespace {

std::shared_ptr<const StereoCalibration> calibration() {
  const RawRig rig = rawRig();
  return std::make_shared<const StereoCalibration>(
      chooseRectification(rig.left, rig.right, rig.T_left_right));
}

StereoPair noise(const StereoCamera& camera) {
  StereoPair pair = {3,
                     cv::Mat(camera.height, camera.width, CV_8UC1),
                     cv::Mat(camera.height, camera.width, CV_8UC1)};
  cv::randu(pair.left, 0, 255);
  cv::randu(pair.right, 0, 255);
  return pair;
}

bool isSame(const StereoPair& a, const StereoPair& b) {
  return a.stamp_ns == b.stamp_ns && cv::norm(a.left, b.left, cv::NORM_INF) == 0.0 &&
         cv::norm(a.right, b.right, cv::NORM_INF) == 0.0;
}

TEST(PairRectifierTest, RectifiesByTheCalibrationOfThePair) {
  const auto first = calibration();
  auto turned = *first;
  turned.left.R_rectified_raw = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitX()).matrix();
  const auto second = std::make_shared<const StereoCalibration>(turned);
  const StereoPair raw = noise(first->rectified);
  PairRectifier rectifier;
  PairRectifier alone(1);
  for (const auto& current : {first, first, second, first}) {
    const StereoPair expected = StereoRectifier(*current).rectify(raw);
    EXPECT_TRUE(isSame(rectifier.rectify(raw, current), expected));
    EXPECT_TRUE(isSame(alone.rectify(raw, current), expected));
  }
  const StereoPair result = rectifier.rectify(raw, first);
  EXPECT_EQ(rectifier.rectify(raw, first).left.data, result.left.data) << "memory is used again";
}

TEST(PairRectifierTest, RefusesImagesThatAreTooLargeForItsMaps) {
  auto wide = *calibration();
  wide.left.width = 40000;
  expectError<InputError>(
      [&] { PairRectifier().rectify({}, std::make_shared<const StereoCalibration>(wide)); },
      "the calibration of the left camera: its images are larger than 32000 px");
}

}  // namespace
}  // namespace rotrocc
