#include "rectification/stereo_calibration.h"

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "support/expect_error.h"
#include "support/raw_rig.h"

namespace rotrocc {
namespace {

StereoCalibration choose(const RawRig& rig) {
  return chooseRectification(rig.left, rig.right, rig.T_left_right);
}

/// That of EuRoC in config/cameras is of cv::stereoRectify.
TEST(StereoCalibrationTest, RotationsAndBaselineAreThoseOfOpenCv) {
  const auto read = [](const std::string& camera, const char* matrix) {
    const YAML::Node file = YAML::LoadFile(ROTROCC_CONFIG_DIR "/cameras/euroc_" + camera + ".yaml");
    return file[matrix]["data"].as<std::vector<double>>();
  };
  const auto rotation = [&](const char* camera) -> Eigen::Matrix3d {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
        read(camera, "rectification_matrix").data());
  };
  const StereoCalibration calibration = choose(rawRig());
  EXPECT_TRUE(calibration.left.R_rectified_raw.isApprox(rotation("left"), 1e-7));
  EXPECT_TRUE(calibration.right.R_rectified_raw.isApprox(rotation("right"), 1e-7));
  const std::vector<double> P = read("right", "projection_matrix");
  EXPECT_NEAR(calibration.rectified.baseline_m, -P[3] / P[0], 1e-7);
}

TEST(StereoCalibrationTest, PointsAreInTheSameRowAndAtTheirDisparity) {
  for (const char* model : {"radial-tangential", "equidistant"}) {
    const RawRig rig = rawRig(model);
    const StereoCalibration calibration = choose(rig);
    const StereoCamera& camera = calibration.rectified;
    const Eigen::Vector3d point(0.7, -0.4, 3.0);  // in the frame of the left raw camera
    const Eigen::Vector3d left = calibration.left.R_rectified_raw * point;
    const Eigen::Vector3d right =
        calibration.right.R_rectified_raw * (rig.T_left_right.inverse() * point);
    EXPECT_LT((left - Eigen::Vector3d(camera.baseline_m, 0.0, 0.0) - right).norm(), 1e-9);
  }
}

TEST(StereoCalibrationTest, BothCamerasSeeAllOfTheLargestImage) {
  for (const char* model : {"radial-tangential", "equidistant"}) {
    const StereoCalibration calibration = choose(rawRig(model));
    const StereoCamera& camera = calibration.rectified;
    EXPECT_EQ(camera.width, 752);
    EXPECT_EQ(camera.height, 480);
    double margin_px = 1e9;  // from a border of a raw image
    for (const RawCamera* raw : {&calibration.left, &calibration.right}) {
      std::vector<Eigen::Vector3d> rays;
      for (int i = 0; i < camera.width * camera.height; ++i) {
        const Eigen::Vector2d pixel(i % camera.width, i / camera.width);
        rays.push_back(raw->R_rectified_raw.transpose() * camera.ray(pixel));
      }
      for (const cv::Point2d& p : raw->project(rays)) {
        margin_px = std::min({margin_px, p.x, p.y, raw->width - 1 - p.x, raw->height - 1 - p.y});
      }
    }
    EXPECT_GE(margin_px, 0.0) << model;
    EXPECT_LT(margin_px, 0.01) << model << ": there is a larger one";
    EXPECT_GT(camera.fx, 0.85 * 458.0);
    EXPECT_LT(camera.fx, 458.0);
  }
}

TEST(StereoCalibrationTest, WideLensesKeepTheirResolution) {
  RawRig rig = rawRig("equidistant");
  for (RawCamera* camera : {&rig.left, &rig.right}) camera->fx = camera->fy = 190.0;
  EXPECT_DOUBLE_EQ(choose(rig).rectified.fx, 0.7 * 190.0);
}

TEST(StereoCalibrationTest, KnowsWhatIsRectified) {
  EXPECT_FALSE(choose(rawRig()).isRectified());
  StereoCamera camera = choose(rawRig()).rectified;
  camera.cx_right = camera.cx - 3.0;
  EXPECT_TRUE(rectifiedCalibration(camera).isRectified());
  StereoCalibration turned = rectifiedCalibration(camera);
  turned.right.R_rectified_raw = Eigen::AngleAxisd(1e-3, Eigen::Vector3d::UnitX());
  EXPECT_FALSE(turned.isRectified());
  StereoCalibration zoomed = rectifiedCalibration(camera);
  zoomed.left.fx += 1.0;
  EXPECT_FALSE(zoomed.isRectified());
}

TEST(StereoCalibrationTest, RejectsCamerasThatAreNoPair) {
  const struct {
    std::function<void(RawRig&)> change;
    const char* part;
  } kCases[] = {
      {[](RawRig& rig) { rig.T_left_right = rig.T_left_right.inverse(); },
       "are left and right swapped"},
      {[](RawRig& rig) { rig.T_left_right.translation() << 0.0, 0.1, 0.0; },
       "must be to its right"},
      {[](RawRig& rig) { rig.T_left_right.translation().setZero(); }, "the baseline is zero"},
      {[](RawRig& rig) { rig.T_left_right.rotate(Eigen::AngleAxisd(3, Eigen::Vector3d::UnitY())); },
       "turned against the left one by 17"},
      {[](RawRig& rig) { rig.right.width = 640; }, "752x480 px, the right one 640x480 px"},
      {[](RawRig& rig) { rig.left.fy = 0.0; }, "fy is 0, but must be positive"},
      {[](RawRig& rig) { rig.right.cx = -4000.0; }, "share no view"}};
  for (const auto& [change, part] : kCases) {
    RawRig rig = rawRig();
    change(rig);
    expectError<std::invalid_argument>([&] { choose(rig); }, part);
  }
}

}  // namespace
}  // namespace rotrocc
