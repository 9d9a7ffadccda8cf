#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "check/pair_check.h"
#include "check/rig_model.h"
#include "features/feature_tracker.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// Measures the flow of a feature and its derivatives. Returns its point in the left camera [m].
/// x_right and y of the sample must be set; the flow stays zero if its disparity is too small to
/// have errors that are parts of it.
Eigen::Vector3d measureFlow(const StereoCamera& camera,
                            const OdometryResult& result,
                            const Correspondence& feature,
                            RigSample& sample);

/// Measures the features of pairs that have moved. Those that do not agree with the motion count,
/// too: they are the ones with the largest errors of a bad rig.
class RigSampler {
 public:
  explicit RigSampler(const OdometryConfig& config)
      : tracker_(config.correspondence_finder.feature_tracker) {}

  void observe(const CheckedPair& pair);

  const std::vector<PairSamples>& pairs() const { return pairs_; }
  /// Discards the features where `mask`, CV_8UC1, is not 0: parts of the robot do not move.
  void exclude(const cv::Mat& mask);

 private:
  /// To the last samples, by the motion of the left camera per second.
  void addVelocities(const StereoCamera& camera, const Vector6d& twist);
  void measureRow(const CheckedPair& pair, const Correspondence& feature, RigSample& sample);

  FeatureTracker tracker_;
  std::vector<PairSamples> pairs_;
  std::size_t samples_ = 0;
  // Of the last samples, and of the motion that ended there.
  std::int64_t last_ns_ = -1;
  double last_dt_s_ = 0.0;
  Vector6d last_twist_ = Vector6d::Zero();  // [m/s, rad/s]
  std::vector<Eigen::Vector3d> last_points_;
};

}  // namespace rotrocc
