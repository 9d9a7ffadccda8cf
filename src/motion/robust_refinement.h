#pragma once

#include "motion/fitted_feature.h"
#include "motion/motion_solver.h"
#include "rotrocc/correspondence.h"

namespace rotrocc {

/// Refines the result of a stage once its set is stable, by iteratively reweighted least squares
/// with cauchyWeights() and the errors that neighbouring features share. Not part of the paper.
///
/// The stages do not account for shared errors when they select the features: far from the
/// solution, these explain wrong motions too.
class RobustRefinement {
 public:
  /// `factor` is that of cauchyWeights().
  explicit RobustRefinement(double factor);

  /// Both return false if the least squares fail.
  bool refineMotion(const Measurements& measured, const FeatureSet& set, Fit& fit);
  bool refineTranslation(const Measurements& measured, const FeatureSet& set, Fit& fit);

 private:
  MotionSolver solver_;
};

}  // namespace rotrocc
