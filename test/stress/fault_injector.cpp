#include "stress/fault_injector.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

namespace rotrocc {

struct Fault {
  const char* name;
  std::function<void(StressPair&, std::mt19937&)> change;
  int pairs = 1;
};

namespace {

constexpr int kStretch = 30;  // pairs

double chance(std::mt19937& random) {
  return std::uniform_real_distribution<double>(0.0, 1.0)(random);
}

void fill(sensor_msgs::Image& image, unsigned char value) {
  std::fill(image.data.begin(), image.data.end(), value);
}

const std::vector<Fault>& faults() {
  static const std::vector<Fault> kFaults = {
      {"left image missing", [](StressPair& pair, std::mt19937&) { pair.send_left = false; }},
      {"right image missing", [](StressPair& pair, std::mt19937&) { pair.send_right = false; }},
      {"stamp 0", [](StressPair& pair, std::mt19937&) { pair.left.header.stamp = ros::Time(); }},
      {"stamp of the future",
       [](StressPair& pair, std::mt19937&) { pair.left.header.stamp = ros::TIME_MAX; }},
      {"stamps of a glitch",
       [](StressPair& pair, std::mt19937&) {
         pair.left.header.stamp += ros::Duration(5.0);
         pair.right.header.stamp += ros::Duration(5.0);
       }},
      {"stamps apart",
       [](StressPair& pair, std::mt19937&) { pair.right.header.stamp += ros::Duration(0.04); }},
      {"data cut off",
       [](StressPair& pair, std::mt19937&) { pair.left.data.resize(pair.left.data.size() / 2); }},
      {"no data", [](StressPair& pair, std::mt19937&) { pair.right.data.clear(); }},
      {"unknown encoding", [](StressPair& pair, std::mt19937&) { pair.left.encoding = "jpeg"; }},
      {"sizes that overflow",
       [](StressPair& pair, std::mt19937&) {
         pair.left.width = pair.left.height = pair.left.step = ~0u;
       }},
      {"step too short", [](StressPair& pair, std::mt19937&) { pair.left.step /= 2; }},
      {"sizes differ", [](StressPair& pair, std::mt19937&) { pair.right.height -= 2; }},
      {"camera_info of NaN",
       [](StressPair& pair, std::mt19937&) {
         pair.left_info.P[0] = std::numeric_limits<double>::quiet_NaN();
       }},
      {"camera_info of zeros",
       [](StressPair& pair, std::mt19937&) { pair.right_info.P.fill(0.0); }},
      {"exchanged cameras",
       [](StressPair& pair, std::mt19937&) { std::swap(pair.left.data, pair.right.data); }},
      {"black images",
       [](StressPair& pair, std::mt19937&) {
         fill(pair.left, 0);
         fill(pair.right, 0);
       }},
      {"white left image", [](StressPair& pair, std::mt19937&) { fill(pair.left, 255); }},
      {"no images for a while", [](StressPair& pair, std::mt19937&) { pair.pause_ms = 1500; }},
      {"burst", [](StressPair& pair, std::mt19937&) { pair.burst = true; }},
      {"stamps 5 s ahead",
       [](StressPair& pair, std::mt19937&) {
         pair.left.header.stamp += ros::Duration(5.0);
         pair.right.header.stamp += ros::Duration(5.0);
       }},
      {"a gap of 3 s", [](StressPair& pair, std::mt19937&) { pair.gap_s = 3.0; }},
      {"30 % of the right images lost",
       [](StressPair& pair, std::mt19937& random) { pair.send_right = chance(random) >= 0.3; },
       kStretch},
      {"rival tf publisher",
       [](StressPair& pair, std::mt19937&) { pair.rival_tf = true; },
       kStretch},
      {"save_trajectory onto a FIFO",
       [](StressPair& pair, std::mt19937&) { pair.save_to_fifo = true; }}};
  return kFaults;
}

}  // namespace

bool FaultInjector::apply(StressPair& pair, bool may_begin) {
  if (pairs_left_ == 0) {
    active_ = may_begin ? choose() : nullptr;
    if (active_ == nullptr) return false;
    pairs_left_ = active_->pairs;
    ++counts_[active_->name];
  }
  --pairs_left_;
  active_->change(pair, random_);
  return true;
}

const Fault* FaultInjector::choose() {
  if (in_turn_) return finished() ? nullptr : &faults()[turn_++];
  if (chance(random_) >= share_) return nullptr;
  return &faults()[random_() % faults().size()];
}

bool FaultInjector::finished() const {
  return turn_ == faults().size() && pairs_left_ == 0;
}

}  // namespace rotrocc
