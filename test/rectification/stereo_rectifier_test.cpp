#include "rectification/stereo_rectifier.h"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

#include "support/raw_rig.h"

namespace rotrocc {
namespace {

/// What OpenCV makes of a raw image.
cv::Mat byOpenCv(const RawCamera& raw,
                 const StereoCamera& camera,
                 double cx,
                 const cv::Mat& image) {
  const cv::Matx33d K(raw.fx, 0, raw.cx, 0, raw.fy, raw.cy, 0, 0, 1);
  const cv::Matx33d P(camera.fx, 0, cx, 0, camera.fy, camera.cy, 0, 0, 1);
  cv::Matx33d R;
  cv::eigen2cv(raw.R_rectified_raw, R);
  const std::vector<double>& D = raw.distortion.coefficients();
  const cv::Size size(camera.width, camera.height);
  cv::Mat x, y, rectified;
  if (std::string(raw.distortion.name()) == "equidistant") {
    cv::fisheye::initUndistortRectifyMap(K, D, R, P, size, CV_32FC1, x, y);
  } else {
    cv::initUndistortRectifyMap(K, D, R, P, size, CV_32FC1, x, y);
  }
  cv::remap(image, rectified, x, y, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  return rectified;
}

StereoCalibration calibrationOf(const RawRig& rig) {
  return chooseRectification(rig.left, rig.right, rig.T_left_right);
}

StereoPair rectify(const StereoPair& raw, const StereoCalibration& calibration) {
  return StereoRectifier().rectify(raw, std::make_shared<const StereoCalibration>(calibration));
}

StereoPair grayPair(int gray, const cv::Size& size = {752, 480}) {
  return {7, cv::Mat(size, CV_8UC1, cv::Scalar(gray)), cv::Mat(size, CV_8UC1, cv::Scalar(gray))};
}

StereoPair noise() {
  StereoPair pair = grayPair(0);
  cv::randu(pair.left, 0, 255);
  cv::randu(pair.right, 0, 255);
  return pair;
}

bool isSame(const StereoPair& a, const StereoPair& b) {
  return a.stamp_ns == b.stamp_ns && cv::norm(a.left, b.left, cv::NORM_INF) == 0.0 &&
         cv::norm(a.right, b.right, cv::NORM_INF) == 0.0;
}

TEST(StereoRectifierTest, PutsPixelsWhereOpenCvPutsThem) {
  for (const char* model : {"radial-tangential", "equidistant"}) {
    const StereoCalibration calibration = calibrationOf(rawRig(model));
    const StereoCamera& camera = calibration.rectified;
    StereoPair raw = noise();
    // Smooth, so that pixels differ by the places and not by the interpolation; 10 levels per px.
    for (cv::Mat* image : {&raw.left, &raw.right}) {
      cv::GaussianBlur(*image, *image, {0, 0}, 2.0);
      cv::normalize(*image, *image, 0, 255, cv::NORM_MINMAX);
    }
    const StereoPair pair = rectify(raw, calibration);
    const cv::Mat left = byOpenCv(calibration.left, camera, camera.cx, raw.left);
    const cv::Mat right = byOpenCv(calibration.right, camera, camera.cx_right, raw.right);
    EXPECT_LT(cv::norm(pair.left, left, cv::NORM_L1) / camera.width / camera.height, 0.5) << model;
    EXPECT_LT(cv::norm(pair.right, right, cv::NORM_L1) / camera.width / camera.height, 0.5)
        << model;
    EXPECT_LE(cv::norm(pair.left, left, cv::NORM_INF), 4.0) << model;
    EXPECT_LE(cv::norm(pair.right, right, cv::NORM_INF), 4.0) << model;
  }
}

TEST(StereoRectifierTest, LeavesRectifiedImagesAsTheyAre) {
  const StereoPair pair = noise();
  const StereoCamera camera = calibrationOf(rawRig()).rectified;
  EXPECT_TRUE(isSame(rectify(pair, rectifiedCalibration(camera)), pair));
}

TEST(StereoRectifierTest, FollowsTheCalibrationOfThePairAndUsesItsMemoryAgain) {
  const auto first = std::make_shared<const StereoCalibration>(calibrationOf(rawRig()));
  auto turned = *first;
  turned.left.R_rectified_raw = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitX()).matrix();
  const auto second = std::make_shared<const StereoCalibration>(turned);
  const StereoPair raw = noise();
  StereoRectifier rectifier;
  for (const auto& current : {first, first, second, first}) {
    EXPECT_TRUE(isSame(rectifier.rectify(raw, current), rectify(raw, *current)));
  }
  const StereoPair result = rectifier.rectify(raw, first);
  EXPECT_EQ(rectifier.rectify(raw, first).left.data, result.left.data);
}

TEST(StereoRectifierTest, MasksCoverWhatTheyCoverInTheRawImages) {
  StereoPair raw = grayPair(0);
  const cv::Rect left_body(0, 400, 752, 80), right_body(500, 100, 60, 40);
  raw.left(left_body).setTo(255);
  raw.right(right_body).setTo(255);
  raw.left_mask = raw.left.clone();
  raw.right_mask = raw.right.clone();
  const auto calibration = std::make_shared<const StereoCalibration>(calibrationOf(rawRig()));
  StereoRectifier rectifier;
  const StereoPair pair = rectifier.rectify(raw, calibration);
  EXPECT_EQ(cv::norm(pair.left_mask, pair.left > 0, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(pair.right_mask, pair.right > 0, cv::NORM_INF), 0.0);
  EXPECT_GT(cv::countNonZero(pair.right_mask), 1000);
  EXPECT_EQ(rectifier.rectify(raw, calibration).left_mask.data, pair.left_mask.data) << "kept";

  const cv::Mat before = pair.left_mask.clone();
  raw.left_mask = cv::Mat(raw.left.size(), CV_8UC1, cv::Scalar(0));
  EXPECT_EQ(cv::countNonZero(rectifier.rectify(raw, calibration).left_mask), 0);
  EXPECT_EQ(cv::norm(pair.left_mask, before, cv::NORM_INF), 0.0) << "those of others do not change";
  raw.left_mask = cv::Mat();
  EXPECT_TRUE(rectifier.rectify(raw, calibration).left_mask.empty());
}

TEST(StereoRectifierTest, BordersAreNotBlack) {
  StereoCalibration wide = calibrationOf(rawRig());
  wide.rectified.fx = wide.rectified.fy = 200.0;  // shows more than the cameras see
  const StereoPair pair = rectify(grayPair(77), wide);
  EXPECT_EQ(cv::countNonZero(pair.left != 77), 0);
  EXPECT_EQ(cv::countNonZero(pair.right != 77), 0);
}

TEST(StereoRectifierTest, CubicsStayAsTheyAre) {
  // A sinusoid of 8 px, shifted by fractions: bilinear interpolation is off by 8 gray levels.
  StereoCamera camera;
  camera.width = 120;
  camera.height = 20;
  camera.fx = camera.fy = 100.0;
  camera.cx = camera.cx_right = 60.0;
  camera.cy = 10.0;
  camera.baseline_m = 0.1;
  const auto wave = [](double x) { return 128.0 + 100.0 * std::sin(2.0 * M_PI / 8.0 * x); };
  cv::Mat image(camera.height, camera.width, CV_8UC1);
  for (int x = 0; x < image.cols; ++x) image.col(x) = std::lround(wave(x));
  for (const double shift_px : {0.25, 0.5, 0.9}) {
    StereoCalibration shifted = rectifiedCalibration(camera);
    shifted.rectified.cx -= shift_px;
    const StereoPair pair = rectify({0, image, image}, shifted);
    for (int x = 2; x < image.cols - 3; ++x) {
      EXPECT_NEAR(pair.left.at<uchar>(7, x), wave(x + shift_px), 3.0) << x;
    }
  }
}

}  // namespace
}  // namespace rotrocc
