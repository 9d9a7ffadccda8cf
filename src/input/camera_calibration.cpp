#include "input/camera_calibration.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "input/camera_validation.h"
#include "input/input_error.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

RawCamera toRawCamera(const std::string& side, const sensor_msgs::CameraInfo& info) {
  const auto& K = info.K;
  const double binning_x = std::max(info.binning_x, 1u);
  const double binning_y = std::max(info.binning_y, 1u);
  if (!(K[0] > 0.0 && K[4] > 0.0)) {
    refuseCameraInfo("K of the " + side + " camera_info has focal lengths " + toText(K[0]) +
                     " and " + toText(K[4]) +
                     " px, but rectification needs them: calibrate the camera");
  }
  RawCamera raw;
  raw.fx = K[0] / binning_x;
  raw.fy = K[4] / binning_y;
  raw.cx = (K[2] - info.roi.x_offset) / binning_x;
  raw.cy = (K[5] - info.roi.y_offset) / binning_y;
  raw.R_rectified_raw = Eigen::Map<const Matrix3>(info.R.data());
  try {
    // Drivers without a calibration leave the name empty.
    raw.distortion = {info.distortion_model.empty() ? "plumb_bob" : info.distortion_model, info.D};
  } catch (const std::invalid_argument& error) {
    refuseCameraInfo("D of the " + side + " camera_info: " + error.what());
  }
  return raw;
}

void checkRaw(const std::string& side, const RawCamera& raw) {
  try {
    raw.check();
  } catch (const std::invalid_argument& error) {
    refuseCameraInfo("the " + side + " camera_info: " + error.what());
  }
}

/// Whether two messages describe the same camera.
bool isSameCamera(const sensor_msgs::CameraInfo& a, const sensor_msgs::CameraInfo& b) {
  return a.width == b.width && a.height == b.height && a.distortion_model == b.distortion_model &&
         a.D == b.D && a.K == b.K && a.R == b.R && a.P == b.P && a.binning_x == b.binning_x &&
         a.binning_y == b.binning_y && a.roi == b.roi;
}

}  // namespace

StereoCalibration toStereoCalibration(const sensor_msgs::CameraInfo& left,
                                      const sensor_msgs::CameraInfo& right,
                                      double baseline_m) {
  const StereoCamera rectified = toStereoCamera(left, right, baseline_m);
  StereoCalibration calibration = {
      toRawCamera("left", left), toRawCamera("right", right), rectified};
  for (RawCamera* raw : {&calibration.left, &calibration.right}) {
    raw->width = rectified.width;
    raw->height = rectified.height;
  }
  checkRaw("left", calibration.left);
  checkRaw("right", calibration.right);
  return calibration;
}

bool describesRawImages(const sensor_msgs::CameraInfo& info) {
  constexpr double kSame_px = 1e-2;
  constexpr double kSame_rad = 1e-5;
  const auto& K = info.K;
  const auto& P = info.P;
  if (K[0] == 0.0) return false;  // it says nothing about them
  const bool is_distorted =
      std::any_of(info.D.begin(), info.D.end(), [](double value) { return value != 0.0; });
  const double difference = std::max(
      {std::abs(K[0] - P[0]), std::abs(K[2] - P[2]), std::abs(K[4] - P[5]), std::abs(K[5] - P[6])});
  return is_distorted || difference > kSame_px ||
         !Eigen::Map<const Matrix3>(info.R.data()).isIdentity(kSame_rad);
}

const std::shared_ptr<const StereoCalibration>& CurrentCalibration::of(
    const sensor_msgs::CameraInfo::ConstPtr& left, const sensor_msgs::CameraInfo::ConstPtr& right) {
  const bool is_current =
      calibration_ && isSameCamera(*left, *left_) && isSameCamera(*right, *right_);
  if (is_current) return calibration_;
  calibration_ =
      std::make_shared<const StereoCalibration>(toStereoCalibration(*left, *right, baseline_m_));
  left_ = left;
  right_ = right;
  return calibration_;
}

}  // namespace rotrocc
