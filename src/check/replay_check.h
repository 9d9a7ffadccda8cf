#pragma once

#include <future>
#include <optional>
#include <vector>

#include "check/pair_check.h"
#include "check/windows.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/uncertain_transform.h"

namespace rotrocc {

/// How well the odometry agrees with itself when stretches of the recording are repeated backward
/// in time, and mirrored, with left and right exchanged: a rig without errors gives the same
/// motion. It does so in a thread beside the caller's.
class ReplayCheck {
 public:
  /// `pairs`: how many the recording has at most.
  ReplayCheck(const OdometryConfig& config, int pairs);

  void observe(const CheckedPair& pair);

  void report(RigReport& report);

  /// The median differences of both ways over the path in the last report; 0 if there are none. Its
  /// deviation is by the covariances of the motions.
  Estimate share() const { return share_; }

 private:
  struct Step {
    double time_s;
    StereoPair images;
    StereoCamera camera;
    OdometryResult result;
  };
  using Stretch = std::vector<Step>;

  /// Differences of the motion over a stretch.
  struct Difference {
    double time_s = 0.0;
    double path_m = 0.0;
    double backward_m = 0.0, backward_rad = 0.0;
    double mirrored_m = 0.0, mirrored_rad = 0.0;
    double sigma_m = 0.0, sigma_rad = 0.0;  ///< as the covariances promise
  };

  static std::optional<Difference> compare(const Stretch& stretch, OdometryConfig config);
  void startCompare();
  void finishCompare();

  OdometryConfig config_;
  int repeated_of_;  // one of so many stretches is repeated
  int stretches_ = 0;
  Stretch stretch_;
  std::future<std::optional<Difference>> comparison_;
  std::vector<Difference> differences_;
  int lost_ = 0, pairs_ = 0;
  Estimate share_;
};

}  // namespace rotrocc
