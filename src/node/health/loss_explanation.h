#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "input/stereo_pair_converter.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// Why a motion is lost or doubtful, in one sentence with a remedy; empty if it is not known.
struct Explanation {
  std::string text;
  bool is_of_no_pair = false;
  bool is_guess = false;  ///< another one says more
};

/// Why the last of some pairs has no motion, as far as the images show; empty if they do not.
/// `rectifies`, `range`: see PairInspector.
Explanation explainLoss(const std::vector<StereoPair>& pairs,
                        const OdometryConfig& config,
                        const StereoCamera& camera,
                        const OdometryResult& result,
                        bool rectifies,
                        const GrayRange& range);

/// The features that agree on the motion from a pair to the next.
struct Agreement {
  std::size_t count;
  bool is_clear;  ///< the motion is not in doubt, or more agree on it than by chance
  bool stands_still;
};

/// How many more features agree if they are of other images than it seems.
constexpr double kClearlyMoreAgree = 1.5;

Agreement agreementOf(OdometryConfig config,
                      const StereoCamera& camera,
                      const StereoPair& earlier,
                      const StereoPair& later);

/// The left image of one pair with the right one of another.
StereoPair paired(const StereoPair& of_left, const StereoPair& of_right);

/// With left and right exchanged.
StereoPair exchanged(const StereoPair& pair);

}  // namespace rotrocc
