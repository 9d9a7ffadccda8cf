#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Where a feature is in the right image, relative to where a rectified pair has it.
struct RowSample {
  double time_s = 0.0;
  cv::Point2f left_px;
  double x_right = 0.0;        ///< normalized coordinate in the right image
  double y = 0.0;              ///< normalized coordinate in the left image
  double row_px = 0.0;         ///< how much lower the feature is in the right image
  double velocity_pxps = 0.0;  ///< vertical, in the left image
};

/// What makes rows differ.
enum RowCause {
  kRoll,     ///< [rad] rotation of the right camera about its optical axis: clockwise
  kPitch,    ///< [rad] about x: looks up
  kYaw,      ///< [rad] about y: looks right
  kFocal,    ///< focal length of the right image over that of the left one, minus 1
  kOffset,   ///< [px] principal point of the right image, how much lower
  kLens,     ///< k1 that the right image has too much, in normalized coordinates
  kTimeSkew  ///< [s] how much later the right image is taken
};
constexpr std::size_t kRowCauses = 7;

using RowCauses = std::array<double, kRowCauses>;

/// Rotation R_left_right of the right camera that the causes are.
Eigen::Matrix3d rotationOf(const RowCauses& causes);

/// How much lower a feature is in the right image by the causes [px].
double rowOf(const StereoCamera& camera, const RowCauses& causes, const RowSample& sample);

struct RowModel {
  RowCauses causes = {};
  RowCauses sigmas = {};
  /// Effect of each cause: mean square over the samples, square root [px].
  RowCauses effects_px = {};
  RowCauses effect_sigmas_px = {};
  /// Whether the offset may as well be a pitch, or a part of it: the images do not show which.
  bool may_be_pitch = false;
};

/// Finds the causes by least squares with a robust loss, their uncertainty by the scatter between
/// windows. Those that are not significant are left out, least significant first, and are zero
/// then: pitch and offset, or roll and yaw, look alike in a part of an image. Their sigmas are
/// those before. `windows[i]`, below `window_count`, is the window of sample i. With fewer samples
/// than kLeastSamples all is zero, and sigmas are infinite.
RowModel fitRows(const StereoCamera& camera,
                 const std::vector<RowSample>& samples,
                 const std::vector<std::size_t>& windows,
                 std::size_t window_count);

constexpr std::size_t kLeastSamples = 100;

}  // namespace rotrocc
