#pragma once

#include <cstddef>
#include <functional>
#include <future>
#include <string>
#include <vector>

#include "input/stereo_pair_converter.h"
#include "node/health/loss_explanation.h"
#include "node/health/sliding_quantiles.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// A pair with pixels of its own.
StereoPair copyOf(StereoPair pair);

/// Detects camera faults: a dark camera, swapped cameras, images that are not rectified, one side
/// that is a frame or two late, or exposures that differ so much that one of the images is likely
/// to be dark or saturated. A thread of its own looks for the cause of a loss.
class PairInspector {
 public:
  /// How many more suspicious pairs than good ones cause a hint. While they last, their cause is
  /// looked for again after twice as many. A tenth of them is taken back with each good pair.
  static constexpr int kPatience = 10;
  /// Number of pairs with a motion whose exposures are watched, and that suffice for a hint.
  static constexpr std::size_t kExposures = 50;
  static constexpr std::size_t kMinExposures = 10;

  /// `rectifies`: whether the images are rectified here, so that their calibration is to blame.
  explicit PairInspector(const OdometryConfig& config, bool rectifies = false);

  /// Uses another configuration from the next pair on, and forgets what was found with this one.
  void configure(const OdometryConfig& config);

  /// Forgets what was found out of a loss.
  void reset();

  /// Copies of the last kPairsBefore pairs that were received before, the earliest one first.
  using PairsBefore = std::function<std::vector<StereoPair>()>;

  /// The suspected fault and a remedy, in one sentence; empty if none. `range`: that of 16-bit
  /// images. `before` is called if it is needed.
  std::string inspect(const StereoPair& pair,
                      const StereoCamera& camera,
                      const OdometryResult& result,
                      const GrayRange& range = {},
                      const PairsBefore& before = {});

  /// Whether the last explanation of a loss is that left and right images are not a pair:
  /// exchanged, of one camera, or of different times. Then they say nothing about the rig.
  bool isOfNoPair() const { return explanation_.is_of_no_pair; }

  /// The result without what is wrong while isOfNoPair(): features agree by chance. A motion is
  /// lost, or degraded if most features agree on it, as on that of the first pair that is one
  /// again. inspect() needs the result as it was.
  OdometryResult distrusted(OdometryResult result) const;

  /// Waits for what is being looked for. Returns the explanation of a loss; empty if none.
  std::string finish();

  /// Whether searches for the cause of a loss found nothing: single pairs do not show it.
  bool isUnexplained() const;

 private:
  std::string compareExposures(const OdometryResult& result);
  void explain(const StereoPair& pair,
               const StereoCamera& camera,
               const OdometryResult& result,
               const GrayRange& range,
               const PairsBefore& before);

  bool rectifies_;
  OdometryConfig config_;

  Latest gains_{kExposures};

  // Of a loss: the pairs without a good motion that no good one took back, and at how many the next
  // explanation is looked for; the last one, kept until none is left.
  int doubtful_ = 0;
  int explain_at_ = kPatience;
  Explanation explanation_;
  std::future<Explanation> search_;
  bool search_is_of_this_loss_ = false;
  int found_nothing_ = 0;  // searches since the last explanation
};

}  // namespace rotrocc
