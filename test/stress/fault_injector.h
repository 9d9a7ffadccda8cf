#pragma once

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
  int pause_ms = 0;    ///< nothing is sent for so long afterwards
  bool burst = false;  ///< it and those after it are sent at once
};

/// Applies faults of drivers, cables and clocks to some pairs.
class FaultInjector {
 public:
  /// `share` of the pairs get a fault.
  FaultInjector(double share, unsigned seed) : share_(share), random_(seed) {}

  /// Changes the pair, or not.
  void apply(StressPair& pair);

  /// How often each fault was made.
  const std::map<std::string, std::uint64_t>& counts() const { return counts_; }

 private:
  double share_;
  std::mt19937 random_;
  std::map<std::string, std::uint64_t> counts_;
};

}  // namespace rotrocc
