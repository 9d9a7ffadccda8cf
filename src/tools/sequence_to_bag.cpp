#include <iostream>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "bags/sequence_bag_writer.h"
#include "tools/program.h"
#include "tools/progress_bar.h"

namespace {

namespace po = boost::program_options;
using namespace rotrocc;

const char* const kUsage =
    "Converts a sequence of stereo images to a bag with camera_info, tf and, if known, "
    "ground truth and gyroscope.\n\n"
    "example: sequence_to_bag dataset/sequences/06 06.bag\n"
    "usage:   sequence_to_bag SEQUENCE_DIR OUT.bag [options]\n\n"
    "SEQUENCE_DIR is in the layout of KITTI's odometry benchmark, in ASL format (EuRoC), or "
    "has folders left\nand right and files left.yaml and right.yaml of "
    "camera_calibration.\nTimes from 0 on are moved to 1317600000 s: ROS does not accept stamp "
    "0.\n\n";

struct Options {
  std::vector<std::string> names;  // of the sequence and of the bag
  RecordingOptions recording;
};

/// Returns false after printing the help; throws po::error on bad usage.
bool parse(int argc, char** argv, Options& options) {
  po::options_description visible("Options");
  auto add = visible.add_options();
  add("help,h", "show this help");
  add("rectify",
      "write rectified images, if those of the sequence are not: image_rect instead of image_raw");
  add("max-stamp-difference",
      withDefault(options.recording.sequence.max_stamp_difference_s),
      "[s] between the images of a pair");
  po::variables_map variables;
  if (!parseCommandLine(argc, argv, kUsage, visible, options.names, variables)) return false;
  if (options.names.size() != 2) throw po::error("expected a sequence and a bag");
  options.recording.raw_sequence = variables.count("rectify") == 0;
  return true;
}

void run(const Options& options) {
  const std::string& sequence = options.names[0];
  SequenceRecording recording(sequence, options.recording);
  if (recording.truth().poses.empty()) {
    std::cerr << "sequence_to_bag: " << sequence
              << " has no true poses: the bag will have no ground truth\n";
  }
  ProgressBar progress("sequence_to_bag", recording.size());
  writeSequenceBag(options.names[1], recording, [&] { progress.advance(); });
  progress.finish();
  if (!recording.leftOut().empty()) {
    std::cerr << "sequence_to_bag: " << recording.leftOut() << '\n';
  }
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("sequence_to_bag", argc, argv, parse, run);
}
