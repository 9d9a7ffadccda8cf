#include "input/camera_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "input/input_error.h"
#include "input/sent_calibration.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

using Info = sensor_msgs::CameraInfo;
using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double kMaxMismatch_px = 0.1;   // of fx, fy and cy between rectified cameras
constexpr double kMaxOffRowShare = 0.05;  // of the baseline that may be along y
/// Relative difference of a number in camera_info: thousandths of a pixel for a focal length.
constexpr double kSameNumber = 1e-6;

[[noreturn]] void rejectCameraInfo(const std::string& sentence) {
  throw InputError(DropReason::kCameraInfoInvalid, sentence);
}

template <class Numbers>
bool areSame(const Numbers& a, const Numbers& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
    return std::abs(x - y) <= kSameNumber * std::abs(x);
  });
}

bool isZero(double value) {
  return value == 0.0;
}

void checkProjection(const std::string& side, const Info& info) {
  const auto& P = info.P;
  const std::string its = "P of the " + side + " camera_info";
  if (std::all_of(P.begin(), P.end(), isZero)) {
    rejectCameraInfo(its +
                     " is all zeros: the camera is not calibrated; calibrate it as a stereo pair");
  }
  for (std::size_t i = 0; i < P.size(); ++i) {
    if (std::isfinite(P[i])) continue;
    rejectCameraInfo("P[" + toText(i) + "] of the " + side + " camera_info is " + toText(P[i]) +
                     ": check the calibration file of the driver");
  }
  if (!(P[0] > 0.0 && P[5] > 0.0)) {
    rejectCameraInfo(its + " has focal lengths P[0] = " + toText(P[0]) + " and P[5] = " +
                     toText(P[5]) + " px, but both must be positive: is the camera calibrated?");
  }
  if (P[1] != 0.0 || P[4] != 0.0 || P[8] != 0.0 || P[9] != 0.0 || P[10] != 1.0) {
    rejectCameraInfo(
        its + " is not [fx 0 cx tx; 0 fy cy ty; 0 0 1 0], as for a rectified camera: P[1] = " +
        toText(P[1]) + ", P[4] = " + toText(P[4]) + ", P[8] = " + toText(P[8]) + ", P[9] = " +
        toText(P[9]) + ", P[10] = " + toText(P[10]) + "; calibrate the cameras as a pair");
  }
}

void requireEqual(const std::string& name, double left, double right) {
  if (std::abs(left - right) <= kMaxMismatch_px) return;
  rejectCameraInfo("the cameras are not rectified as a pair: " + name + " is " + toText(left) +
                   " px in the left camera_info and " + toText(right) +
                   " px in the right one; calibrate them together");
}

void requireSideBySide(const Info& left, const Info& right) {
  const double left_tx = left.P[3] + 0.0, right_tx = right.P[3] + 0.0;  // no "-0"
  const std::string values = "P[3] of camera_info, which is -fx times the camera's position, is " +
                             toText(left_tx) + " left and " + toText(right_tx) + " right";
  if (left_tx == right_tx) {
    rejectCameraInfo("the baseline is zero: " + values +
                     "; calibrate the cameras as a pair, or set the parameter baseline_m");
  }
  if (left_tx < right_tx) {
    rejectCameraInfo("the baseline is negative: " + values + "; are left and right swapped?");
  }
  if (std::abs(left.P[7] - right.P[7]) > kMaxOffRowShare * (left_tx - right_tx)) {
    rejectCameraInfo("the cameras are not side by side: P[7] of camera_info is " +
                     toText(left.P[7]) + " left and " + toText(right.P[7]) + " right, " + values);
  }
}

/// Whether neither K nor D leaves anything to rectify: some drivers leave R at zero then.
bool isOfRectifiedImages(const Info& info) {
  const std::array<double, 4> by_K = {info.K[0], info.K[2], info.K[4], info.K[5]};
  const std::array<double, 4> by_P = {info.P[0], info.P[2], info.P[5], info.P[6]};
  return areSame(by_K, by_P) && std::all_of(info.D.begin(), info.D.end(), isZero);
}

RawCamera toRawCamera(const std::string& side, const Info& info, const CalibratedImage& of) {
  const Info sent = ofSentImages(info, of);
  const auto& K = sent.K;
  if (!(K[0] > 0.0 && K[4] > 0.0)) {
    rejectCameraInfo("K of the " + side + " camera_info has focal lengths " + toText(K[0]) +
                     " and " + toText(K[4]) +
                     " px, but rectification needs them: calibrate the camera");
  }
  Matrix3 R = Eigen::Map<const Matrix3>(sent.R.data());
  if (R.isZero(0.0) && isOfRectifiedImages(sent)) R.setIdentity();
  RawCamera raw;
  std::string what = "D of the ";
  try {
    raw = {static_cast<int>(sent.width),
           static_cast<int>(sent.height),
           K[0],
           K[4],
           K[2],
           K[5],
           {sent.distortion_model, sent.D},
           R};
    what = "the ";
    raw.check();
  } catch (const std::invalid_argument& error) {
    rejectCameraInfo(what + side + " camera_info: " + error.what());
  }
  if (!isCropped(info)) requireOfItsImage("K of the " + side + " camera_info", K[2], K[5], sent);
  return raw;
}

