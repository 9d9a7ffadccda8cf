#pragma once

#include "motion/fitted_feature.h"
#include "motion/minimise.h"
#include "motion/reprojection_problem.h"
#include "rotrocc/correspondence.h"

namespace rotrocc {

/// Least squares over the reprojection errors of a feature set. Has no state except reused buffers.
class MotionSolver {
 public:
  struct Options {
    double robust_factor = 0.0;  ///< of cauchyWeights() at the start; 0: equal weights
    bool shares_errors = false;  ///< whether to account for Measurements::shared_ratio
    MinimiseOptions minimise;
  };

  explicit MotionSolver(const Options& options) : options_(options) {}

  /// Minimises Eq. 25 over rotation and translation, starting at the motion of `fit`, then fits the
  /// features at the result. Returns false and does not change `fit` if the set has fewer than 3
  /// features or the result is not finite.
  bool solveMotion(const Measurements& measured, const FeatureSet& set, Fit& fit);

  /// Minimises Eq. 29 over the translation with a fixed rotation. Returns false as solveMotion(),
  /// but needs only 2 features.
  bool solveTranslation(const Measurements& measured, const FeatureSet& set, Fit& fit);

 private:
  Options options_;
  ReprojectionProblem<6> motion_problem_;
  ReprojectionProblem<3> translation_problem_;
};

}  // namespace rotrocc
