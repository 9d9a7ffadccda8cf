#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "rotrocc/correspondence.h"
#include "rotrocc/correspondence_finder.h"
#include "rotrocc/motion_check.h"
#include "rotrocc/motion_estimator.h"
#include "rotrocc/motion_model.h"
#include "rotrocc/noise_estimator.h"
#include "rotrocc/reference_selector.h"
#include "rotrocc/row_comparison.h"
#include "rotrocc/stereo_calibrator.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"
#include "rotrocc/uncertain_transform.h"

namespace rotrocc {

/// What can be said of the motion to the current pair.
enum class State {
  kInitialising,  ///< there is no earlier pair to compare this one with
  kOk,
  kDegraded,  ///< the motion is given, but rests on few features
  kLost       ///< no motion was found
};

/// "initialising", "ok", "degraded" or "lost".
const char* toString(State state);

/// How many features are left after each stage.
struct StageCounts {
  int corners = 0;           ///< Shi-Tomasi corners of the reference pair
  int with_depth = 0;        ///< with a disparity there
  int tracked = 0;           ///< tracked to the current pair, left and right
  int consistent = 0;        ///< left and right agree there: the feature set F
  int rotation_inliers = 0;  ///< left after stage 1
  int translation_inliers =
      0;  ///< left after stage 2; 0 if the criterion or the low speed skips it
};

/// Wall time of each stage [ms]; several rounds of a stage are added up.
struct StageTimes {
  double pyramids_ms = 0.0;
  double corners_ms = 0.0;
  double disparity_ms = 0.0;
  double tracking_ms = 0.0;
  double estimation_ms = 0.0;
  double total_ms = 0.0;
};

/// The answer to one stereo pair.
struct OdometryResult {
  State state = State::kLost;
  std::string reason;         ///< why the state is not ok, in one sentence; empty if it is
  std::int64_t stamp_ns = 0;  ///< of the current pair
  double dt_s = 0.0;          ///< since the previous pair; 0 if there is none
  /// The motion of the left camera since the previous pair, which is the last one that was ok,
  /// degraded or initialising: maps points of its current frame to its previous one. Identity
  /// unless the state is ok or degraded.
  Eigen::Isometry3d T_prev_cur = Eigen::Isometry3d::Identity();
  /// Covariance of T_prev_cur in axes of the previous camera frame, in the order of REP 103:
  /// translation [m] x y z, then rotation [rad] about x y z, with R = Exp(error) R_estimated and
  /// t = error + t_estimated. Zero unless the state is ok or degraded.
  Matrix6d covariance = Matrix6d::Zero();
  /// The stamp of the pair that the motion was measured against, an earlier one or the previous
  /// one, and the motion since then. Errors add up from reference to reference, not from pair to
  /// pair.
  std::int64_t reference_stamp_ns = 0;
  UncertainTransform T_ref_cur;
  DisparityBias disparity_bias;  ///< of the rig, as far as known
  RowOffset row_offset;          ///< likewise; not corrected
  MeasurementNoise noise;        ///< likewise
  StageCounts counts;
  StageTimes times;

  bool hasMotion() const { return state == State::kOk || state == State::kDegraded; }
};

/// Stereo visual odometry: section V of Buczko and Willert, "Flow-Decoupled Normalized Reprojection
/// Error for Visual Odometry", 2017. Motions are measured against a reference pair, which is the
/// previous one, as in the paper, or an earlier one that still serves, see ReferenceSelector.
class VisualOdometry {
 public:
  struct Config {
    CorrespondenceFinder::Config correspondence_finder;
    MotionModel::Config motion_model;
    MotionEstimator::Config motion_estimator;
    MotionCheck::Config motion_check;
    NoiseEstimator::Config noise_estimator;
    ReferenceSelector::Config reference_selector;
    StereoCalibrator::Config stereo_calibrator;

    int threads = 2;                  ///< that work on a pair, the calling one included
    int startup_rounds = 4;           ///< predict, track, estimate this often without a prediction
    double startup_settled_px = 0.5;  ///< fewer rounds if the prediction moves less
    double max_gap_s = 1.0;           ///< between two pairs; longer: start anew
  };

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
