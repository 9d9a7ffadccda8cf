#include "odometry/prediction_error.h"

#include <algorithm>

namespace rotrocc {
namespace {

/// A large error counts less with each pair after it. It is halved after three pairs.
constexpr double kDecay = 0.8;

/// How far the search reaches, relative to the recent error.
constexpr double kMargin = 2.0;

}  // namespace

void PredictionError::observe(double error_px) {
  recent_px_ = std::max(error_px, kDecay * recent_px_);
}

int PredictionError::levels() const {
  int levels = config_.levels;
  // A level is searched about as far as its window reaches.
  double reach_px = config_.window_radius_px * (1 << (levels - 1));
  for (; levels < config_.startup_levels && reach_px < kMargin * recent_px_; ++levels) {
    reach_px *= 2.0;
  }
  return levels;
}

}  // namespace rotrocc
