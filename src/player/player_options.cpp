#include "player/player_options.h"

#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Calls visit(name, value, help) for all of them.
template <class Visitor>
void visitOptions(PlayerOptions& options, const Visitor& visit) {
  visit("bag",
        options.bag,
        "path of a bag, or the directory of a sequence, or of bags that are one recording");
  visit("rate", options.rate, "times as fast as recorded; 0: as fast as possible");
  visit("start", options.start, "offset from the start of the recording [s]");
  visit("duration", options.duration, "duration to play [s]; 0: to the end");
  visit("loop", options.loop, "true: repeat the recording");
  visit("paused", options.paused, "true: starts paused");
  visit("lockstep_timeout_s",
        options.lockstep_timeout_s,
        "longest wait for the odometry of each pair [s]; 0: do not wait");
  visit("rectify", options.rectify, "true: raw images, for an odometry that rectifies them");
  visit("left_image",
        options.topics.left_image,
        "topic of the left images, if the bag has several stereo pairs");
  visit("right_image", options.topics.right_image, "topic of the right images");
  visit("left_info",
        options.topics.left_info,
        "topic of the left camera_info, if it is not beside the images");
  visit("right_info", options.topics.right_info, "topic of the right camera_info");
  visit("calibration",
        options.calibration,
        "files in place of camera_info of a bag: \"left.yaml right.yaml\" of camera_calibration, "
        "or a camchain of Kalibr");
  visit(
      "max_stamp_difference_s", options.max_stamp_difference_s, "between the images of a pair [s]");
  visit("ground_truth_file",
        options.ground_truth_file,
        "output of the true poses of the left camera, in TUM format");
  visit("base_frame", options.base_frame, "frame whose recorded poses are ground truth");
  visit("image_timeout_s",
        options.image_timeout_s,
        "longest wait for a pair of a sequence that is being written [s]; 0: all are there");
}

}  // namespace

PlayerOptions readPlayerOptions(const ros::NodeHandle& private_nh) {
  PlayerOptions options;
  visitOptions(options, [&](const std::string& name, auto& value, const char*) {
    private_nh.param(name, value, value);
    if constexpr (std::is_same_v<decltype(value), double&>) {
      if (value >= 0.0) return;
      throw std::invalid_argument("parameter " + name + " is " + toText(value) +
                                  ", but must be at least 0");
    }
  });
  if (!options.bag.empty()) return options;
  throw std::invalid_argument("parameter bag is missing: set it to the path of a bag or sequence");
}

std::string describePlayerOptions() {
  PlayerOptions defaults;
  std::ostringstream text;
  text << "\nParameters:\n";
  visitOptions(defaults, [&](const char* name, const auto& value, const char* help) {
    text << "  " << std::left << std::setw(24) << name << help;
    const std::string usual = std::is_same_v<decltype(value), const bool&> ? "" : toText(value);
    text << (usual.empty() ? "" : " (default " + usual + ")") << '\n';
  });
  return text.str();
}

}  // namespace rotrocc
