#include <iostream>
#include <stdexcept>

#include <ros/ros.h>
#include <boost/program_options.hpp>

#include "stress/stress_player.h"
#include "tools/program.h"

namespace {

namespace po = boost::program_options;
using namespace rotrocc;

const char* const kUsage =
    "Plays a stereo bag, forth and back in a loop, to an odometry that runs already, with faults, "
    "and\n"
    "reports what became of each image. scripts/soak starts all that is needed.\n"
    "usage: stress_odometry BAG [options]\n";

bool parse(int argc, char** argv, StressOptions& options) {
  po::options_description visible("Options");
  visible.add_options()("help,h", "show this text")(
      "rate", withDefault(options.rate_hz), "[Hz] of the pairs")(
      "duration", withDefault(options.duration_s), "[s] of the run")(
      "faults", withDefault(options.fault_share), "share of the pairs that get a fault; 0: none")(
      "seed", withDefault(options.seed), "same seed, same faults");
  std::vector<std::string> bags;
  po::variables_map variables;
  if (!parseCommandLine(argc, argv, kUsage, visible, bags, variables)) return false;
  if (bags.size() != 1) throw po::error("expected one bag");
  options.recording = bags.front();
  if (!(options.rate_hz > 0.0)) throw po::error("the rate must be positive");
  return true;
}

void run(const StressOptions& options) {
  ros::NodeHandle nh;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  if (!StressPlayer(nh, options).run()) {
    throw std::runtime_error("the odometry did not stand it: see the account above");
  }
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "stress_odometry");
  return runProgram<StressOptions>("stress_odometry", argc, argv, parse, run);
}
