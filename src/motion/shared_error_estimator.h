#pragma once

#include <Eigen/Geometry>

#include "motion/fitted_feature.h"
#include "motion/reprojection_problem.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// Estimates, while driving, how large the disparity errors are that the features of an image cell
/// share (SharedErrorGrid): their standard deviation relative to that of a flow.
///
/// At the motion of a pair, the features of a cell measure the error of their disparities, with the
/// variance 1/a + r^2 in units of the flow variance, where a is their information and r the ratio.
/// The method of moments (DerSimonian and Laird 1986) gives r^2 from the scatter of the cells
/// beyond 1/a. The estimate is a weighted mean over the pairs.
class SharedErrorEstimator {
 public:
  explicit SharedErrorEstimator(const MotionEstimatorConfig& config) : config_(config) {}

  /// Changes the parameters. The estimate is kept unless it is disabled.
  void configure(const MotionEstimatorConfig& config);

  /// The estimate; shared_ratio of the configuration before the first pair. 0: disabled.
  double ratio() const;

  /// Adds a motion estimated from the flagged features.
  void observe(const StereoCamera& camera,
               const Correspondences& features,
               const FeatureSet& set,
               const Eigen::Isometry3d& T_keyframe_cur);

  /// Discards the estimate, for use with another rig.
  void reset() { pairs_ = {}; }

 private:
  /// Sums over cells: the squared ratio is `scatter` divided by `weight`.
  struct Moments {
    double scatter = 0.0;
    double weight = 0.0;
  };
  Moments momentsOf();

  MotionEstimatorConfig config_;
  Moments pairs_;
  Fit fit_;                         // buffer, reused
  ReprojectionProblem<6> problem_;  // buffer, reused
};

}  // namespace rotrocc
