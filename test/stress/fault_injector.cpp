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
      {"left image missing", [](auto& pair, auto&) { pair.send_left = false; }},
      {"right image missing", [](auto& pair, auto&) { pair.send_right = false; }},
      {"stamp 0", [](auto& pair, auto&) { pair.left.header.stamp = ros::Time(); }},
      {"stamp of the future", [](auto& pair, auto&) { pair.left.header.stamp = ros::TIME_MAX; }},
      {"stamps of a glitch",
       [](auto& pair, auto&) {
         for (auto* image : {&pair.left, &pair.right}) image->header.stamp += ros::Duration(5.0);
       }},
      {"stamps apart", [](auto& pair, auto&) { pair.right.header.stamp += ros::Duration(0.04); }},
      {"data cut off", [](auto& pair, auto&) { pair.left.data.resize(pair.left.data.size() / 2); }},
      {"no data", [](auto& pair, auto&) { pair.right.data.clear(); }},
      {"unknown encoding", [](auto& pair, auto&) { pair.left.encoding = "jpeg"; }},
      {"sizes that overflow",
       [](auto& pair, auto&) { pair.left.width = pair.left.height = pair.left.step = ~0u; }},
      {"step too short", [](auto& pair, auto&) { pair.left.step /= 2; }},
      {"sizes differ", [](auto& pair, auto&) { pair.right.height -= 2; }},
      {"camera_info of NaN",
       [](auto& pair, auto&) { pair.left_info.P[0] = std::numeric_limits<double>::quiet_NaN(); }},
      {"camera_info of zeros", [](auto& pair, auto&) { pair.right_info.P.fill(0.0); }},
      {"exchanged cameras", [](auto& pair, auto&) { std::swap(pair.left.data, pair.right.data); }},
      {"black images",
       [](auto& pair, auto&) {
         for (auto* image : {&pair.left, &pair.right}) fill(*image, 0);
       }},
      {"white left image", [](auto& pair, auto&) { fill(pair.left, 255); }},
      {"no images for a while", [](auto& pair, auto&) { pair.pause_ms = 1500; }},
      {"burst", [](auto& pair, auto&) { pair.burst = true; }},
      {"a gap of 3 s", [](auto& pair, auto&) { pair.gap_s = 3.0; }},
      {"30 % of the right images lost",
       [](auto& pair, auto& random) { pair.send_right = chance(random) >= 0.3; },
       kStretch},
      {"rival tf publisher", [](auto& pair, auto&) { pair.rival_tf = true; }, kStretch},
      {"save_trajectory onto a FIFO", [](auto& pair, auto&) { pair.save_to_fifo = true; }}};
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
