#include "stress/fault_injector.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

namespace rotrocc {
namespace {

constexpr int kStretch = 30;  // pairs
constexpr int kSilence = 75;  // pairs at 10 Hz, longer than silence_s

double chance(std::mt19937& random) {
  return std::uniform_real_distribution<double>(0.0, 1.0)(random);
}

void fill(sensor_msgs::Image& image, unsigned char value) {
  std::fill(image.data.begin(), image.data.end(), value);
}

void fillBoth(StressPair& pair, unsigned char value) {
  fill(pair.left, value);
  fill(pair.right, value);
}

void shiftStamps(StressPair& pair, double shift_s) {
  for (auto* image : {&pair.left, &pair.right}) image->header.stamp += ros::Duration(shift_s);
}

/// As if it were not rectified.
void moveDown(sensor_msgs::Image& image, std::size_t rows) {
  const auto bytes = static_cast<std::ptrdiff_t>(rows * image.step);
  std::rotate(image.data.begin(), image.data.end() - bytes, image.data.end());
}

}  // namespace

const std::vector<Fault>& faults() {
  static const std::vector<Fault> kFaults = {
      {"left image missing", {}, [](auto& pair, auto&) { pair.send_left = false; }, 1, 1},
      {"right image missing", {}, [](auto& pair, auto&) { pair.send_right = false; }, 1, 1},
      {"30 % of the right images lost",
       {"have no partner"},
       [](auto& pair, auto& random) { pair.send_right = chance(random) >= 0.3; },
       kStretch},
      {"stamp 0", {"has the stamp 0"}, [](auto& pair, auto&) { pair.left.header.stamp = {}; }},
      {"stamp of the future",
       {"ahead of the clock"},
       [](auto& pair, auto&) { pair.left.header.stamp = ros::TIME_MAX; }},
      {"stamps of a glitch", {"a glitch"}, [](auto& pair, auto&) { shiftStamps(pair, 5.0); }, 1, 1},
      {"stamps apart",
       {"stamps are 40 ms apart", "with the same jitter", "have no partner"},
       [](auto& pair, auto&) { pair.right.header.stamp += ros::Duration(0.04); },
       1,
       kSilence},
      {"the cameras' clock 20 s behind",
       {"behind the clock", "time jumped"},
       [](auto& pair, auto&) { shiftStamps(pair, -20.0); },
       1,
       60},
      {"the cameras' clock 3 s ahead",
       {"ahead of the clock", "time jumped"},
       [](auto& pair, auto&) { shiftStamps(pair, 3.0); },
       1,
       60},
      {"data cut off",
       {"bytes of data"},
       [](auto& pair, auto&) { pair.left.data.resize(pair.left.data.size() / 2); }},
      {"no data", {"bytes of data"}, [](auto& pair, auto&) { pair.right.data.clear(); }},
      {"unknown encoding",
       {"has the encoding"},
       [](auto& pair, auto&) { pair.left.encoding = "jpeg"; }},
      {"sizes that overflow",
       {"more than max_image_pixels"},
       [](auto& pair, auto&) { pair.left.width = pair.left.height = pair.left.step = ~0u; }},
      {"step too short", {"a step of"}, [](auto& pair, auto&) { pair.left.step /= 2; }},
      {"sizes differ", {"same resolution"}, [](auto& pair, auto&) { pair.right.height -= 2; }},
      {"camera_info of NaN",
       {"camera_info is nan"},
       [](auto& pair, auto&) { pair.left_info.P[0] = std::numeric_limits<double>::quiet_NaN(); }},
      {"camera_info of zeros",
       {"all zeros"},
       [](auto& pair, auto&) { pair.right_info.P.fill(0.0); }},
      {"camera_info whose last digits change",
       {},
       [](auto& pair, auto& random) {
         for (auto* info : {&pair.left_info, &pair.right_info}) {
           info->P[0] *= 1.0 + 1e-9 * chance(random);
         }
       }},
      {"exchanged cameras",
       {"swap their topics", "lost:"},
       [](auto& pair, auto&) { std::swap(pair.left.data, pair.right.data); }},
      {"images that are not rectified",
       {"not rectified", "lost:"},
       [](auto& pair, auto&) { moveDown(pair.right, 7); }},
      {"black images", {"is it dark", "lost:"}, [](auto& pair, auto&) { fillBoth(pair, 0); }},
      {"white left image",
       {"overexposed", "lost:"},
       [](auto& pair, auto&) { fill(pair.left, 255); }},
      {"frozen images", {"frozen"}, [](auto& pair, auto&) { pair.frozen = true; }},
      {"no images for a while",
       {"arrive again"},
       [](auto& pair, auto&) { pair.pause_ms = 1500; },
       1,
       1},
      {"burst", {}, [](auto& pair, auto&) { pair.burst = true; }, 1, 1},
      {"a gap of 3 s", {"arrive again"}, [](auto& pair, auto&) { pair.gap_s = 3.0; }, 1, 1},
      {"rival tf publisher",
       {"a frame has only one parent"},
       [](auto& pair, auto&) { pair.rival_tf = true; },
       kStretch,
       60},
      {"save_trajectory onto a FIFO",
       {"it is a FIFO"},
       [](auto& pair, auto&) { pair.save_path = kFifo; },
       1,
       1},
      {"save_trajectory into no folder",
       {"No such file or directory"},
       [](auto& pair, auto&) { pair.save_path = "/no/such/directory/poses.txt"; },
       1,
       1}};
  return kFaults;
}

bool FaultInjector::apply(StressPair& pair, bool may_begin) {
  if (pairs_left_ == 0) {
    const Fault* next = may_begin ? choose() : nullptr;
    if (next == nullptr) return false;
    active_ = next;
    pairs_left_ = in_turn_ ? active_->pairs_in_turn : active_->pairs;
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
