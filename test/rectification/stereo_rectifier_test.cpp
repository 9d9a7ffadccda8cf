#include "rectification/stereo_rectifier.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

#include "support/expect_error.h"
#include "support/raw_rig.h"

namespace rotrocc {
namespace {

/// Points at 2 to 8 m all over the rectified images, far apart from each other.
std::vector<Eigen::Vector3d> scene() {
  std::vector<Eigen::Vector3d> points;
  for (int row = -2; row <= 2; ++row) {
    for (int column = -3; column <= 3; ++column) {
      const double depth_m = 5.0 + 3.0 * std::sin(7.0 * row + 3.0 * column);
      points.emplace_back(depth_m * Eigen::Vector3d(0.23 * column, 0.2 * row, 1.0));
    }
  }
  return points;
}

/// Where OpenCV says that the pixels of a raw image are in the rectified one.
std::vector<cv::Point2d> rectified(const RawCamera& raw,
                                   const StereoCamera& camera,
                                   const std::vector<cv::Point2d>& pixels) {
  const cv::Matx33d K(raw.fx, 0, raw.cx, 0, raw.fy, raw.cy, 0, 0, 1);
  const cv::Matx33d P(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  cv::Matx33d R;
  cv::eigen2cv(raw.R_rectified_raw, R);
  const std::vector<double>& D = raw.distortion.coefficients();
  std::vector<cv::Point2d> places;
  if (std::string(raw.distortion.name()) == "equidistant") {
    cv::fisheye::undistortPoints(pixels, places, K, D, R, P);
  } else {
    const cv::TermCriteria exact(cv::TermCriteria::MAX_ITER | cv::TermCriteria::EPS, 100, 1e-12);
    cv::undistortPoints(pixels, places, K, D, R, P, exact);
  }
  return places;
}

constexpr double kSigma_px = 2.0;

/// What a raw camera sees of spots at places of the rectified image, where they are round.
cv::Mat drawSpots(const RawCamera& raw,
                  const StereoCamera& camera,
                  const std::vector<Eigen::Vector2d>& spots) {
  std::vector<cv::Point2d> pixels;
  for (int y = 0; y < raw.height; ++y) {
    for (int x = 0; x < raw.width; ++x) pixels.emplace_back(x, y);
  }
  const std::vector<cv::Point2d> places = rectified(raw, camera, pixels);
  cv::Mat image(raw.height, raw.width, CV_8UC1);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    double value = 20.0;
    for (const Eigen::Vector2d& spot : spots) {
      const double square = (Eigen::Vector2d(places[i].x, places[i].y) - spot).squaredNorm();
      value += 220.0 * std::exp(-0.5 * square / (kSigma_px * kSigma_px));
    }
    image.at<uchar>(pixels[i]) = cv::saturate_cast<uchar>(value);
  }
  return image;
}

/// Centre of the spot near a place.
Eigen::Vector2d spotAt(const cv::Mat& image, const Eigen::Vector2d& place) {
  constexpr int kReach_px = 8;
  Eigen::Vector2d centre = place;
  for (int round = 0; round < 3; ++round) {  // the window moves to the spot
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double weights = 0.0;
    const int x0 = static_cast<int>(std::lround(centre.x()));
    const int y0 = static_cast<int>(std::lround(centre.y()));
    for (int y = y0 - kReach_px; y <= y0 + kReach_px; ++y) {
      for (int x = x0 - kReach_px; x <= x0 + kReach_px; ++x) {
        const double weight = std::max(0.0, image.at<uchar>(y, x) - 20.0);
        sum += weight * Eigen::Vector2d(x, y);
        weights += weight;
      }
    }
    centre = sum / weights;
  }
  return centre;
}

StereoCalibration calibrationOf(const RawRig& rig) {
  return chooseRectification(rig.left, rig.right, rig.T_left_right);
}

StereoPair greyPair(int grey, const cv::Size& size = {752, 480}) {
  return {7, cv::Mat(size, CV_8UC1, cv::Scalar(grey)), cv::Mat(size, CV_8UC1, cv::Scalar(grey))};
}

class RectifiesPoints : public ::testing::TestWithParam<const char*> {};

TEST_P(RectifiesPoints, ToTheirExactProjection) {
  const StereoCalibration calibration = calibrationOf(rawRig(GetParam()));
  const StereoCamera& camera = calibration.rectified;
  std::vector<Eigen::Vector2d> left;
  std::vector<Eigen::Vector2d> right;
  for (const Eigen::Vector3d& point : scene()) {
    left.push_back(camera.project(point));
    right.push_back(left.back() - Eigen::Vector2d(camera.disparity(point.z()), 0.0));
  }
  StereoRectifier rectifier(calibration);
  const StereoPair pair = rectifier.rectify(
      {5, drawSpots(calibration.left, camera, left), drawSpots(calibration.right, camera, right)});
  EXPECT_EQ(pair.stamp_ns, 5);
  for (std::size_t i = 0; i < left.size(); ++i) {
    EXPECT_LT((spotAt(pair.left, left[i]) - left[i]).norm(), 0.05) << left[i].transpose();
    EXPECT_LT((spotAt(pair.right, right[i]) - right[i]).norm(), 0.05) << right[i].transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Models,
                         RectifiesPoints,
                         ::testing::Values("radial-tangential", "equidistant"));

TEST(StereoRectifierTest, LeavesRectifiedImagesAsTheyAre) {
  StereoPair pair = greyPair(0);
  cv::randu(pair.left, 0, 255);
  cv::randu(pair.right, 0, 255);
  StereoRectifier rectifier(rectifiedCalibration(calibrationOf(rawRig()).rectified));
  const StereoPair same = rectifier.rectify(pair);
  EXPECT_EQ(cv::norm(pair.left, same.left, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(pair.right, same.right, cv::NORM_INF), 0.0);
}

TEST(StereoRectifierTest, UsesItsMemoryAgain) {
  StereoRectifier rectifier(calibrationOf(rawRig()));
  const StereoPair first = rectifier.rectify(greyPair(10));
  const StereoPair second = rectifier.rectify(greyPair(20));
  EXPECT_EQ(first.left.data, second.left.data);
  EXPECT_EQ(first.right.data, second.right.data);
  EXPECT_EQ(second.right.at<uchar>(100, 100), 20);
}

TEST(StereoRectifierTest, BordersAreNotBlack) {
  StereoCalibration wide = calibrationOf(rawRig());
  wide.rectified.fx = wide.rectified.fy = 200.0;  // shows more than the cameras see
  StereoRectifier rectifier(wide);
  const StereoPair pair = rectifier.rectify(greyPair(77));
  EXPECT_EQ(cv::countNonZero(pair.left != 77), 0);
  EXPECT_EQ(cv::countNonZero(pair.right != 77), 0);
}

TEST(StereoRectifierTest, CubicsStayAsTheyAre) {
  // A sinusoid of 8 px, shifted by fractions: bilinear interpolation is off by 8 grey levels.
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
    StereoRectifier rectifier(shifted);
    const StereoPair pair = rectifier.rectify({0, image, image});
    for (int x = 2; x < image.cols - 3; ++x) {
      EXPECT_NEAR(pair.left.at<uchar>(7, x), wave(x + shift_px), 3.0) << x;
    }
  }
}

TEST(StereoRectifierTest, RefusesOtherImagesAndCalibrations) {
  StereoRectifier rectifier(calibrationOf(rawRig()));
  expectError<std::invalid_argument>(
      [&] {
        rectifier.rectify(greyPair(0, {640, 480}));
      },
      "the left image has 640x480 px, but its calibration is for "
      "752x480 px");
  StereoPair colour = greyPair(0);
  colour.right = cv::Mat(480, 752, CV_8UC3, cv::Scalar::all(0));
  expectError<std::invalid_argument>([&] { rectifier.rectify(colour); }, "the right image");
  StereoCalibration sheared = calibrationOf(rawRig());
  sheared.right.R_rectified_raw(0, 1) += 0.1;
  expectError<std::invalid_argument>(
      [&] { StereoRectifier{sheared}; },
      "the right camera: the rectification matrix R is not a rotation");
}

}  // namespace
}  // namespace rotrocc
