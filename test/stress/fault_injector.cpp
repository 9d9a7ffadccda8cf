#include "stress/fault_injector.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace rotrocc {
namespace {

constexpr int kStretch = 30;   // pairs
constexpr int kSilence = 75;   // pairs at 10 Hz, longer than silence_s
constexpr int kLasting = 100;  // longer than the 5 s of the statistics, and what lasts for 5 s
const char* const kFrameChanged = "frame_id of the left images changed";

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

/// To 10 of 16 bits, with a row of other data whose bits are all set.
void widen(sensor_msgs::Image& image) {
  std::vector<unsigned char> wide;
  wide.reserve(2 * image.data.size());
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const unsigned value = i < image.step ? 0xffffu : 4u * image.data[i];
    wide.push_back(static_cast<unsigned char>(value & 0xffu));
    wide.push_back(static_cast<unsigned char>(value >> 8));
  }
  image.data = std::move(wide);
  image.step *= 2;
  image.encoding = "mono16";
  image.is_bigendian = 0;
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
       kStretch,
       kLasting},
      {"stamp 0", {"has the stamp 0"}, [](auto& pair, auto&) { pair.left.header.stamp = {}; }},
      {"stamp of the future",
       {"ahead of the clock"},
       [](auto& pair, auto&) { pair.left.header.stamp = ros::TIME_MAX; }},
      {"stamps of a glitch",
       {"a glitch"},
       [](auto& pair, auto&) {
         for (auto* image : {&pair.left, &pair.right}) image->header.stamp += ros::Duration(5.0);
       },
       1,
       1},
      {"stamps apart",
       {"trigger the cameras synchronously"},
       [](auto& pair, auto&) { pair.right.header.stamp += ros::Duration(0.04); },
       1,
       kSilence},
      {"the sensors' clock 20 s behind",
       {"behind the clock", "time jumped back"},
       [](auto& pair, auto&) { pair.clock_s = -20.0; },
       1,
       kLasting},
      {"the sensors' clock 3 s ahead",
       {"ahead of the clock", "time jumped back"},
       [](auto& pair, auto&) { pair.clock_s = 3.0; },
       1,
       kLasting},
      {"data cut off",
       {"bytes of data"},
       [](auto& pair, auto&) { pair.left.data.resize(pair.left.data.size() / 2); }},
      {"unknown encoding",
       {"has the encoding"},
       [](auto& pair, auto&) { pair.left.encoding = "jpeg"; }},
      {"sizes that overflow",
       {"pixels: bin the images"},
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
      {"16-bit images with a row of other data",
       {},
       [](auto& pair, auto&) {
         widen(pair.left);
         widen(pair.right);
       }},
      {"exchanged cameras",
       {"swap their topics"},
       [](auto& pair, auto&) { std::swap(pair.left.data, pair.right.data); }},
      {"images that are not rectified",
       {"not rectified"},
       [](auto& pair, auto&) { moveDown(pair.right, 7); }},
      {"black images", {"is it dark"}, [](auto& pair, auto&) { fillBoth(pair, 0); }},
      {"no data", {"bytes of data"}, [](auto& pair, auto&) { pair.right.data.clear(); }},
      {"frozen images", {"frozen"}, [](auto& pair, auto&) { pair.frozen = true; }},
      {"no images for a while",
       {"arrive again"},
       [](auto& pair, auto&) { pair.pause_ms = 1500; },
       1,
       1},
      {"burst", {}, [](auto& pair, auto&) { pair.burst = true; }, 1, 1},
      {"a gap of 3 s", {"arrive again"}, [](auto& pair, auto&) { pair.gap_s = 3.0; }, 1, 1},
      {"a mount that moves with 3 Hz of tf",
       {"too seldom for the images", kFrameChanged},
       [](auto& pair, auto&) { pair.on_head = true; },
       kStretch,
       kLasting},
      {"another mount on /tf_static, and a reset",
       {},
       [](auto& pair, auto&) { pair.moved = true; },
       1,
       1},
      {"no tf of guess_frame",
       {"no tf from guess_frame"},
       [](auto& pair, auto&) { pair.guess = false; },
       kStretch},
      {"white left image", {"overexposed"}, [](auto& pair, auto&) { fill(pair.left, 255); }},
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
