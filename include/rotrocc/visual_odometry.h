#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include <Eigen/Geometry>

#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// The rotation of the left camera R_from_to between two stamps, as another sensor measured it,
/// e.g. a gyroscope; nothing if it is unknown.
using RotationSource =
    std::function<std::optional<Eigen::Matrix3d>(std::int64_t from_ns, std::int64_t to_ns)>;

/// Stereo visual odometry after section V of Buczko and Willert, "Flow-Decoupled Normalized
/// Reprojection Error for Visual Odometry", 2017. Motions are measured against a keyframe: the
/// previous pair, as in the paper, or while stationary an earlier one.
class VisualOdometry {
 public:
  using Config = OdometryConfig;

  /// Throws as OdometryConfig::check().
  explicit VisualOdometry(const Config& config);
  ~VisualOdometry();
  VisualOdometry(VisualOdometry&&) noexcept;
  VisualOdometry& operator=(VisualOdometry&&) noexcept;

  /// Estimates the motion since the previous pair. Never throws. The state is lost, with a reason,
  /// on: images that are empty, not CV_8UC1, of different sizes or not of the camera's size, or
  /// masks that are not; an invalid camera; a stamp that is not later; an image that shows
  /// something and is identical to the previous one, which no camera sends twice; errors inside
  /// OpenCV or Ceres. The state is initializing on the first pair, on images of another
  /// size, a calibration that changes by more than a thousandth, and after a gap of more than 30
  /// periods of the pairs, or if stamps went back by more than that.
  ///
  /// `expected` is the motion T_prev_cur measured by another sensor, if any. It replaces the motion
  /// model's prediction as the start of tracking.
  ///
  /// `measured_rotation` replaces the rotation of that start, of `expected` as well as of the
  /// motion model, whose velocity turns with the camera. It is called for at most two intervals,
  /// which begin at earlier pairs.
  ///
  /// `may_repeat` is called if both images are identical to the previous ones: a simulated camera
  /// repeats its images while it is stationary.
  OdometryResult process(const StereoPair& pair,
                         const StereoCamera& camera,
                         const std::optional<Eigen::Isometry3d>& expected = std::nullopt,
                         const RotationSource& measured_rotation = {},
                         const std::function<bool()>& may_repeat = {});

  /// Finds corners and disparities of the last pair, with which the next pair is compared. Call it
  /// after the result of process() has been passed on: the next result is then ready sooner.
  /// Without the call process() does the same, with the same results. Does nothing on the first
  /// pairs, and when the keyframe is kept. Never throws.
  void prepare();

  /// Forgets the previous pair and the motion: the next pair is treated as the first one.
  void reset();

  /// Changes the parameters without a restart. The next motion is measured against the previous
  /// pair. The rig calibration is kept unless it is disabled by the new parameters. Throws as the
  /// constructor does, and then keeps the old parameters.
  void configure(const Config& config);

  /// The feature set of the last call; empty if processing stopped before.
  const Correspondences& correspondences() const;
  /// The inliers of stages 1 and 2 among correspondences(). They are equal if stage 2 was skipped.
  const FeatureSet& rotationInliers() const;
  const FeatureSet& translationInliers() const;

 private:
  class Pipeline;
  std::unique_ptr<Pipeline> pipeline_;
};

}  // namespace rotrocc
