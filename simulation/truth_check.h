#pragma once

#include "simulation/simulator.h"

namespace rotrocc {

/// Errors of the ground truth of a simulated drive against the rendered frames.
struct TruthErrors {
  long long right = 0;  ///< points found again within kTruthLimit_px
  double sum_px = 0.0;  ///< sum of their errors
  long long wrong = 0;  ///< with a larger error: at edges and leaves another surface may be visible
  long long hidden = 0;  ///< occluded: clearly nearer or farther surface
  long long moving = 0;  ///< on moving cars; not compared
};

constexpr double kTruthLimit_px = 0.01;

/// Follows the flow of every fourth pixel in x and y of `frame` (frame `index`) to the next frame,
/// and projects the 3-D point found there back with the true poses. Adds the distances from the
/// original pixels to `errors`. Updates the world to the next frame.
void checkTruth(Simulator& simulator, int index, const SimulatedFrame& frame, TruthErrors& errors);

}  // namespace rotrocc
