#include <cstdint>
#include <iostream>
#include <string>

#include <boost/program_options.hpp>

#include "bags/kitti_bag_writer.h"
#include "bags/kitti_mount.h"
#include "rotrocc/kitti.h"
#include "tools/program.h"
#include "tools/progress_bar.h"

namespace {

namespace po = boost::program_options;
using namespace rotrocc;

struct Options {
  std::string sequence;
  std::string bag;
  std::int64_t start_time_s = kKittiStart_s;
};

/// Returns false after printing the help; throws po::error on bad usage.
bool parse(int argc, char** argv, Options& options) {
  po::options_description visible("Options");
  auto add = visible.add_options();
  add("help,h", "show this help");
  add("start-time",
      po::value(&options.start_time_s)->default_value(options.start_time_s),
      "time of the first pair [s since 1970, integer]; ROS does not accept stamp 0");
  po::options_description all;
  all.add(visible).add_options()("sequence", po::value(&options.sequence)->required())(
      "bag", po::value(&options.bag)->required());
  po::positional_options_description positional;
  positional.add("sequence", 1).add("bag", 1);

  po::variables_map variables;
  po::store(po::command_line_parser(argc, argv).options(all).positional(positional).run(),
            variables);
  if (variables.count("help") > 0) {
    std::cout << "Converts a sequence directory of the KITTI odometry benchmark to a bag.\n"
                 "usage: kitti_to_bag SEQUENCE_DIR OUT.bag [options]\n"
              << visible;
    return false;
  }
  po::notify(variables);
  return true;
}

void run(const Options& options) {
  const KittiSequence sequence(options.sequence);
  if (!sequence.hasGroundTruth()) {
    std::cerr << "kitti_to_bag: no poses.txt in " << options.sequence
              << ": the bag will have no ground truth\n";
  }
  KittiBagWriter writer(options.bag, sequence, options.start_time_s);
  ProgressBar progress("kitti_to_bag", sequence.size());
  for (int index = 0; index < sequence.size(); ++index) {
    writer.writePair(index);
    progress.advance();
  }
  writer.finish();
  progress.finish();
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("kitti_to_bag", argc, argv, parse, run);
}
