#include "stress/fault_injector.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace rotrocc {
namespace {

using Fault = std::pair<const char*, std::function<void(StressPair&)>>;

void fill(sensor_msgs::Image& image, unsigned char value) {
  std::fill(image.data.begin(), image.data.end(), value);
}

const std::vector<Fault>& faults() {
  static const std::vector<Fault> kFaults = {
      {"left image missing", [](StressPair& pair) { pair.send_left = false; }},
      {"right image missing", [](StressPair& pair) { pair.send_right = false; }},
      {"stamp 0", [](StressPair& pair) { pair.left.header.stamp = ros::Time(); }},
      {"stamp of the future", [](StressPair& pair) { pair.left.header.stamp = ros::TIME_MAX; }},
      {"stamps of a glitch",
       [](StressPair& pair) {
         pair.left.header.stamp += ros::Duration(5.0);
         pair.right.header.stamp += ros::Duration(5.0);
       }},
      {"stamps apart", [](StressPair& pair) { pair.right.header.stamp += ros::Duration(0.04); }},
      {"data cut off", [](StressPair& pair) { pair.left.data.resize(pair.left.data.size() / 2); }},
      {"no data", [](StressPair& pair) { pair.right.data.clear(); }},
      {"unknown encoding", [](StressPair& pair) { pair.left.encoding = "jpeg"; }},
      {"sizes that overflow",
       [](StressPair& pair) { pair.left.width = pair.left.height = pair.left.step = ~0u; }},
      {"step too short", [](StressPair& pair) { pair.left.step /= 2; }},
      {"sizes differ", [](StressPair& pair) { pair.right.height -= 2; }},
      {"camera_info of NaN",
       [](StressPair& pair) { pair.left_info.P[0] = std::numeric_limits<double>::quiet_NaN(); }},
      {"camera_info of zeros", [](StressPair& pair) { pair.right_info.P.fill(0.0); }},
      {"exchanged cameras", [](StressPair& pair) { std::swap(pair.left.data, pair.right.data); }},
      {"black images",
       [](StressPair& pair) {
         fill(pair.left, 0);
         fill(pair.right, 0);
       }},
      {"white left image", [](StressPair& pair) { fill(pair.left, 255); }},
      {"no images for a while", [](StressPair& pair) { pair.pause_ms = 1500; }},
      {"burst", [](StressPair& pair) { pair.burst = true; }}};
  return kFaults;
}

}  // namespace

void FaultInjector::apply(StressPair& pair) {
  if (std::uniform_real_distribution<double>(0.0, 1.0)(random_) >= share_) return;
  const Fault& fault = faults()[random_() % faults().size()];
  fault.second(pair);
  ++counts_[fault.first];
}

}  // namespace rotrocc
