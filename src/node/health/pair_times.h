#pragma once

namespace rotrocc {

/// Wall time from the arrival of the image that completes a pair until its odometry is sent. The
/// time of the estimator, OdometryResult::times, is a part of it.
struct PairTimes {
  double pairing_ms = 0.0;     ///< before that: from the arrival of the first image
  double waiting_ms = 0.0;     ///< for the worker, and for tf of the camera
  double conversion_ms = 0.0;  ///< checks, conversion to grey, rectification
  double publishing_ms = 0.0;  ///< of tf and odometry
  double latency_ms = 0.0;     ///< of all, without pairing
};

}  // namespace rotrocc
