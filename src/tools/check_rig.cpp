#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <ros/console.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/names.h>
#include <boost/program_options.hpp>

#include "bags/live_recording.h"
#include "check/calibration_correction.h"
#include "check/rig_check.h"
#include "tools/draw_report.h"
#include "tools/input_options.h"
#include "tools/program.h"
#include "tools/progress_bar.h"

namespace {

namespace po = boost::program_options;
using namespace rotrocc;

const std::string kUsage =
    std::string(
        "Checks calibration, exposure, focus and stamps of a stereo rig, by a minute of motion.\n\n"
        "example: check_rig drive.bag --report check\n"
        "usage:   check_rig RECORDING... [options]\n"
        "         check_rig --live left:=TOPIC right:=TOPIC [options]\n\n"
        "RECORDING ") +
    kRecordingHelp +
    "\n"
    "With --live the images come from topics, e.g.\n"
    "    check_rig --live left:=/camera/left/image_rect right:=/camera/right/image_rect\n"
    "by default left/image_rect and right/image_rect, which may be remapped like those of the\n"
    "node. camera_info is beside each image, or what left/camera_info and right/camera_info are\n"
    "remapped to; --set image_transport=compressed takes another transport. Ctrl-C ends it early.\n"
    "\n"
    "The exit status is 0 if nothing is to be fixed, and 3 otherwise.\n\n";

struct Options {
  InputOptions input;
  bool live = false;
  double duration_s = LiveOptions().duration_s;
  std::string imu;
  std::string report;
  std::string camera_info;
};

/// Throws po::error if the options do not go together.
void validate(const Options& options) {
  if (!options.live) {
    if (options.input.paths.empty()) throw po::error("expected a recording, or --live");
    return;
  }
  const RecordingOptions& recording = options.input.recording;
  if (!options.input.paths.empty()) {
    throw po::error("--live takes no recording: " + options.input.paths.front());
  }
  if (!(options.duration_s > 0.0)) throw po::error("--duration must be positive");
  if (!options.camera_info.empty()) {
    throw po::error(
        "--write-camera-info reads the images twice: record a bag with rosbag, and check that "
        "instead of --live");
  }
  if (!recording.left_image.empty() || !recording.right_image.empty()) {
    throw po::error("--live takes left:=TOPIC right:=TOPIC, not --left-image and --right-image");
  }
  if (!recording.calibration.empty()) {
    throw po::error("--live checks the camera_info of the topics: --calibration needs a recording");
  }
}

/// Returns false after printing the help; throws po::error on bad usage.
bool parse(int argc, char** argv, Options& options) {
  const auto is_live = [](const char* argument) { return argument == std::string("--live"); };
  if (std::any_of(argv, argv + argc, is_live)) {
    ros::init(argc, argv, "check_rig", ros::init_options::AnonymousName);  // removes remappings
  }
  po::options_description visible("Options");
  auto add = visible.add_options();
  add("help,h", "show this help");
  add("live", po::bool_switch(&options.live), "check the images of topics, while they come");
  add("duration", withDefault(options.duration_s), "of --live, from the first image on [s]");
  add("report", po::value(&options.report), "folder for a page with pictures");
  add("write-camera-info",
      po::value(&options.camera_info),
      "folder for left.yaml and right.yaml of a corrected calibration, if one is better; the "
      "report "
      "has both");
  add("imu",
      po::value(&options.imu),
      "gyroscope to compare with: a topic of sensor_msgs/Imu in a bag, or a folder or CSV file of "
      "a "
      "sequence");
  visible.add(imageOptions(options.input)).add(parameterOptions(options.input));
  po::variables_map variables;
  if (!parseCommandLine(argc, argv, kUsage.c_str(), visible, options.input.paths, variables))
    return false;
  validate(options);
  return true;
}

constexpr int kToFix = 3;  // exit status

bool isToFix(const RigReport& report) {
  return !report.findings.empty() && report.findings.front().verdict == Verdict::kFix;
}

/// Adds the corrected calibration to the report, and writes it.
void addCorrection(const Options& options,
                   Recording& recording,
                   const RigCheckOptions& check,
                   CheckedRig& rig) {
  std::string why_not;
  const auto correction = findCorrection(recording, check, rig.measures, why_not);
  if (!correction) {
    std::cout << "no corrected calibration: " << why_not << "\n\n";
    return;
  }
  writeCalibration(correction->calibration, options.camera_info);
  rig.report.corrected = correction->checked.report.findings;
  for (ReportTable table : correction->checked.report.tables) {
    if (table.name != "rows_map" && table.name != "disparity_map") continue;
    table.name += "_corrected";
    rig.report.tables.push_back(std::move(table));
  }
}

/// The topic that `side` is remapped to, or that of the node.
std::string liveTopic(const std::string& side) {
  const bool is_remapped = ros::names::resolve(side) != ros::names::resolve(side, false);
  return is_remapped ? side : side + "/image_rect";
}

/// Throws std::runtime_error if there is no master, and as LiveRecording.
std::unique_ptr<Recording> openTopics(const Options& options, const NodeParameters& node) {
  if (!ros::master::check()) {
    throw std::runtime_error("there is no ROS master at " + ros::master::getURI() +
                             ": start the camera, or set ROS_MASTER_URI to that of the camera");
  }
  LiveOptions live;
  live.left_image = liveTopic("left");
  live.right_image = liveTopic("right");
  live.image_transport = node.image_transport;
  live.baseline_m = node.baseline_m;
  live.duration_s = options.duration_s;
  return std::make_unique<LiveRecording>(live);
}

/// Progress is in pairs; with --live, whose number is not known, in seconds since the first one.
CheckedRig checkWithProgress(const Options& options, Recording& recording, RigCheckOptions check) {
  using Clock = std::chrono::steady_clock;
  const auto length_s = static_cast<std::size_t>(std::ceil(options.duration_s));
  ProgressBar progress(options.live ? "check [s]" : "check",
                       options.live ? length_s : static_cast<std::size_t>(recording.size()));
  std::optional<Clock::time_point> begin;
  check.on_pair = [&] {
    if (!options.live) return progress.advance();
    if (!begin) begin = Clock::now();
    const std::chrono::duration<double> passed = Clock::now() - *begin;
    progress.advanceTo(std::min(length_s, static_cast<std::size_t>(std::ceil(passed.count()))));
  };
  CheckedRig rig = checkRig(recording, check);
  progress.finish();
  return rig;
}

/// The recording is closed after it: ROS must not run any more when the program exits.
CheckedRig checkInput(const Options& options) {
  RigCheckOptions check;
  check.parameters = readParameters(options.input);
  check.rectify = options.input.rectify;
  const NodeParameters& node = check.parameters.node;
  const std::unique_ptr<Recording> recording =
      options.live ? openTopics(options, node) : openInput(options.input, node);
  if (!options.imu.empty()) check.gyroscope = recording->gyroscope(options.imu);
  CheckedRig rig = checkWithProgress(options, *recording, check);
  if (!options.camera_info.empty()) addCorrection(options, *recording, check, rig);
  return rig;
}

void run(const Options& options) {
  const CheckedRig rig = checkInput(options);
  std::cout << toText(rig.report);
  if (rig.report.corrected) {
    std::cout << "\nwritten: " << options.camera_info << "/left.yaml and right.yaml\n";
  }
  std::cout.flush();
  if (!options.report.empty()) {
    writeReport(rig.report, options.report);
    drawReport(options.report);
  }
  if (isToFix(rig.report)) std::exit(kToFix);
}

}  // namespace

int main(int argc, char** argv) {
  if (ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Error)) {
    ros::console::notifyLoggerLevelsChanged();
  }
  return runProgram("check_rig", argc, argv, parse, run);
}
