#include "player/player_options.h"

#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <type_traits>

namespace rotrocc {
namespace {

/// Calls visit.section(title) and visit.option(name, value, help) for all of them.
template <class Visitor>
void visitOptions(PlayerOptions& options, Visitor& visit) {
  visit.section("Playback");
  visit.option("bag",
               options.bag,
               "path of a bag, or the directory of a sequence, or of bags that are one recording");
  visit.option("rate", options.rate, "times as fast as recorded; 0: as fast as possible");
  visit.option("start", options.start, "offset from the start of the recording [s]");
  visit.option("duration", options.duration, "duration to play [s]; 0: to the end");
  visit.option("loop", options.loop, "true: repeats the recording");
  visit.option("paused", options.paused, "true: starts paused");
  visit.option("lockstep", options.lockstep, "true: waits for the odometry of each pair");
  visit.section("Images");
  visit.option("rectify", options.rectify, "true: raw images, for an odometry that rectifies them");
  visit.option("left_image",
               options.left_image,
               "topic of the left images, if the bag has several stereo pairs");
  visit.option("right_image", options.right_image, "topic of the right images");
  visit.option("calibration",
               options.calibration,
               "files in place of camera_info of a bag: \"left.yaml right.yaml\" of "
               "camera_calibration, or a camchain of Kalibr");
  visit.option(
      "max_stamp_difference_s", options.max_stamp_difference_s, "between the images of a pair [s]");
  visit.section("Ground truth");
  visit.option("ground_truth_file",
               options.ground_truth_file,
               "output of the true poses of the left camera, in TUM format");
  visit.option("base_frame", options.base_frame, "frame whose recorded poses are ground truth");
  visit.section("Longest waits");
  visit.option("lockstep_timeout_s", options.lockstep_timeout_s, "for an odometry [s]");
  visit.option("image_timeout_s",
               options.image_timeout_s,
               "for a pair of a sequence that is being written [s]; 0: all are there");
}

class Reader {
 public:
  explicit Reader(const ros::NodeHandle& private_nh) : private_nh_(private_nh) {}

  void section(const char*) {}
  template <class Value>
  void option(const char* name, Value& value, const char*) {
    private_nh_.param(name, value, value);
    if constexpr (std::is_same_v<Value, double>) {
      if (value >= 0.0) return;
      std::ostringstream message;
      message << "parameter " << name << " is " << value << ", but must be at least 0";
      throw std::invalid_argument(message.str());
    }
  }

 private:
  const ros::NodeHandle& private_nh_;
};

class Describer {
 public:
  void section(const char* title) { text_ << '\n' << title << ":\n"; }
  template <class Value>
  void option(const char* name, const Value& value, const char* help) {
    text_ << "  " << std::left << std::setw(24) << name << help;
    std::ostringstream usual;
    if constexpr (!std::is_same_v<Value, bool>) usual << value;
    if (!usual.str().empty()) text_ << " (default " << usual.str() << ')';
    text_ << '\n';
  }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

}  // namespace

PlayerOptions readPlayerOptions(const ros::NodeHandle& private_nh) {
  PlayerOptions options;
  Reader reader(private_nh);
  visitOptions(options, reader);
  if (!options.bag.empty()) return options;
  throw std::invalid_argument("parameter bag is missing: set it to the path of a bag or sequence");
}

std::string describePlayerOptions() {
  PlayerOptions defaults;
  Describer describer;
  visitOptions(defaults, describer);
  return describer.text();
}

}  // namespace rotrocc
