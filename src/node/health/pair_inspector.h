#pragma once

#include <cstddef>
#include <future>
#include <string>

#include <opencv2/core.hpp>

#include "features/correspondence_finder.h"
#include "node/health/sliding_quantiles.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// Detects camera faults: a dark camera, swapped cameras, images that are not rectified,
/// or exposures that differ or move against each other so much that one of the images is likely to
/// be dark or saturated. What may cause a loss is looked for in a thread of its own.
class PairInspector {
 public:
  /// How many more suspicious pairs than good ones cause a hint. While they last, their cause is
  /// looked for again after twice as many. A tenth of them is taken back with each good pair.
  static constexpr int kPatience = 10;
  /// Number of pairs with a motion whose exposures are watched, and that suffice for a hint.
  static constexpr std::size_t kExposures = 50;
  static constexpr std::size_t kMinExposures = 10;

  /// `rectifies`: whether the images are rectified here, so that their calibration is to blame.
  explicit PairInspector(const CorrespondenceFinder::Config& config, bool rectifies = false);

  /// Uses another configuration from the next pair on, and forgets what was found with this one.
  void configure(const CorrespondenceFinder::Config& config);

  /// The suspected fault and a remedy, in one sentence; empty if none. `significant_bits`: those of
  /// 16-bit images that grey levels were taken from, or 8.
  std::string inspect(const StereoPair& pair,
                      const StereoCamera& camera,
                      const OdometryResult& result,
                      int significant_bits = 8);

  /// Waits until what was looked for is known to the next inspect().
  void finish() const;

 private:
  std::string compareExposures(const OdometryResult& result);
  void explain(const StereoPair& pair, const StereoCamera& camera, int significant_bits);
  void forgetLoss();

  bool rectifies_;
  CorrespondenceFinder::Config config_;

  Latest gains_{kExposures};

  // Of a loss: the pairs without a good motion that no good one took back, and at how many the next
  // explanation is looked for; the last one, kept until none is left.
  int doubtful_ = 0;
  int explain_at_ = kPatience;
  std::string explanation_;
  std::future<std::string> search_;
  bool search_is_of_this_loss_ = false;
};

}  // namespace rotrocc
