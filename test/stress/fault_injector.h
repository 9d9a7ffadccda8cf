#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

namespace rotrocc {

/// A pair to be sent to the odometry, and how.
struct StressPair {
  sensor_msgs::Image left, right;
  sensor_msgs::CameraInfo left_info, right_info;
  bool send_left = true, send_right = true;
  int pause_ms = 0;       ///< nothing is sent for so long afterwards
  double gap_s = 0.0;     ///< the same, and the stamps go on
  bool burst = false;     ///< it and those after it are sent at once
  bool frozen = false;    ///< the images are those of the pair before
  bool rival_tf = false;  ///< another node publishes tf of the base
  bool on_head = false;   ///< the cameras are on a head that moves, whose tf is too slow
  bool moved = false;     ///< the mount is another one from now on, and the odometry is reset
  bool guess = true;      ///< tf of guess_frame is sent
  double clock_s = 0.0;   ///< by which the clock of all sensors is ahead
  std::string save_path;  ///< to which the trajectory is to be saved; kFifo, or empty
};

/// In place of the path of a FIFO that nobody reads.
constexpr const char* kFifo = "a FIFO";

/// What happens to some pairs.
struct Fault {
  const char* name;
  /// Parts of what the log says of it: each of its lines has one of them, and the first is there.
  std::vector<const char*> says;
  std::function<void(StressPair&, std::mt19937&)> change;
  int pairs = 1;           ///< for how many it lasts
  int pairs_in_turn = 40;  ///< the same, if each fault has its turn: until the log tells it
};

const std::vector<Fault>& faults();

/// Applies faults of drivers, cables, clocks and other nodes to some pairs. At random, a fault
/// lasts for a pair or for a stretch of pairs; in turn, until a user would be told of it.
class FaultInjector {
 public:
  /// At random: a fault begins with a `share` of the pairs.
  FaultInjector(double share, unsigned seed) : share_(share), random_(seed) {}
  /// Each fault once, in turn.
  explicit FaultInjector(unsigned seed) : in_turn_(true), random_(seed) {}

  /// Changes the pair, or not; returns whether it has a fault. Another fault begins only if it
  /// `may_begin`.
  bool apply(StressPair& pair, bool may_begin = true);

  /// The fault that began last; none before the first.
  const Fault* current() const { return active_; }

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
