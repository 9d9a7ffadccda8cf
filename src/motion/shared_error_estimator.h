#pragma once

#include <Eigen/Geometry>

#include "motion/fitted_feature.h"
#include "motion/reprojection_problem.h"
#include "rotrocc/correspondence.h"

namespace rotrocc {

/// Estimates, while driving, how large the disparity errors are that the features of an image cell
/// share (SharedErrorGrid): their standard deviation relative to that of a flow.
///
/// At the motion of a pair, the features of a cell measure the error of their disparities, with the
/// variance 1/a + r^2 in units of the flow variance, where a is their information and r the ratio.
/// The method of moments (DerSimonian and Laird 1986) gives r^2 from the scatter of the cells
/// beyond 1/a. The estimate is a mean over the pairs, each weighted by what it says: a robot at
/// rest says nothing.
class SharedErrorEstimator {
 public:
  /// The estimate, at most kMostGrowth times kStart, which it is before the first pair.
  double ratio() const;

  static constexpr double kStart = 2.0;
  static constexpr double kMostGrowth = 3.0;

  /// Starts a new keyframe: the last observation becomes final.
  void advance();

  /// Adds a motion estimated from the flagged features. Motions from the same keyframe share its
  /// errors: only the last one counts.
  void observe(const StereoCamera& camera,
               const Correspondences& features,
               const FeatureSet& set,
               const Eigen::Isometry3d& T_keyframe_cur);

  /// Discards the estimate, for use with another rig.
  void reset() { past_ = last_ = {}; }

 private:
  /// The squared ratio is `scatter` divided by `weight`. A pair without noise has a weight of 1.
  struct Moments {
    double scatter = 0.0;
    double weight = 0.0;
  };

  Moments past_;                    // of earlier keyframes
  Moments last_;                    // of the last motion from this keyframe
  Fit fit_;                         // buffer, reused
  ReprojectionProblem<6> problem_;  // buffer, reused
};

}  // namespace rotrocc
