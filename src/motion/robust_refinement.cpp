#include "motion/robust_refinement.h"

#include <limits>

namespace rotrocc {
namespace {

/// Number of steps; each is weighted by the residuals after the previous one.
constexpr int kReweightings = 4;

/// One Gauss-Newton step with negligible damping, because the start is close to the minimum.
constexpr MinimiseOptions kOneStep = {1e-12, std::numeric_limits<double>::infinity(), 1};

}  // namespace

RobustRefinement::RobustRefinement(double factor) : solver_({factor, true, kOneStep}) {}

bool RobustRefinement::refineMotion(const Measurements& measured, const FeatureSet& set, Fit& fit) {
  for (int i = 0; i < kReweightings; ++i) {
    if (!solver_.solveMotion(measured, set, fit)) return false;
  }
  return true;
}

bool RobustRefinement::refineTranslation(const Measurements& measured,
                                         const FeatureSet& set,
                                         Fit& fit) {
  for (int i = 0; i < kReweightings; ++i) {
    if (!solver_.solveTranslation(measured, set, fit)) return false;
  }
  return true;
}

}  // namespace rotrocc
