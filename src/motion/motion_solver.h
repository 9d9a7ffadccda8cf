#pragma once

#include "motion/reprojection_problem.h"

namespace rotrocc {

/// What is minimized: Eq. 25 over rotation and translation, or Eq. 29 over the translation with a
/// fixed rotation.
enum class Unknowns { kMotion, kTranslation };

/// Minimizes the errors of a set by Levenberg-Marquardt, from the motion of the problem, which
/// becomes the result. Returns false, with the motion unchanged, if the set has fewer than 3
/// features (2 for a translation), or if the result is not finite.
bool solve(Unknowns unknowns, const FeatureSet& set, ReprojectionProblem& problem);

/// Refines the result of a stage once its set is stable, by iteratively reweighted least squares
/// with the errors that neighboring features share. Not part of the paper. The stages do not
/// account for these errors when they select the features: far from the solution, they explain
/// wrong motions too. Returns false as solve().
bool refine(Unknowns unknowns, const FeatureSet& set, ReprojectionProblem& problem);

}  // namespace rotrocc
