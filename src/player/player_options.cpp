#include "player/player_options.h"

#include <sstream>
#include <stdexcept>

namespace rotrocc {
namespace {

void requireAtLeast(double minimum, const char* name, double value) {
  if (value >= minimum) return;
  std::ostringstream message;
  message << "parameter " << name << " is " << value << ", but must be at least " << minimum;
  throw std::invalid_argument(message.str());
}

}  // namespace

PlayerOptions readPlayerOptions(const ros::NodeHandle& private_nh) {
  PlayerOptions options;
  private_nh.param("bag", options.bag, options.bag);
  private_nh.param("left_image", options.left_image, options.left_image);
  private_nh.param("right_image", options.right_image, options.right_image);
  private_nh.param("rectify", options.rectify, options.rectify);
  private_nh.param("rate", options.rate, options.rate);
  private_nh.param("start", options.start, options.start);
  private_nh.param("duration", options.duration, options.duration);
  private_nh.param("loop", options.loop, options.loop);
  private_nh.param("paused", options.paused, options.paused);
  private_nh.param("lockstep", options.lockstep, options.lockstep);
  private_nh.param("lockstep_timeout_s", options.lockstep_timeout_s, options.lockstep_timeout_s);
  private_nh.param("image_timeout_s", options.image_timeout_s, options.image_timeout_s);
  private_nh.param(
      "max_stamp_difference_s", options.max_stamp_difference_s, options.max_stamp_difference_s);
  private_nh.param("ground_truth_file", options.ground_truth_file, options.ground_truth_file);
  private_nh.param("base_frame", options.base_frame, options.base_frame);

  if (options.bag.empty()) {
    throw std::invalid_argument(
        "parameter bag is missing: set it to the path of a bag or sequence");
  }
  requireAtLeast(0.0, "rate", options.rate);
  requireAtLeast(0.0, "start", options.start);
  requireAtLeast(0.0, "duration", options.duration);
  requireAtLeast(0.0, "lockstep_timeout_s", options.lockstep_timeout_s);
  requireAtLeast(0.0, "image_timeout_s", options.image_timeout_s);
  requireAtLeast(0.0, "max_stamp_difference_s", options.max_stamp_difference_s);
  return options;
}

}  // namespace rotrocc