/// `rectified` has the size and focal lengths of P, `cx` is its principal point and `shift_px` its
/// P[3].
Info toCameraInfo(const RawCamera& raw, const StereoCamera& rectified, double cx, double shift_px) {
  Info info;
  info.width = static_cast<std::uint32_t>(raw.width);
  info.height = static_cast<std::uint32_t>(raw.height);
  info.distortion_model = raw.distortion.name();
  info.D = raw.distortion.coefficients();
  info.K = {raw.fx, 0, raw.cx, 0, raw.fy, raw.cy, 0, 0, 1};
  Eigen::Map<Matrix3>(info.R.data()) = raw.R_rectified_raw;
  info.P = {rectified.fx, 0, cx, shift_px, 0, rectified.fy, rectified.cy, 0, 0, 0, 1, 0};
  return info;
}

/// P[3] of the right camera, rounded so that those who divide it get the same baseline.
double shiftOf(const StereoCamera& camera) {
  const double product = -camera.fx * camera.baseline_m;
  const double nearer = std::nextafter(product, 0.0);
  const double farther = std::nextafter(product, 2.0 * product);
  for (const double shift : {product, nearer, farther}) {
    if (shift / -camera.fx == camera.baseline_m) return shift;
  }
  return product;
}

}  // namespace

StereoCamera toStereoCamera(const Info& left_info, const Info& right_info, double baseline_m) {
  checkProjection("left", left_info);
  checkProjection("right", right_info);
  const CalibratedImage image = calibratedImageOf(left_info);
  const Info left = ofSentImages(left_info, image);
  const Info right = ofSentImages(right_info, image);
  if (left.width != right.width || left.height != right.height) {
    rejectCameraInfo("the left camera_info is for images of " + sizeText(left.width, left.height) +
                     ", the right one for " + sizeText(right.width, right.height) +
                     ": set both cameras to the same resolution");
  }
  requireEqual("fx", left.P[0], right.P[0]);
  requireEqual("fy", left.P[5], right.P[5]);
  requireEqual("cy", left.P[6], right.P[6]);
  if (baseline_m == 0.0) requireSideBySide(left, right);

  StereoCamera camera;
  camera.width = static_cast<int>(left.width);
  camera.height = static_cast<int>(left.height);
  camera.fx = left.P[0];
  camera.fy = left.P[5];
  camera.cx = left.P[2];
  camera.cy = left.P[6];
  camera.cx_right = right.P[2];
  camera.baseline_m = baseline_m > 0.0 ? baseline_m : (left.P[3] - right.P[3]) / left.P[0];
  try {
    camera.check();
  } catch (const std::invalid_argument& error) {
    rejectCameraInfo(std::string("camera_info is not a valid camera: ") + error.what());
  }
  if (!isCropped(left_info)) {
    requireOfItsImage("P of the left camera_info", left.P[2], left.P[6], left);
    requireOfItsImage("P of the right camera_info", right.P[2], right.P[6], right);
  }
  return camera;
}

std::pair<Info, Info> toCameraInfos(const StereoCalibration& calibration) {
  const StereoCamera& camera = calibration.rectified;
  return {toCameraInfo(calibration.left, camera, camera.cx, 0.0),
          toCameraInfo(calibration.right, camera, camera.cx_right, shiftOf(camera))};
}

StereoCalibration toStereoCalibration(const Info& left, const Info& right, double baseline_m) {
  const StereoCamera rectified = toStereoCamera(left, right, baseline_m);
  const CalibratedImage image = calibratedImageOf(left);
  return {toRawCamera("left", left, image), toRawCamera("right", right, image), rectified};
}

bool describeRawImages(const Info& left, const Info& right, double baseline_m) {
  if (left.K[0] == 0.0) return false;
  try {
    return !toStereoCalibration(left, right, baseline_m).isRectified();
  } catch (const InputError&) {
    return true;
  }
}

bool isRectifiedByName(std::string image_topic) {
  if (image_topic.find("kitti/camera_") != std::string::npos) return true;
  if (const auto end = image_topic.rfind("/compressed"); end != std::string::npos) {
    image_topic.resize(end);
  }
  return image_topic.find("/image_rect", image_topic.rfind('/')) != std::string::npos;
}

bool isSameCamera(const Info& a, const Info& b) {
  return a.width == b.width && a.height == b.height && a.distortion_model == b.distortion_model &&
         areSame(a.D, b.D) && areSame(a.K, b.K) && areSame(a.R, b.R) && areSame(a.P, b.P) &&
         a.binning_x == b.binning_x && a.binning_y == b.binning_y && a.roi == b.roi;
}

}  // namespace rotrocc
