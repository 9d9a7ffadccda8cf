#pragma once

#include "motion/fitted_feature.h"
#include "motion/minimise.h"
#include "motion/reprojection_problem.h"
#include "rotrocc/correspondence.h"

namespace rotrocc {

/// Least squares over the reprojection errors of a feature set. Keeps nothing from call to call but
/// its buffers.
class MotionSolver {
 public:
  struct Options {
    double robust_factor = 0.0;  ///< of cauchyWeights(), by the residuals at the start; 0: equal
    MinimiseOptions minimise;
  };

  explicit MotionSolver(const Options& options) : options_(options) {}

  /// Minimises Eq. 25 over rotation and translation, from where the features are fitted, and fits
  /// them at the result. Returns false, and leaves the fit alone, if the set has fewer than 3
  /// features or the result is not finite.
  bool solveMotion(const Measurements& measured, const FeatureSet& set, Fit& fit);

  /// Minimises Eq. 29 over the translation, the rotation staying as it is. Returns as
  /// solveMotion(), with 2 features at least.
  bool solveTranslation(const Measurements& measured, const FeatureSet& set, Fit& fit);

 private:
  Options options_;
  ReprojectionProblem<6> motion_problem_;
  ReprojectionProblem<3> translation_problem_;
};

}  // namespace rotrocc
