#pragma once

#include "simulation/simulator.h"

namespace rotrocc {

/// How far the truth of a simulated drive is from what its own renderer sees.
struct TruthErrors {
  long long right = 0;   ///< points seen again with an error up to kTruthLimit_px
  double sum_px = 0.0;   ///< of their errors
  long long wrong = 0;   ///< with a greater one: at edges and leaves another surface may be seen
  long long hidden = 0;  ///< something clearly nearer or farther is seen there
  long long moving = 0;  ///< on moving cars; not compared
};

constexpr double kTruthLimit_px = 0.01;

/// Follows the flow of each fourth pixel in x and y of `frame`, which is frame `index`, to the next
/// frame, looks there for the 3-D point that is seen, and projects that back with the true poses:
/// that should give the pixel. Adds what it finds to `errors`. Brings the world to the next frame.
void checkTruth(Simulator& simulator, int index, const SimulatedFrame& frame, TruthErrors& errors);

}  // namespace rotrocc
