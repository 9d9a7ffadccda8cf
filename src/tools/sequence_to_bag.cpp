#include <cstdint>
#include <iostream>
#include <string>

#include <boost/program_options.hpp>

#include "bags/sequence_bag_writer.h"
#include "sequences/stereo_sequence.h"
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
    "camera_calibration.\n\n";

struct Options {
  std::string sequence;
  std::string bag;
  double max_stamp_difference_s = 0.01;
  SequenceBagWriter::Options writer;
};

/// Returns false after printing the help; throws po::error on bad usage.
bool parse(int argc, char** argv, Options& options) {
  po::options_description visible("Options");
  auto add = visible.add_options();
  add("help,h", "show this help");
  std::int64_t start_time_s = 0;
  add("start-time",
      po::value(&start_time_s),
      "time of the first pair [s since 1970, integer]; default: that of the sequence, or "
      "1317600000 "
      "if its times start at 0, as ROS does not accept stamp 0");
  add("rectify",
      po::bool_switch(&options.writer.rectify),
      "write rectified images, if those of the sequence are not: image_rect instead of image_raw");
  add("max-stamp-difference",
      po::value(&options.max_stamp_difference_s)->default_value(options.max_stamp_difference_s),
      "[s] between the images of a pair");
  PositionalArguments names;
  names.options.add_options()("sequence", po::value(&options.sequence)->required())(
      "bag", po::value(&options.bag)->required());
  names.order.add("sequence", 1).add("bag", 1);
  po::variables_map variables;
  if (!parseCommandLine(argc, argv, kUsage, visible, names, variables)) return false;
  if (variables.count("start-time") > 0) options.writer.start_time_s = start_time_s;
  return true;
}

void run(const Options& options) {
  const auto sequence = openStereoSequence(options.sequence, {options.max_stamp_difference_s, 0.0});
  if (sequence->groundTruth().empty()) {
    std::cerr << "sequence_to_bag: " << options.sequence
              << " has no true poses: the bag will have no ground truth\n";
  }
  SequenceBagWriter writer(options.bag, *sequence, options.writer);
  ProgressBar progress("sequence_to_bag", sequence->size());
  for (int index = 0; index < sequence->size(); ++index) {
    writer.writePair(index);
    progress.advance();
  }
  writer.finish();
  progress.finish();
  if (!sequence->leftOut().empty()) {
    std::cerr << "sequence_to_bag: " << sequence->leftOut() << '\n';
  }
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("sequence_to_bag", argc, argv, parse, run);
}
