#pragma once

#include "motion/fitted_feature.h"
#include "motion/reprojection_problem.h"
#include "rotrocc/correspondence.h"

namespace rotrocc {

/// Least squares over the reprojection errors of a feature set, by Levenberg-Marquardt. Has no
/// state except reused buffers.
class MotionSolver {
 public:
  struct Options {
    double robust_factor = 0.0;  ///< of cauchyWeights() at the start; 0: equal weights
    bool shares_errors = false;  ///< whether to account for errors that features share
    int minimizations = 1;  ///< each starts, and has weights, at the result of the previous one
    double damping = 1e-4;  ///< at the start, relative to the diagonal of J^T J
    double min_cost_change_px2 = 2e-6;  ///< stop when a step changes the cost by less
    int max_steps = 19;
  };

  /// Options that refine the result of a stage once its set is stable, by iteratively reweighted
  /// least squares with the errors that neighboring features share. Not part of the paper. The
  /// stages do not account for these errors when they select the features: far from the solution,
  /// they explain wrong motions too.
  static Options refinement();

  explicit MotionSolver(const Options& options) : options_(options) {}

  /// Minimizes Eq. 25 over rotation and translation, starting at the motion of `fit`, then fits the
  /// features at the result. Returns false if the set has fewer than 3 features or the result is
  /// not finite; `fit` stays as it was before that minimization.
  bool solveMotion(const Measurements& measured, const FeatureSet& set, Fit& fit);

  /// Minimizes Eq. 29 over the translation with a fixed rotation. Returns false as solveMotion(),
  /// but needs only 2 features.
  bool solveTranslation(const Measurements& measured, const FeatureSet& set, Fit& fit);

 private:
  template <int kParameters>
  bool solve(const Measurements& measured,
             const FeatureSet& set,
             double parabola_ratio,
             ReprojectionProblem<kParameters>& problem,
             Fit& fit) const;

  Options options_;
  ReprojectionProblem<6> motion_problem_;
  ReprojectionProblem<3> translation_problem_;
};

}  // namespace rotrocc
