#pragma once

#include <memory>
#include <optional>

#include <Eigen/Geometry>

#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Stereo visual odometry: section V of Buczko and Willert, "Flow-Decoupled Normalized Reprojection
/// Error for Visual Odometry", 2017. Motions are measured against a keyframe, which is the
/// previous one, as in the paper, or an earlier one that still serves, see KeyframeSelector.
class VisualOdometry {
 public:
  using Config = OdometryConfig;

  explicit VisualOdometry(const Config& config);
  ~VisualOdometry();
  VisualOdometry(VisualOdometry&&) noexcept;
  VisualOdometry& operator=(VisualOdometry&&) noexcept;

  /// Estimates the motion since the pair of the last call. Never throws: images that are empty, not
  /// CV_8UC1, of different sizes or not of the camera's size, a bad camera, a stamp that does not
  /// increase, and errors inside OpenCV or Ceres give the state lost and a reason. The first pair,
  /// a new camera and a gap of more than max_gap_s give the state initialising.
  /// `expected` is what another sensor says of the motion T_prev_cur, for the tracker to start from
  /// instead of the motion before.
  OdometryResult process(const StereoPair& pair,
                         const StereoCamera& camera,
                         const std::optional<Eigen::Isometry3d>& expected = std::nullopt);

  /// Forgets the previous pair and the motion: the next pair is a first one.
  void reset();

  /// Takes other parameters and goes on: the next motion is measured against the previous pair, and
  /// what is known of the rig stays, as far as it is estimated by the new parameters too. Throws as
  /// the constructor does, and then keeps the old ones.
  void configure(const Config& config);

  /// The feature set of the last call, empty if it did not get so far.
  const Correspondences& correspondences() const;
  /// The inliers of stage 1 and 2 among correspondences(). Where stage 2 was skipped both are
  /// alike.
  const FeatureSet& rotationInliers() const;
  const FeatureSet& translationInliers() const;

 private:
  class Pipeline;
  std::unique_ptr<Pipeline> pipeline_;
};

}  // namespace rotrocc
