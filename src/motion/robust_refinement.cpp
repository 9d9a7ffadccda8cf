#include "motion/robust_refinement.h"

#include <limits>

namespace rotrocc {
namespace {

/// Steps, each weighted by the errors that the one before has left.
constexpr int kReweightings = 4;

/// One step of Gauss-Newton with hardly any damping: the start is near the minimum.
constexpr MinimiseOptions kOneStep = {1e-12, std::numeric_limits<double>::infinity()};

}  // namespace

RobustRefinement::RobustRefinement(double factor) : solver_({factor, kOneStep}) {}

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
