#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <string>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

namespace rotrocc {

/// A pair to be sent to the odometry, and how.
struct StressPair {
  sensor_msgs::Image left, right;
  sensor_msgs::CameraInfo left_info, right_info;
  bool send_left = true, send_right = true;
  int pause_ms = 0;           ///< nothing is sent for so long afterwards
  double gap_s = 0.0;         ///< the same, and the stamps go on
  bool burst = false;         ///< it and those after it are sent at once
  bool rival_tf = false;      ///< another node publishes tf of the base
  bool save_to_fifo = false;  ///< the trajectory is to be saved to a FIFO that nobody reads
};

struct Fault;

/// Applies faults of drivers, cables, clocks and other nodes to some pairs. A fault lasts for a
/// pair or for a stretch of pairs.
class FaultInjector {
 public:
  /// At random: a fault begins with a `share` of the pairs.
  FaultInjector(double share, unsigned seed) : share_(share), random_(seed) {}
  /// Each fault once, in turn.
  explicit FaultInjector(unsigned seed) : in_turn_(true), random_(seed) {}

  /// Changes the pair, or not; returns whether it has a fault. Another fault begins only if it
  /// `may_begin`.
  bool apply(StressPair& pair, bool may_begin = true);

  /// Whether each fault had its turn.
  bool finished() const;

  /// How often each fault was made.
  const std::map<std::string, std::uint64_t>& counts() const { return counts_; }

 private:
  const Fault* choose();

  double share_ = 0.0;
  bool in_turn_ = false;
  std::mt19937 random_;
  const Fault* active_ = nullptr;
  int pairs_left_ = 0;    // of the active fault
  std::size_t turn_ = 0;  // of the next fault
  std::map<std::string, std::uint64_t> counts_;
};

}  // namespace rotrocc
