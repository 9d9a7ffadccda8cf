#include "tools/input_options.h"

#include "tools/program.h"

namespace rotrocc {

namespace po = boost::program_options;

const char* const kRecordingHelp =
    "is a bag, several bags or a directory of bags of one recording, or a directory in\nthe layout "
    "of KITTI's odometry benchmark or raw drives, in ASL format (EuRoC), or with\nfolders left and "
    "right and calibrations left.yaml and right.yaml, or other files with\n--calibration.\n";

po::options_description parameterOptions(InputOptions& options) {
  po::options_description parameters("Parameters");
  auto add = parameters.add_options();
  add("config", po::value(&options.config), "YAML file with parameters");
  add("set", po::value(&options.assignments), "name=value: set a parameter; may be repeated");
  return parameters;
}

po::options_description imageOptions(InputOptions& options) {
  po::options_description images("Images");
  auto add = images.add_options();
  add("left-image",
      po::value(&options.recording.topics.left_image),
      "topic of the left images, if a bag has several stereo pairs");
  add("right-image", po::value(&options.recording.topics.right_image), "topic of the right images");
  add("left-info",
      po::value(&options.recording.topics.left_info),
      "topic of the left camera_info, if it is not beside the images");
  add("right-info",
      po::value(&options.recording.topics.right_info),
      "topic of the right camera_info");
  add("rectify",
      withDefault(options.rectify),
      "with K, D, R and P of camera_info: yes, no, or auto (if the topic is not named "
      "image_rect..., and camera_info describes raw images)");
  add("calibration",
      po::value(&options.recording.sequence.calibration)->multitoken(),
      "files in place of the recorded calibration, the left camera's first: of camera_calibration, "
      "camera_info as rostopic prints it, Kalibr, OpenVINS, ASL, Kimera, ORB-SLAM or OpenCV");
  return images;
}

Parameters readParameters(const InputOptions& options) {
  Parameters parameters;
  ParameterTable table = makeParameterTable(parameters);
  if (!options.config.empty()) loadYaml(options.config, table);
  for (const std::string& assignment : options.assignments) table.setAssignment(assignment);
  return parameters;
}

std::unique_ptr<Recording> openInput(const InputOptions& options, const NodeParameters& node) {
  RecordingOptions recording = options.recording;
  recording.base_frame = node.base_frame;
  recording.raw_sequence = true;
  recording.sequence.max_stamp_difference_s = node.max_stamp_difference_s;
  recording.sequence.baseline_m = node.baseline_m;
  return openRecording(options.paths, recording);
}

}  // namespace rotrocc
