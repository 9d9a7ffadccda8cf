#pragma once

#include <optional>
#include <string>
#include <vector>

#include "motion/motion_estimator.h"
#include "motion/reprojection_problem.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/uncertain_transform.h"

namespace rotrocc {

/// A candidate motion with all data that it was estimated from. It is accepted or discarded as a
/// whole.
struct Hypothesis {
  static constexpr const char* kNotTried = "no try is left";  // short, so without an allocation

  StereoCamera camera;  ///< corrected by the disparity bias that was used for the features' depths
  Correspondences features;
  bool has_prediction = false;  ///< the motion was searched near a prediction
  double contrast_gain = 1.0;   ///< see OdometryResult
  MotionEstimate estimate;
  StageCounts counts;
  std::optional<std::string> why_lost = kNotTried;  ///< none if the motion is accepted

  bool isAccepted() const { return !why_lost; }

  void clear() {
    features.clear();
    estimate.rotation_inliers.clear();
    estimate.translation_inliers.clear();
    counts = {};
    why_lost = kNotTried;
  }
};

/// Checks whether an estimated motion is plausible.
class MotionCheck {
 public:
  using Config = MotionCheckConfig;

  /// `as_published`: by the method of the paper.
  explicit MotionCheck(const Config& config, bool as_published = false)
      : config_(config), as_published_(as_published) {}

  /// Why the motion is rejected, in one sentence with the value and the limit; none if it is
  /// accepted. The limits of speed and turn rate are for the step since the last frame, which took
  /// `dt_s` > 0. Features may agree on a motion by chance if they are neither half of the tracked
  /// ones nor a tenth of the keyframe's.
  std::optional<std::string> whyLost(const Hypothesis& found,
                                     const Eigen::Isometry3d& T_keyframe_last,
                                     double dt_s) const;

  /// Why an accepted motion is less reliable; none if it is not. `covariance` is that of the
  /// motion since the keyframe, including that of the rig's calibration, before inflation().
  std::optional<std::string> whyDegraded(const Hypothesis& accepted, const Matrix6d& covariance);

  /// Why a camera that seems stationary may be moving; none if it moves, or is certainly
  /// stationary. A stationary camera loses no features: those that are not found again contradict,
  /// too. The rest may belong to an overlay, or to an earlier image that shows through.
  std::optional<std::string> whyNotAtRest(const Hypothesis& accepted);

  /// Of the reasons of whyDegraded() the one that too few of the features agree: there may be a
  /// better start.
  std::optional<std::string> whyFewAgree(const Hypothesis& accepted);

  /// Whether the camera rests at an accepted motion: the median inlier has moved by less than 6
  /// times the noise of the flow. The noise of a motion is then a sixth of it, or more.
  static bool isAtRest(const Hypothesis& accepted);

  /// Why a motion during `dt_s` > 0 is an implausible jump; none if it is not. `expected` is the
  /// motion during `dt_s` at the previous velocity. Changes within 3 standard deviations of the
  /// noise are accepted.
  static std::optional<std::string> whyJump(const UncertainTransform& motion,
                                            const Eigen::Isometry3d& expected,
                                            double dt_s);

  /// The factor >= 1 for the covariance of an accepted motion, which assumes independent features:
  /// each that contradicts takes the word of one that agrees, as a set without a majority
  /// determines nothing; and those that agree have a share of the variance of their errors in
  /// common.
  static double inflation(const MotionEstimate& accepted, double common_share);

 private:
  std::optional<std::string> whyFewDetermine(const Hypothesis& accepted);
  std::optional<std::string> whyUndetermined(const Hypothesis& accepted,
                                             const Matrix6d& covariance);
  double informationShare(const Hypothesis& accepted);

  Config config_;
  bool as_published_;

  // Reused.
  std::vector<double> depths_m_;
  ReprojectionProblem problem_;
};

}  // namespace rotrocc
